#!/usr/bin/env python3
"""`cruisefit.segment` on a recording of ten million rows in memory next to the command line on the same rows, in pairs.

    python benches/recording.py make FOLDER
    python crates/python/benches/segment.py FOLDER [--pairs 3] [--program target/release/cruisefit]

The command line reads `recording.csv` and writes its segments; Python has `recording.parquet` as a table in memory (pyarrow)
and finds the same segments, which is tested to the bit; what reading the Parquet file costs is printed apart. Ratios are those
of the best runs: the command line's time over Python's, above 1 where Python is faster.
"""

import argparse
import os
import resource
import subprocess
import sys
import time
from pathlib import Path

import pyarrow.parquet as pq

import cruisefit

ROOT = Path(__file__).resolve().parents[3]


def timed(work, cpu_s):
    before, begun = cpu_s(), time.perf_counter()
    result = work()
    return time.perf_counter() - begun, cpu_s() - before, result


def of_children_s():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("--pairs", type=int, default=3)
    parser.add_argument("--program", type=Path, default=ROOT / "target" / "release" / "cruisefit")
    asked = parser.parse_args()
    mapping, out = asked.folder / "recording.ron", asked.folder / "segments.csv"
    command = [asked.program, "segment", "--mapping", mapping, asked.folder / "recording.csv", "-o", out, "--no-progress"]
    reading = timed(lambda: pq.read_table(asked.folder / "recording.parquet"), time.process_time)
    table = reading[2]
    theirs, ours = [], []
    for _ in range(asked.pairs):
        run = lambda: subprocess.run(command, check=True, stdout=subprocess.DEVNULL)  # noqa: E731
        theirs.append(timed(run, of_children_s)[:2])
        wall_s, cpu_s, segments = timed(
            lambda: cruisefit.segment(table, mapping=mapping, name="recording.csv"), time.process_time
        )
        ours.append((wall_s, cpu_s))
        if segments.to_csv() != out.read_bytes():
            sys.exit("other segments than the command line's")
        print(f"command line {theirs[-1][0]:6.2f} s wall {theirs[-1][1]:6.2f} s processor   "
              f"Python {wall_s:6.2f} s wall {cpu_s:6.2f} s processor", flush=True)
    ratio = [min(one[k] for one in theirs) / min(one[k] for one in ours) for k in range(2)]
    print(f"{table.num_rows} rows, {len(segments)} segments, equal to the bit, {os.cpu_count()} cores: "
          f"ratio {ratio[0]:.2f} by wall clock, {ratio[1]:.2f} by processor time; "
          f"reading the Parquet file {reading[0]:.2f} s wall {reading[1]:.2f} s processor")


if __name__ == "__main__":
    main()
