#!/usr/bin/env bash
# The experiments of the page "The paper's study, repeated" that the program itself runs: grids, thresholds, conditions flown too.
#
#     PATH=target/release:$PATH docs/figures/ghazi_2020.sh
#
# Prints mean, standard deviation and largest error of the static points after each run. Everything is written to a new folder.
set -euo pipefail
cd "$(dirname "$0")/../.."

S=fixtures/ghazi-2020; W=$(mktemp -d)

errors() { # mean, standard deviation, largest of a file of predicted points
  awk -F, 'FNR == 1 { for (i = 1; i <= NF; i++) if ($i == "error_percent") k = i; next }
    { e = $k; n++; s += e; q += e * e; a = e < 0 ? -e : e; if (a > m) m = a }
    END { printf "%d static points %+.2f %.2f %.2f\n", n, s / n, sqrt((q - s * s / n) / (n - 1)), m }' "$1"
}
grid() { # NAME LIFT-COEFFICIENTS MACH-NUMBERS: an initial model on another grid
  sed "s/table: .*/table: (lift_coefficient: ($2), mach: ($3)),/" $S/AIRCRAFT.ron > $W/$1-aircraft.ron
  cruisefit init --aircraft $W/$1-aircraft.ron --guide $S/guide.csv -o $W/$1.ron
}
run() { # NAME MODEL THRESHOLD REPORTS…
  name=$1 model=$2 threshold=$3; shift 3
  cruisefit adapt "$@" --model $W/$model.ron --law paper --threshold $threshold -o $W/$name
  cruisefit predict $S/static.csv --model $W/$name/models/SIM-750.ron -o $W/$name-static.csv
  errors $W/$name-static.csv
}

# the study
grid study 0.15,0.55,0.05 0.50,0.90,0.05
cruisefit predict $S/static.csv --model $W/study.ron -o $W/initial-static.csv; errors $W/initial-static.csv
run five study 5 $S/reports
run one study 1 $S/reports

# local only: the same nodes and more around them, so that 30 % are never reached
grid large 0.15,0.95,0.05 0.30,0.90,0.05
run local-one large 1 $S/reports

# 108 nodes: 30 % are passed on flight 10
grid last 0.15,0.55,0.05 0.35,0.90,0.05
run last-one last 1 $S/reports

# cells
grid tenth 0.10,0.60,0.10 0.50,0.90,0.10
grid tenth-moved 0.15,0.55,0.10 0.50,0.90,0.10
grid fine 0.15,0.55,0.025 0.50,0.90,0.025
grid finest 0.15,0.55,0.02 0.50,0.90,0.02
for model in tenth tenth-moved fine finest; do
  for threshold in 5 1; do run $model-$threshold $model $threshold $S/reports; done
done

# the 45 static conditions flown, 20 min each, after the ten flights
awk -F, 'BEGIN { print "(seed: 2020, sensors: Rounded, scatter: (heating_value_percent: 0, zero_fuel_mass_percent: 0,"
    print "throttle_split_percent: 0, roll_trim_deg: 0, roll_trim_drift_deg_h: 0), tails: [(tail: \"SIM-750\", flights: Listed([" }
  NR > 1 { printf "(flight: \"S%02d\", start: \"2018-07-%02dT%02d:00:00Z\", duration_s: 1200, ", NR - 1, 1 + int((NR - 2) / 3), 8 * ((NR - 2) % 3)
    printf "waypoints: [(45.5, -73.7), (49.5, -73.7)], pressure_altitude_ft: %s, mach: %s, ", $2, $3
    printf "loading: AtRecording(gross_mass_kg: %.2f, fuel_on_board_kg: 3000), center_of_gravity_percent_mac: 27),\n", $1 * 0.45359237 }
  END { print "]))])" }' $S/static.csv > $W/VISIT.ron
cruisefit simulate $W/VISIT.ron -o $W/visit
for model in study fine finest; do
  for threshold in 5 1; do run $model-visit-$threshold $model $threshold $S/reports $W/visit; done
done

# the same flights a second time, a year later
mkdir $W/again
for report in $S/reports/SIM-750/*.txt; do sed 's/^START    2018/START    2019/' $report > $W/again/$(basename $report); done
for threshold in 5 1; do run again-$threshold study $threshold $S/reports $W/again; done
