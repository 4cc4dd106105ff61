#!/usr/bin/env python3
"""Speed of predictions beside what they are compared with, in the same run: ratios, since machines differ.

    python crates/python/benches/speed.py [--points 10000000] [--whole 200000] [--program target/release/cruisefit]

At the same points (where the Global 5000 of fixtures/global5000 flies), best processor seconds of alternating runs:

- `Model.predict` by an initial model, by a learnt drag table with standard deviations, and by all that a model has learnt from
  the fixture's flights (table, remainder, standing effects; with and without standard deviations; so many points as `--whole`
  says), against OpenAP's fuel flow in numpy;
- with `--program` and polars, Parquet to Parquet on one core: `cruisefit predict` against polars around OpenAP.
"""

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from openap import FuelFlow

import cruisefit

ROOT = Path(__file__).resolve().parents[3]
FIXTURE = ROOT / "fixtures" / "global5000"
PEER = """
import sys
import polars
from openap import FuelFlow, aero
points = polars.read_parquet(sys.argv[1])
mass, altitude, mach = (points[name].to_numpy() for name in ("mass_kg", "pressure_altitude_ft", "mach"))
airspeed = mach * aero.vsound(altitude * aero.ft) / aero.kts
flow = FuelFlow("GLF6").enroute(mass=mass, tas=airspeed, alt=altitude)
points.with_columns(polars.Series("fuel_flow_kg_s", flow)).write_parquet(sys.argv[2])
"""


def seconds(work):
    begun = time.process_time(), time.perf_counter()
    work()
    return time.process_time() - begun[0], time.perf_counter() - begun[1]


def child_seconds(command, environment=None):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def draw(n):
    random = np.random.default_rng(1)
    return pa.table({
        "mass_kg": random.uniform(27_000, 36_000, n),
        "pressure_altitude_ft": random.uniform(38_000, 45_000, n),
        "mach": random.uniform(0.74, 0.84, n),
        "isa_deviation_c": random.uniform(-10, 10, n),
    })


def compare(name, model, points, repeats, **options):
    """Prints processor and wall seconds of both and the ratios."""
    mass, altitude, mach, _ = (column.to_numpy() for column in points.columns)
    airspeed = mach * 295.07 / 0.514444
    peer = FuelFlow("GLF6")
    ours, theirs, wall = [], [], []
    for _ in range(repeats):
        theirs.append(seconds(lambda: peer.enroute(mass=mass, tas=airspeed, alt=altitude)))
        ours.append(seconds(lambda: model.predict(points, threads=1, **options)))
        wall.append(seconds(lambda: model.predict(points, **options))[1])
    (peer_cpu, peer_wall), (cpu, _) = (tuple(map(min, zip(*runs))) for runs in (theirs, ours))
    n = points.num_rows
    print(f"{name:24} {n:9} points  OpenAP {n / peer_cpu / 1e6:6.2f} M/s  here {n / cpu / 1e6:6.2f} M/s of one core: "
          f"ratio {peer_cpu / cpu:.2f}; by the clock on {os.cpu_count()} cores {peer_wall / min(wall):.2f}")


def parquet_to_parquet(points, program, repeats):
    with tempfile.TemporaryDirectory() as folder:
        given, ours, theirs, model = (f"{folder}/{name}" for name in ("in.parquet", "ours.parquet", "theirs.parquet", "MODEL.ron"))
        pq.write_table(points, given)
        subprocess.run([program, "init", "--aircraft", FIXTURE / "AIRCRAFT.ron", "--guide", FIXTURE / "guide.csv", "-o", model],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        one_core = ["taskset", "-c", "0"]
        here, peer = [], []
        environment = os.environ | {"POLARS_MAX_THREADS": "1", "OMP_NUM_THREADS": "1"}
        for _ in range(repeats):
            peer.append(child_seconds([*one_core, sys.executable, "-c", PEER, given, theirs], environment))
            here.append(child_seconds([*one_core, program, "predict", "--model", model, given, "-o", ours]))
        print(f"Parquet to Parquet       {points.num_rows:9} points  polars and OpenAP {min(peer):.2f} s  "
              f"cruisefit predict {min(here):.2f} s (six columns for one): ratio {min(peer) / min(here):.2f}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--points", type=int, default=10_000_000)
    parser.add_argument("--whole", type=int, default=1_000_000)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--program", default="")
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    points = draw(arguments.points)
    initial = cruisefit.Model.initial(FIXTURE / "AIRCRAFT.ron", FIXTURE / "guide.csv")
    learnt = initial.adapt(cruisefit.segment(FIXTURE / "reports")).model()
    if "remainder_percent" not in learnt.predict(points.slice(0, 1)).column_names:
        sys.exit("the model has learnt no more than a table: this would not measure all of it")
    compare("initial model", initial, points, arguments.repeats)
    compare("table with deviations", learnt, points, arguments.repeats, table_only=True)
    compare("whole model", learnt, points.slice(0, arguments.whole), arguments.repeats)
    compare("the same, means alone", learnt, points.slice(0, arguments.whole), arguments.repeats, deviations=False)
    fuel_flow = ["fuel_flow_kg_s"]
    compare("the same, fuel flow", learnt, points.slice(0, arguments.whole), arguments.repeats, columns=fuel_flow)
    fuel_flow += ["fuel_flow_std_kg_s"]
    compare("with its deviation", learnt, points.slice(0, arguments.whole), arguments.repeats, columns=fuel_flow)
    if arguments.program:
        parquet_to_parquet(points, arguments.program, arguments.repeats)


if __name__ == "__main__":
    main()
