#!/usr/bin/env bash
# The book's pictures, made by the program from its demonstration: docs/src/pictures.
#
#     docs/pictures.sh target/release/cruisefit
#
# Charts are SVG by `cruisefit plot`; pages are PNG by a headless Chromium, and keep their pictures where there is none.
set -euo pipefail
program=$(realpath "${1:?usage: docs/pictures.sh PROGRAM}")
cd "$(dirname "$0")/.."
pictures=$PWD/docs/src/pictures
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$pictures"
cd "$scratch"

"$program" demo -o demo >/dev/null
"$program" simulate "$OLDPWD/docs/pictures.ron" -o fleet --quiet
"$program" adapt fleet --model demo/MODEL.ron -o adapted --quiet
"$program" monitor adapted -o monitor --quiet
"$program" diagnose fleet --model demo/MODEL.ron --fleet -o compared --quiet
"$program" trial "$OLDPWD/docs/pictures_trials.ron" -o trials --quiet
"$program" plot demo/adapted-bayes --chart histogram,time,surface,relief -o "$pictures/tail.svg" --quiet
"$program" plot demo/diagnosis -o "$pictures/gap.svg" --quiet

chromium=$(command -v chromium || command -v chromium-browser || true)
if [ -z "$chromium" ]; then
  echo "no Chromium: the pictures of pages stay as they are" >&2
  exit 0
fi
# page name width height
shot() {
  "$chromium" --headless --no-sandbox --disable-gpu --hide-scrollbars --force-device-scale-factor=1 \
    --window-size="$3,$4" --screenshot="$pictures/$2.png" "file://$scratch/$1" 2>/dev/null
}
shot demo/adapted-bayes/report.html report 900 760
shot demo/diagnosis/diagnosis.html diagnosis 900 760
shot adapted/report.html fleet 900 620
shot monitor/monitor.html monitor 900 800
shot compared/fleet.html compared 900 600
shot trials/trials.html trials 900 760
for picture in "$pictures"/*.png; do
  [ "$(wc -c <"$picture")" -le 150000 ] || { echo "$picture is larger than 150 kB" >&2; exit 1; }
done
