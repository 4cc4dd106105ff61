"""The whole chain over a fleet, next to a plain reader and next to peers, in one run on the same files.

    cargo build --release --locked -p cruisefit --examples && cargo build --release --locked -p cruisefit
    python3 benches/chain.py FOLDER [--reports 20000] [--tails 400] [--runs 3] [--cores 1] [--law paper]
        [--python PYTHON_WITH_NUMPY_AND_POLARS] [--peers numpy,polars]

Makes its reports in FOLDER/reports on the first call: copies of the reports in fixtures/global5000 with tail, flight, START
and zero-fuel weight changed, columns separated by single blanks (polars needs that). Every test reads all files once
before it is timed, so that the page cache is warm, and is pinned to as many cores as asked for. Times are processor
seconds (user + system) and wall seconds, best of the runs; ratios are to the plain reader (examples/plain_reader.rs:
open, read, add up the bytes). Standard library only.
"""
import argparse
import datetime
import os
import pathlib
import re
import resource
import shutil
import subprocess
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent


def make_reports(folder, reports, tails):
    """Reports that differ in who, when and how heavy; the samples of one fixture serve many flights."""
    sources = sorted((ROOT / "fixtures/global5000/reports").glob("*.txt"))
    texts = []
    for source in sources:
        lines = source.read_text().splitlines()
        rows = [line for line in lines if not line.startswith(("#", "TAIL", "FLIGHT", "START", "ZFW"))]
        texts.append("\n".join(" ".join(line.split()) for line in rows[1:]) + "\n")
    first = datetime.datetime(2019, 1, 1, 6)
    for number in range(reports):
        tail, flight = number % tails, number // tails
        start = first + datetime.timedelta(hours=6 * flight, minutes=tail % 60)
        zero_fuel_lb = 52000 + (number * 7919) % 2000
        head = (
            f"CRUISE-REPORT 1\nTAIL B-{tail:04}\nFLIGHT {flight:05}\n"
            f"START {start:%Y-%m-%dT%H:%M:%S}Z\nZFW {zero_fuel_lb} lb\n"
        )
        path = folder / f"B-{tail:04}" / f"{flight:05}.txt"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(head + texts[(tail + flight) % len(texts)])


def timed(command, cores, runs):
    """Best processor and wall seconds, largest memory in MB, last line of the output."""
    best_cpu, best_wall, last = float("inf"), float("inf"), ""
    for _ in range(runs):
        for step in command.get("before", []):
            step()
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        begun = time.monotonic()
        done = subprocess.run(
            ["/usr/bin/env", "taskset", "-c", ",".join(map(str, range(cores)))] + command["run"],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False,
        )
        wall = time.monotonic() - begun
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode not in (0, 1):
            return None
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        best_cpu, best_wall = min(best_cpu, cpu), min(best_wall, wall)
        last = done.stdout.strip().splitlines()[-1] if done.stdout.strip() else ""
    return best_cpu, best_wall, last


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--reports", type=int, default=20000)
    parser.add_argument("--tails", type=int, default=400)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--cores", type=int, default=1)
    parser.add_argument("--law", default="paper")
    parser.add_argument("--python", default="")
    parser.add_argument("--peers", default="numpy,polars")
    parser.add_argument("--target", type=pathlib.Path, default=ROOT / "target/release")
    asked = parser.parse_args()
    reports = asked.folder / f"reports-{asked.reports}-{asked.tails}"
    if not reports.exists():
        make_reports(reports, asked.reports, asked.tails)
    program, model = str(asked.target / "cruisefit"), str(asked.folder / "MODEL.ron")
    fixture = ROOT / "fixtures/global5000"
    subprocess.run(
        [program, "init", "--aircraft", str(fixture / "AIRCRAFT.ron"), "--guide", str(fixture / "guide.csv"), "-o", model],
        stdout=subprocess.DEVNULL, check=True,
    )
    reader = [str(asked.target / "examples/plain_reader"), str(reports)]
    warm = lambda: subprocess.run(reader, stdout=subprocess.DEVNULL, check=True)
    output = asked.folder / "out"
    adapt = [program, "adapt", str(reports), "--model", model, "-o", str(output), "--law", asked.law,
             "--threads", str(asked.cores)]
    tests = {
        "plain reader": {"run": reader, "before": [warm]},
        f"adapt, law {asked.law}": {
            "run": adapt, "before": [lambda: shutil.rmtree(output, ignore_errors=True), warm],
        },
        "adapt again, nothing new": {"run": adapt, "before": [warm]},
        "segment": {
            "run": [program, "segment", str(reports), "-o", str(asked.folder / "s.csv"), "--threads", str(asked.cores)],
            "before": [warm],
        },
    }
    if asked.python:
        for peer in asked.peers.split(","):
            tests[peer] = {
                "run": [asked.python, str(ROOT / "benches/peers.py"), str(reports), peer, "1"], "before": [warm],
            }
    base = None
    print(f"{asked.reports} reports of {asked.tails} tails, {asked.cores} cores, load {os.getloadavg()[0]:.1f}")
    for name, test in tests.items():
        figures = timed(test, asked.cores, asked.runs)
        if figures is None:
            print(f"{name:28} failed")
            continue
        cpu, wall, last = figures
        base = base or cpu
        inside = re.search(r'"best_s": ([0-9.]+)', last) or re.search(r'"seconds": ([0-9.]+)', last)
        note = f"  (of it {inside[1]} s without start-up)" if inside else ""
        print(f"{name:28} cpu {cpu:8.2f} s  wall {wall:8.2f} s  {cpu / base:6.1f} x{note}")
    print(f"largest memory of a test: {resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024:.0f} MB")


if __name__ == "__main__":
    main()
