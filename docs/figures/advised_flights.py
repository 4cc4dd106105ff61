#!/usr/bin/env python3
"""Flies the flights that `cruisefit diagnose` advises, and compares the distance that was announced with the one reached.

    python3 docs/figures/advised_flights.py target/release/cruisefit DIR SEED [EFFECT SIZE]

A model is adapted on sixty varied flights of the virtual aircraft (`adapt`, law bayes). Thirty clean flights of one habit (FLEETS)
are diagnosed. Every pair of effects for which flights are advised beforehand (`detectable`, `separations`) is diagnosed alone
(`--effects a,b`), with the advised flights flown as their words say, and with six more flights of the habit instead.
With two effects in the library, `nearest_other` is the distance between them (or from nothing, where that is less).
Where the data support another hidden parameter of the first effect with the new flights than without (Mdd, throttle pivot), the
two distances are of different effects: "moved". Prints one line a pair, and a table in Markdown at the end. Needs no packages.

With an effect and a size: that effect is planted in the fleet of one speed, and the verdicts on thirty flights, with the six advised
against `tsfc_factor`, and with six ordinary ones, are printed. The model must be there from a run without.
"""

import datetime
import json
import pathlib
import re
import shutil
import subprocess
import sys

FLEETS = {
    "one speed": "high_mach: Some((0.79, 0.81)), low_share: 0, speed_changes_per_h: 0,",
    "narrow": "high_mach: Some((0.78, 0.84)), high_ft: Some((33000, 41000)), low_share: 0,",
    "varied": "",
}
FLIGHTS = 30
HOLD_S = 600
FIRST_DAY = datetime.datetime(2020, 12, 2, 8)
SWEEP = re.compile(r"a Mach sweep ([\d.]+) to ([\d.]+)(?: \(.*?\))? at FL(\d+), .*?\(from ([\d.]+) t\)")
LEVELS = re.compile(r"levels from FL(\d+) to FL(\d+) at Mach ([\d.]+), .*?\(from ([\d.]+) t\)")


class Bench:
    def __init__(self, binary, root, seed):
        self.binary, self.root, self.seed = binary, pathlib.Path(root), seed
        self.root.mkdir(parents=True, exist_ok=True)

    def run(self, *arguments):
        found = subprocess.run([self.binary, *map(str, arguments)], capture_output=True, text=True)
        if found.returncode not in (0, 1):
            sys.exit(f"{arguments}: {found.stderr}")

    def fly(self, name, seed, flights, truth=""):
        """Reports of a tail, clean where `truth` is empty."""
        plan, reports = self.root / f"{name}.ron", self.root / name
        plan.write_text(f'(seed: {seed}, tails: [(tail: "T-001", {truth} flights: {flights})])')
        shutil.rmtree(reports, ignore_errors=True)
        self.run("simulate", plan, "-o", reports)
        return reports

    def model(self):
        study, initial = self.root / "study", self.root / "initial.ron"
        self.run("simulate", "ghazi-2020", "-o", study)
        self.run("init", "--aircraft", study / "AIRCRAFT.ron", "--guide", study / "guide.csv", "-o", initial)
        learnt = self.root / "learnt"
        shutil.rmtree(learnt, ignore_errors=True)
        self.run("adapt", self.fly("taught", self.seed, "Designed((flights: 60))"), "--model", initial, "-o", learnt)
        return learnt / "models" / "T-001.ron"

    def diagnose(self, reports, model, options):
        out = self.root / "found"
        shutil.rmtree(out, ignore_errors=True)
        self.run("diagnose", *reports, "--model", model, "-o", out, *options)
        found = json.loads((out / "diagnosis.json").read_text())["diagnoses"][0]
        return found, {entry["effect"]: entry for entry in found["detectable"]}


def hidden(found, effect):
    """The value of an effect's hidden parameter that the data support, in words."""
    return next((cause["hidden"] for cause in found["causes"] if cause["effect"] == effect), "")


def designed(number, habit, first, last):
    return f'Designed((flights: {number}, {habit} dates: ("{first}T00:00:00Z", "{last}T00:00:00Z")))'


def listed(words, number, day):
    """Flights as an advice says: ten holds of ten minutes."""
    if match := SWEEP.search(words):
        low, high, level, mass_t = map(float, match.groups())
        machs = [low + (high - low) * k / 9 for k in range(10)]
        levels = [level] * 10
    else:
        low, high, mach, mass_t = map(float, LEVELS.search(words).groups())
        real = [fl for fl in [*range(10, 411, 10), *range(430, 600, 20)] if low <= fl <= high]
        levels = [real[(k * (len(real) - 1) + 4) // 9] for k in range(10)]
        machs = [mach] * 10
    changes = []
    for k in range(1, 10):
        if machs[k] != machs[k - 1]:
            changes.append(f"Mach(at_s: {HOLD_S * k}, mach: {machs[k]:.5f})")
        if levels[k] != levels[k - 1]:
            changes.append(f"PressureAltitude(at_s: {HOLD_S * k}, feet: {100 * levels[k]})")
    flights = []
    for k in range(number):
        start = (FIRST_DAY + datetime.timedelta(days=day + 2 * k)).strftime("%Y-%m-%dT%H:%M:%SZ")
        latitude, east = 40 + 2 * k, -40 if k % 2 else -100
        flights.append(
            f'(flight: "X{day}-{k}", start: "{start}", duration_s: {10 * HOLD_S}, '
            f"waypoints: [({latitude}, -70), ({latitude}, {east})], pressure_altitude_ft: {100 * levels[0]}, "
            f"mach: {machs[0]:.5f}, loading: AtRecording(gross_mass_kg: {1000 * mass_t}, fuel_on_board_kg: 5200), "
            f"center_of_gravity_percent_mac: 25, changes: [{', '.join(changes)}])"
        )
    return f"Listed([{', '.join(flights)}])"


def verdicts(binary, root, seed, effect, size):
    bench = Bench(binary, root, seed)
    model = bench.root / "learnt" / "models" / "T-001.ron"
    references = json.loads((bench.root / "taught" / "TRUTH.json").read_text())["tails"][0]["references"]
    told = ", ".join(f"{name}: {value}" for name, value in references.items())
    truth = f'effects: [(id: "{effect}", size: {size})], references: Some(({told})),'
    habit = FLEETS["one speed"]
    flown = bench.fly("planted", seed + 1, designed(FLIGHTS, habit, "2020-01-01", "2020-12-01"), truth)
    more = bench.fly("planted-more", seed + 2, designed(6, habit, "2020-12-03", "2020-12-20"), truth)
    _, pair = bench.diagnose([flown], model, ["--effects", f"{effect},tsfc_factor"])
    advised = [one["measurement"] for one in pair[effect]["separations"] if "distance_ordinary_flights" in one]
    sorts = advised[0].split(", and three with ") if advised else []
    extra = [
        bench.fly(f"planted-advised{k}", seed + 3 + k, listed(words, 6 // len(sorts), 20 * k), truth)
        for k, words in enumerate(sorts)
    ]
    for name, reports in (("thirty", []), ("advised", extra), ("ordinary", [more])):
        found, _ = bench.diagnose([flown, *reports], model, [])
        verdict, causes = found["verdict"], found["causes"][:1]
        sizes = [(cause["effect"], round(cause["magnitude"]["value"], 3)) for cause in causes]
        print(name, verdict["kind"], verdict["effects"], round(verdict["probability"], 2), verdict["class"], sizes)


def main(binary, root, seed):
    bench = Bench(binary, root, seed)
    model = bench.model()
    rows = []
    for fleet, habit in FLEETS.items():
        flown = bench.fly("flown", seed + 1, designed(FLIGHTS, habit, "2020-01-01", "2020-12-01"))
        more = bench.fly("more", seed + 2, designed(6, habit, "2020-12-03", "2020-12-20"))
        for against in ([], ["--table-only"]):
            _, confused = bench.diagnose([flown], model, against)
            pairs = {
                (effect, one["from"])
                for effect, entry in confused.items()
                for one in entry["separations"]
                if "distance_ordinary_flights" in one
            }
            print(f"{fleet} {against}: {len(pairs)} pairs with advised flights", flush=True)
            for effect, other in sorted(pairs):
                options = ["--effects", f"{effect},{other}", *against]
                before, now = bench.diagnose([flown], model, options)
                for one in now[effect]["separations"]:
                    if "distance_ordinary_flights" not in one:
                        continue
                    sorts = one["measurement"].split(", and three with ")
                    reports = [flown]
                    for k, words in enumerate(sorts):
                        reports.append(bench.fly(f"advised{k}", seed + 3 + k, listed(words, 6 // len(sorts), 20 * k)))
                    found, then = bench.diagnose(reports, model, options)
                    _, ordinary = bench.diagnose([flown, more], model, options)
                    moved = hidden(before, effect) != hidden(found, effect)
                    row = (
                        fleet, "table" if against else "baseline", effect, other, one["measurement"],
                        now[effect]["nearest_other"],
                        one["distance_then"], then[effect]["nearest_other"],
                        one["distance_ordinary_flights"], ordinary[effect]["nearest_other"],
                        "moved" if moved else "",
                    )
                    rows.append(row)
                    print(row, found["left_out"], flush=True)
    print("| fleet | against | effect from other | advised | now | announced | reached | ordinary, announced | reached |")
    print("|---|---|---|---|---|---|---|---|---|")
    for fleet, against, effect, other, words, *distances, moved in rows:
        figures = " | ".join(f"{distance:.2f}" for distance in distances)
        print(f"| {fleet} | {against} | `{effect}` from `{other}` {moved} | {words} | {figures} |")
    for name, kept in (("", "same"), ("moved", "moved")):
        ratios = sorted(row[7] / row[6] for row in rows if row[10] == name)
        print(f"reached/announced, hidden parameter {kept}: {[round(ratio, 3) for ratio in ratios]}")


if __name__ == "__main__":
    if len(sys.argv) > 4:
        verdicts(sys.argv[1], sys.argv[2], int(sys.argv[3]), sys.argv[4], float(sys.argv[5]))
    else:
        main(sys.argv[1], sys.argv[2], int(sys.argv[3]))
