#!/usr/bin/env python3
"""A fleet on Spark beside the command line, in the same run: the same models and segments to the bit, and what it costs.

    python crates/python/benches/fleet.py [--tails 400] [--flights 50] [--kill 0] [--master "local-cluster[2,1,2048]"] [--archive FILE]

Reports of virtual tails are written as files for the command line and as Parquet for Spark. Both read, learn and write all
tails, on two processors. `--kill N` kills N executors of this run at random moments. `--archive FILE` lets every Java process
load Spark's classes from an archive (class-data sharing), which a small run makes where the file does not exist: as an image of
a cluster would hold it, once for a version of Java and Spark. Making it is not counted.

CPU seconds are those of every process of a run, executors that were killed and Python's workers among them: each side runs in
a session of its own, whose processes are read five times a second. They are given by kind of process: driver and executors (Java), workers (Python), the command line. Wall-clock
seconds mean nothing on a machine that does other work at the same time.
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
# A job of minutes on two processors: Java's second compiler and its parallel collectors cost more than they save.
SHORT = "-XX:TieredStopAtLevel=1 -XX:+UseSerialGC"


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


class Session:
    """A command in a session of its own, and the CPU seconds of every process in it."""

    PER_SECOND = os.sysconf("SC_CLK_TCK")

    def __init__(self, command):
        begun, before = time.perf_counter(), self.waited_for_s()
        self.seconds = {}
        process = subprocess.Popen(
            [str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True
        )
        while process.poll() is None:
            self.look(process.pid)
            time.sleep(0.2)
        self.wall_s = time.perf_counter() - begun
        # Of a run without orphans this is all, to the last moment.
        self.at_least_s = self.waited_for_s() - before
        self.output = process.stdout.read().decode()
        if process.returncode not in (0, 1):
            sys.exit(f"{command[0]} ended with {process.returncode}")

    def look(self, session):
        for entry in Path("/proc").iterdir():
            try:
                name, fields = (entry / "stat").read_text().split(" (", 1)[1].rsplit(") ", 1)
            except (OSError, IndexError):
                continue
            fields = fields.split()
            if int(fields[3]) == session:
                # Parents count what the children that they waited for have used: not again here.
                self.seconds[entry.name, name] = (int(fields[11]) + int(fields[12])) / self.PER_SECOND

    @staticmethod
    def waited_for_s():
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        return used.ru_utime + used.ru_stime

    def cpu_s(self):
        return max(sum(self.seconds.values()), self.at_least_s)

    def by_kind(self):
        kinds = {}
        for (_, name), seconds in self.seconds.items():
            kinds[name] = kinds.get(name, 0.0) + seconds
        kinds = sorted(kinds.items(), key=lambda kind: -kind[1])
        return ", ".join(f"{name} {seconds:.1f}" for name, seconds in kinds if seconds >= 0.5)


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


def on_spark(folder, master, kills, java):
    from pyspark.sql import SparkSession

    import cruisefit.spark

    os.environ["PYSPARK_PYTHON"] = os.environ["PYSPARK_DRIVER_PYTHON"] = sys.executable
    session = (
        SparkSession.builder.master(master)
        .config("spark.driver.extraJavaOptions", java)
        .config("spark.executor.extraJavaOptions", java)
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
    killer.start()
    model = cruisefit.Model.initial(FIXTURE / "AIRCRAFT.ron", FIXTURE / "guide.csv")
    reports = session.read.parquet(str(folder / "parquet"))
    flights = cruisefit.spark.flights(reports, report="content", path="path")
    cruisefit.spark.adapt(flights, [model]).write.parquet(str(folder / "adapted"))
    done.set()
    killer.join()
    session.stop()
    session.sparkContext._gateway.shutdown()
    session.sparkContext._gateway.proc.stdin.close()
    session.sparkContext._gateway.proc.wait()


def make_archive(folder, archive):
    """An archive of the classes that such a job loads: driver and executor are one process, which writes it when it ends."""
    small = folder / "small"
    (small / "parquet").mkdir(parents=True)
    shutil.copy(min((folder / "parquet").iterdir()), small / "parquet")
    java = f"{SHORT} -XX:ArchiveClassesAtExit={archive}"
    command = [sys.executable, __file__, "--on-spark", small, "--master", "local[2]", f"--java={java}"]
    # Java lists on standard output what it leaves out.
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--tails", type=int, default=400)
    parser.add_argument("--flights", type=int, default=50)
    parser.add_argument("--kill", type=int, default=0)
    parser.add_argument("--master", default="local-cluster[2,1,2048]")
    parser.add_argument("--archive", type=Path)
    parser.add_argument("--java", default=SHORT, help=argparse.SUPPRESS)
    parser.add_argument("--on-spark", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--program", type=Path, default=ROOT / "target" / "release" / "cruisefit")
    arguments = parser.parse_args()
    if arguments.on_spark:
        on_spark(arguments.on_spark, arguments.master, arguments.kill, arguments.java)
        return
    folder = Path(tempfile.mkdtemp(prefix="cruisefit-fleet-"))
    write_reports(folder, arguments.tails, arguments.flights)
    model = folder / "MODEL.ron"
    cruisefit.Model.initial(FIXTURE / "AIRCRAFT.ron", FIXTURE / "guide.csv").save(model)
    # Two processors for both sides.
    two = ["taskset", "-c", ",".join(map(str, sorted(os.sched_getaffinity(0))[:2]))]
    adapt = [arguments.program, "adapt", folder / "reports", "--model", model, "-o", folder / "out", "--no-progress"]
    one = Session([*two, *adapt])
    java = SHORT
    if arguments.archive:
        archive = arguments.archive.resolve()
        if not archive.exists():
            make_archive(folder, archive)
        java += f" -XX:SharedArchiveFile={archive}"
    here = [sys.executable, __file__, "--on-spark", folder, "--master", arguments.master, "--kill", arguments.kill]
    many = Session([*two, *here, f"--java={java}"])
    print(many.output, end="")
    rows = {row["tail"]: row for row in pq.read_table(folder / "adapted").to_pylist()}
    equal = 0
    for tail, row in rows.items():
        ours = [row["model"].encode(), row["segments_csv"].encode(), row["flights_csv"].encode()]
        theirs = [(folder / "out" / kind / f"{tail}.{end}").read_bytes()
                  for kind, end in (("models", "ron"), ("segments", "csv"), ("flights", "csv"))]
        equal += ours == theirs
    print(f"{arguments.tails * arguments.flights} reports of {arguments.tails} tails; {equal} of {len(rows)} tails on Spark equal "
          "the command line's to the bit (model, segments, flights)")
    print(f"command line: {one.cpu_s():.1f} CPU s ({one.by_kind()}), {one.wall_s:.1f} s\n"
          f"Spark: {many.cpu_s():.1f} CPU s ({many.by_kind()}), {many.wall_s:.1f} s\n"
          f"ratio {many.cpu_s() / one.cpu_s():.2f} by CPU, {many.wall_s / one.wall_s:.2f} by wall clock")
    shutil.rmtree(folder)
    sys.exit(equal != arguments.tails)


if __name__ == "__main__":
    main()
