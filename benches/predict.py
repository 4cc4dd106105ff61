"""Fuel flow at many flight points: this program's column of points next to OpenAP's vectorised one, same points, one run.

    cargo build --release --locked -p cruisefit-perf-model --example predict_speed
    PYTHON_WITH_OPENAP benches/predict.py FOLDER [--points 100000] [--runs 5] [--type GLF6] [--target target/release]

The points are drawn uniformly (seed 1) where the Global 5000 of fixtures/global5000 flies. Both programs hold them in memory as
columns before they are timed, each runs on one core, the two alternate; printed are the best processor times and their ratio.
Our aircraft file gets a Mach exponent other than zero, so that its power is computed.
"""
import argparse
import json
import pathlib
import random
import subprocess
import time

import numpy
import openap

ROOT = pathlib.Path(__file__).resolve().parent.parent


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--points", type=int, default=100_000)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--type", default="GLF6")
    parser.add_argument("--target", type=pathlib.Path, default=ROOT / "target/release")
    asked = parser.parse_args()
    asked.folder.mkdir(parents=True, exist_ok=True)
    draw = random.Random(1)
    rows = [
        (draw.uniform(27000, 36000), draw.uniform(38000, 45000), draw.uniform(0.74, 0.84), draw.uniform(-10, 10))
        for _ in range(asked.points)
    ]
    points = asked.folder / "points.csv"
    lines = ["mass_kg,pressure_altitude_ft,mach,isa_deviation_c", *(",".join(map(repr, row)) for row in rows)]
    points.write_text("\n".join(lines) + "\n")
    fixture = ROOT / "fixtures/global5000"
    aircraft = asked.folder / "AIRCRAFT.ron"
    aircraft.write_text((fixture / "AIRCRAFT.ron").read_text().replace("mach_exponent: 0.0", "mach_exponent: 0.6"))
    ours = [str(asked.target / "examples/predict_speed"), str(aircraft), str(fixture / "guide.csv"), str(points)]
    mass, altitude, mach, _ = (numpy.array(column) for column in zip(*rows))
    airspeed = mach * openap.aero.vsound(altitude * openap.aero.ft) / openap.aero.kts
    peer = openap.FuelFlow(asked.type)
    columns, singles, peers = [], [], []
    for _ in range(asked.runs):
        found = json.loads(subprocess.run(ours, stdout=subprocess.PIPE, check=True, text=True).stdout)
        columns.append(found["best_s"])
        singles.append(found["best_single_s"])
        for _ in range(20):
            begun = time.process_time()
            flow = peer.enroute(mass, airspeed, altitude)
            peers.append(time.process_time() - begun)
    rate = lambda seconds: asked.points / min(seconds) / 1e6
    print(f"{asked.points} points, {found['inside']} inside the table, best of {asked.runs} runs of 20 passes")
    print(f"cruisefit, column of points     {rate(columns):6.1f} M points/s  mean {found['mean_kg_s']:.3f} kg/s")
    print(f"cruisefit, single predictions   {rate(singles):6.1f} M points/s")
    print(f"OpenAP {openap.__version__ if hasattr(openap, '__version__') else ''} {asked.type}, numpy  {rate(peers):6.1f} M points/s"
          f"  mean {float(numpy.mean(flow)):.3f} kg/s")
    print(f"ratio {rate(columns) / rate(peers):.2f}")


if __name__ == "__main__":
    main()
