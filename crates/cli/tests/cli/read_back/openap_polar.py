"""OpenAP with an exported polar: POLAR.yml, and a table of predictions. Differences of drag, %."""
import csv
import sys

import openap
import yaml

drag = openap.Drag("A320")  # any type: polar and wing area are replaced
with open(sys.argv[1], encoding="utf-8") as file:
    drag.polar = yaml.safe_load(file)
drag.aircraft["wing"]["area"] = 94.94690688
for row in csv.DictReader(open(sys.argv[2], encoding="utf-8")):
    altitude_ft, mach, mass = (float(row[k]) for k in ("pressure_altitude_ft", "mach", "mass_kg"))
    tas_kt = openap.aero.mach2tas(mach, altitude_ft * openap.aero.ft) / openap.aero.kts
    found = float(drag.clean(mass=mass, tas=tas_kt, alt=altitude_ft))
    lift_coefficient, force = drag._cl(mass, tas_kt, altitude_ft)
    print("value", 100 * (found / (float(row["drag_coefficient"]) * float(force)) - 1))
