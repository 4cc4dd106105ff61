#!/usr/bin/env python3
"""Speed of the package beside what it is compared with, in the same run: ratios, since machines differ.

    python crates/python/benches/speed.py [--points 10000000]

`Model.predict` by an initial model against OpenAP's fuel flow in numpy, at the same points (A320, FL320 to FL380).
"""

import argparse
import time
import warnings
from pathlib import Path

import numpy as np
import pyarrow as pa
from openap import FuelFlow

import cruisefit

ROOT = Path(__file__).resolve().parents[3]


def seconds(work):
    begun = time.perf_counter()
    work()
    return time.perf_counter() - begun


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--points", type=int, default=10_000_000)
    parser.add_argument("--repeats", type=int, default=3)
    arguments = parser.parse_args()
    n = arguments.points
    random = np.random.default_rng(1)
    mass_kg = random.uniform(55_000, 70_000, n)
    altitude_ft = random.uniform(32_000, 38_000, n)
    mach = random.uniform(0.76, 0.80, n)
    temperature_k = 288.15 - 0.0019812 * np.minimum(altitude_ft, 36_089)
    true_airspeed_kt = mach * 661.4786 * np.sqrt(temperature_k / 288.15)
    points = pa.table({"mass_kg": mass_kg, "pressure_altitude_ft": altitude_ft, "mach": mach})
    folder = ROOT / "fixtures" / "a320-generic"
    warnings.simplefilter("ignore")
    model = cruisefit.Model.initial(folder / "AIRCRAFT.ron", folder / "guide.csv")
    other = FuelFlow("A320")
    ours, ours_one, theirs = [], [], []
    for _ in range(arguments.repeats):
        theirs.append(seconds(lambda: other.enroute(mass=mass_kg, tas=true_airspeed_kt, alt=altitude_ft)))
        ours.append(seconds(lambda: model.predict(points)))
        ours_one.append(seconds(lambda: model.predict(points, threads=1)))
    predicted = model.predict(points.slice(0, 100_000))
    missing = predicted.column("fuel_flow_kg_s").null_count
    print(f"{n} points, best of {arguments.repeats}: OpenAP {min(theirs):.2f} s; "
          f"Model.predict {min(ours):.2f} s, on one thread {min(ours_one):.2f} s")
    print(f"ratio {min(theirs) / min(ours):.2f}, on one thread {min(theirs) / min(ours_one):.2f}; "
          f"{missing} of the first 100000 points outside the table")


if __name__ == "__main__":
    main()
