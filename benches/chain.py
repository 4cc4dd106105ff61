"""The whole chain over a fleet, next to a plain reader and next to peers, in one run on the same files.

    cargo build --release --locked -p cruisefit --examples && cargo build --release --locked -p cruisefit
    python3 benches/chain.py FOLDER [--reports 20000] [--tails 400] [--runs 3] [--cores 1] [--law paper]
        [--python PYTHON_WITH_NUMPY_AND_POLARS] [--peers numpy,polars]

Makes its reports in FOLDER on the first call, from those in fixtures/global5000: tail, flight, START and zero-fuel weight
changed, ground speed and latitude moved by as much as no other report of them (or the program would find that flights were
copied, and say so 20,000 times), columns separated by single blanks (polars needs that). Every test reads all files once
before it is timed, so that the page cache is warm, and is pinned to as many cores as asked for. Every run writes into a
folder of its own, and all are deleted at the end: a file system that has just deleted thousands of files is slow at making
new ones (ext4 gives no inode out again within five seconds; it was a fifth of a run). Times are processor seconds (user +
system) and wall seconds, best of the runs; ratios are to the plain reader (examples/plain_reader.rs: open, read, add up the
bytes). Where the processor counts instructions for `perf stat`, so are they. Standard library only.
"""
import argparse
import datetime
import os
import pathlib
import re
import resource
import shutil
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent


def make_reports(folder, reports, tails, longest=None):
    """Reports that differ in who, when, where, how fast over ground and how heavy; the rest of a fixture serves many flights.

    With `longest`, each ends after so many samples.
    """
    sources = sorted((ROOT / "fixtures/global5000/reports").glob("*.txt"))
    texts = []
    for source in sources:
        lines = source.read_text().splitlines()
        rows = [line.split() for line in lines if not line.startswith(("#", "TAIL", "FLIGHT", "START", "ZFW"))][1:]
        first = next(place for place, row in enumerate(rows) if row[0] == "TIME")
        texts.append((rows, first + 2, rows[first].index("GSPD"), rows[first].index("LAT")))
    first_start = datetime.datetime(2019, 1, 1, 6)
    for number in range(reports):
        tail, flight = number % tails, number // tails
        start = first_start + datetime.timedelta(hours=6 * flight, minutes=tail % 60)
        # No two flights of a tail with one fixture's samples weigh the same, or the later would be known for the earlier.
        zero_fuel_lb = 52000 + (tail * 7919 + flight * 37) % 2000
        head = (
            f"CRUISE-REPORT 1\nTAIL B-{tail:04}\nFLIGHT {flight:05}\n"
            f"START {start:%Y-%m-%dT%H:%M:%S}Z\nZFW {zero_fuel_lb} lb\n"
        )
        rows, samples, speed, latitude = texts[(tail + flight) % len(texts)]
        of_round = flight // len(texts)
        lines = [" ".join(row) for row in rows[:samples]]
        for row in rows[samples : None if longest is None else samples + longest]:
            row = list(row)
            row[speed] = f"{float(row[speed]) + 0.1 * (of_round % 97):.1f}"
            row[latitude] = f"{float(row[latitude]) - 0.001 * tail - 0.5 * (of_round // 97):.3f}"
            lines.append(" ".join(row))
        path = folder / f"B-{tail:04}" / f"{flight:05}.txt"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(head + "\n".join(lines) + "\n")


def counted(command):
    """The command under `perf stat` where that counts instructions, and the file of the count."""
    counts = tempfile.NamedTemporaryFile("r", suffix=".perf")
    prefix = ["perf", "stat", "-x", ",", "-o", counts.name, "-e", "instructions:u"]
    if shutil.which("perf") is None or subprocess.run(prefix + ["true"], check=False).returncode != 0:
        prefix = []
    return prefix + command, counts


def timed(test, cores, runs):
    """Best processor and wall seconds, fewest instructions (0 where they are not counted), last line of the output."""
    best_cpu, best_wall, fewest, last = float("inf"), float("inf"), 0, ""
    for run in range(runs):
        if "before" in test:
            test["before"]()
        command, counts = counted(test["run"](run))
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        begun = time.monotonic()
        done = subprocess.run(
            ["/usr/bin/env", "taskset", "-c", ",".join(map(str, range(cores)))] + command,
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False,
        )
        wall = time.monotonic() - begun
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode not in (0, 1):
            return None
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        best_cpu, best_wall = min(best_cpu, cpu), min(best_wall, wall)
        found = re.search(r"^(\d+),.*instructions", counts.read(), re.MULTILINE)
        fewest = min(fewest or int(found[1]), int(found[1])) if found else 0
        last = done.stdout.strip().splitlines()[-1] if done.stdout.strip() else ""
    return best_cpu, best_wall, fewest, last


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
    outputs = tempfile.TemporaryDirectory(dir=asked.folder, prefix="out-")
    output = lambda run: f"{outputs.name}/{run}"
    adapt = lambda run: [
        program, "adapt", str(reports), "--model", model, "-o", output(run), "--law", asked.law, "--threads", str(asked.cores)
    ]
    segment = lambda run: [
        program, "segment", str(reports), "-o", f"{output(run)}.csv", "--threads", str(asked.cores)
    ]
    tests = {
        "plain reader": {"run": lambda run: reader, "before": warm},
        f"adapt, law {asked.law}": {"run": adapt, "before": warm},
        "adapt again, nothing new": {"run": adapt, "before": warm},
        "segment": {"run": segment, "before": warm},
    }
    if asked.python:
        for peer in asked.peers.split(","):
            command = [asked.python, str(ROOT / "benches/peers.py"), str(reports), peer, "1"]
            tests[peer] = {"run": lambda run, command=command: command, "before": warm}
    base = None
    print(f"{asked.reports} reports of {asked.tails} tails, {asked.cores} cores, load {os.getloadavg()[0]:.1f}")
    for name, test in tests.items():
        figures = timed(test, asked.cores, asked.runs)
        if figures is None:
            print(f"{name:28} failed")
            continue
        cpu, wall, instructions, last = figures
        base = base or cpu
        inside = re.search(r'"best_s": ([0-9.]+)', last) or re.search(r'"seconds": ([0-9.]+)', last)
        note = f"  (of it {inside[1]} s without start-up)" if inside else ""
        count = f"  {instructions / 1e9:6.2f} G instructions" if instructions else ""
        print(f"{name:28} cpu {cpu:8.2f} s  wall {wall:8.2f} s  {cpu / base:6.1f} x{count}{note}")
    outputs.cleanup()
    print(f"largest memory of a test: {resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024:.0f} MB")


if __name__ == "__main__":
    main()
