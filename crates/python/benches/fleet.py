#!/usr/bin/env python3
"""A fleet on Spark beside the command line, in the same run: the same models and segments to the bit, and what it costs.

    python crates/python/benches/fleet.py [--tails 400] [--flights 50] [--kill 0] [--master "local-cluster[2,1,2048]"]

Reports of virtual tails are written as files for the command line and as Parquet for Spark. Both read, learn and write all
tails. `--kill N` kills N executors of this run at random moments. Times are CPU seconds of all processes and wall-clock
seconds; a machine that does other work at the same time makes the latter meaningless.
"""

import argparse
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

import cruisefit

ROOT = Path(__file__).resolve().parents[3]
FIXTURE = ROOT / "fixtures" / "ghazi-2020"


def write_reports(folder, tails, flights):
    for first in range(0, tails, 20):
        some = min(20, tails - first)
        reports = cruisefit.simulate(plan(first, some, flights)).reports
        for name, content in reports:
            path = folder / "reports" / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        table = pa.table({"path": [name for name, _ in reports], "content": [c for _, c in reports]})
        (folder / "parquet").mkdir(exist_ok=True)
        pq.write_table(table, folder / "parquet" / f"{first:05}.parquet")


def plan(first, some, flights):
    listed = ", ".join(
        f'(tail: "T-{tail:04}", flights: Designed((flights: {flights})))'
        for tail in range(first, first + some)
    )
    return f"(seed: {20261122 + first}, aircraft: Preset(citation_x), tails: [{listed}])"


def cpu_s():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def executors(application):
    """Process ids of the executors of this application."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                line = (entry / "cmdline").read_bytes()
            except OSError:
                continue
            if b"CoarseGrainedExecutorBackend" in line and application.encode() in line and line.startswith(b"/"):
                found.append(int(entry.name))
    return found


def kill_some(application, count, done):
    chance = random.Random()
    killed = 0
    while killed < count and not done.wait(chance.uniform(2, 8)):
        alive = executors(application)
        if alive:
            os.kill(chance.choice(alive), signal.SIGKILL)
            killed += 1
    print(f"{killed} executors killed")


def on_spark(folder, master, kills):
    from pyspark.sql import SparkSession

    import cruisefit.spark

    os.environ["PYSPARK_PYTHON"] = os.environ["PYSPARK_DRIVER_PYTHON"] = sys.executable
    session = (
        SparkSession.builder.master(master)
        .config("spark.ui.enabled", "false")
        .config("spark.sql.shuffle.partitions", "8")
        .config("spark.executor.memory", "1g")
        .config("spark.deploy.maxExecutorRetries", "-1")
        .config("spark.task.maxFailures", "20")
        .getOrCreate()
    )
    session.sparkContext.setLogLevel("ERROR")
    done = threading.Event()
    killer = threading.Thread(target=kill_some, args=(session.sparkContext.applicationId, kills, done))
    begun = time.perf_counter()
    killer.start()
    model = cruisefit.Model.initial(FIXTURE / "AIRCRAFT.ron", FIXTURE / "guide.csv")
    reports = session.read.parquet(str(folder / "parquet"))
    flights = cruisefit.spark.flights(reports, report="content", path="path")
    cruisefit.spark.adapt(flights, [model]).write.parquet(str(folder / "adapted"))
    wall = time.perf_counter() - begun
    done.set()
    killer.join()
    session.stop()
    session.sparkContext._gateway.shutdown()
    session.sparkContext._gateway.proc.stdin.close()
    session.sparkContext._gateway.proc.wait()
    return wall


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--tails", type=int, default=400)
    parser.add_argument("--flights", type=int, default=50)
    parser.add_argument("--kill", type=int, default=0)
    parser.add_argument("--master", default="local-cluster[2,1,2048]")
    parser.add_argument("--program", type=Path, default=ROOT / "target" / "release" / "cruisefit")
    arguments = parser.parse_args()
    folder = Path(tempfile.mkdtemp(prefix="cruisefit-fleet-"))
    write_reports(folder, arguments.tails, arguments.flights)
    model = folder / "MODEL.ron"
    cruisefit.Model.initial(FIXTURE / "AIRCRAFT.ron", FIXTURE / "guide.csv").save(model)
    before, begun = cpu_s(), time.perf_counter()
    command = [arguments.program, "adapt", folder / "reports", "--model", model, "-o", folder / "out", "--no-progress"]
    subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    one = (cpu_s() - before, time.perf_counter() - begun)
    before = cpu_s()
    wall = on_spark(folder, arguments.master, arguments.kill)
    many = (cpu_s() - before, wall)
    rows = {row["tail"]: row for row in pq.read_table(folder / "adapted").to_pylist()}
    equal = 0
    for tail, row in rows.items():
        ours = [row["model"].encode(), row["segments_csv"].encode(), row["flights_csv"].encode()]
        theirs = [(folder / "out" / kind / f"{tail}.{end}").read_bytes()
                  for kind, end in (("models", "ron"), ("segments", "csv"), ("flights", "csv"))]
        equal += ours == theirs
    print(f"{arguments.tails * arguments.flights} reports of {arguments.tails} tails; {equal} of {len(rows)} tails on Spark equal "
          "the command line's to the bit (model, segments, flights)")
    print(f"command line: {one[0]:.1f} CPU s, {one[1]:.1f} s; Spark: {many[0]:.1f} CPU s, {many[1]:.1f} s; "
          f"ratio {many[0] / one[0]:.1f} by CPU, {many[1] / one[1]:.1f} by wall clock")
    shutil.rmtree(folder)
    sys.exit(equal != arguments.tails)


if __name__ == "__main__":
    main()
