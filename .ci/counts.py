#!/usr/bin/env python3
"""Instructions of the hot kernels (crates/pipeline/examples/counts.rs), held to within 5 % of .ci/counts.json.

    .ci/counts.py            compares; 1 if a kernel differs by more
    .ci/counts.py --write    makes what is counted now the baseline

Counted by Valgrind in the build that the tests use, which every check has made already: kernels at opt-level 3, with the checks
of a debug build, one thread. Unlike times, counts are the same at every run. Another compiler makes other instructions, and a processor
without AVX2 takes other paths: what is then not compared is said.
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BASELINE = ROOT / ".ci/counts.json"
ALLOWED = 0.05


def built() -> str:
    """The program, built as `.ci/run` builds it: incremental builds are cut into other pieces and give other instructions."""
    command = ["cargo", "build", "--workspace", "--example", "counts", "--locked", "--message-format", "json"]
    environment = {**os.environ, "CARGO_INCREMENTAL": "0"}
    lines = subprocess.run(command, cwd=ROOT, env=environment, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()
    messages = [json.loads(line) for line in lines]
    return next(m["executable"] for m in messages if m.get("target", {}).get("name") == "counts" and m.get("executable"))


def counted(program: str, kernel: str) -> int:
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", "--toggle-collect=*counts::counted*", program, kernel]
    run = subprocess.run(command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    found = re.search(r"Collected : (\d+)", run.stderr)
    if run.returncode or not found or int(found[1]) == 0:
        sys.exit(f"{kernel}: not counted\n{run.stderr}")
    return int(found[1])


def machine() -> str:
    compiler = subprocess.run(["rustc", "--version"], check=True, stdout=subprocess.PIPE, text=True).stdout.strip()
    cpu = pathlib.Path("/proc/cpuinfo")
    avx2 = cpu.exists() and " avx2 " in cpu.read_text()
    return f"{compiler}, {'with' if avx2 else 'without'} AVX2"


def main() -> int:
    if shutil.which("valgrind") is None:
        sys.exit("valgrind is not installed")
    program = built()
    kernels = subprocess.run([program], check=True, stdout=subprocess.PIPE, text=True).stdout.split()
    counts = {kernel: counted(program, kernel) for kernel in kernels}
    here = machine()
    if sys.argv[1:] == ["--write"]:
        BASELINE.write_text(json.dumps({"machine": here, "counts": counts}, indent=2) + "\n")
    baseline = json.loads(BASELINE.read_text())
    comparable = baseline["machine"] == here
    if not comparable:
        print(f"not compared: the baseline is of {baseline['machine']}, this is {here}")
    off = set(baseline["counts"]) ^ set(counts)
    for kernel, count in counts.items():
        before = baseline["counts"].get(kernel)
        change = count / before - 1.0 if before else float("nan")
        if abs(change) > ALLOWED:
            off.add(kernel)
        print(f"{kernel:20} {count:13,} instructions, {100 * change:+6.2f} %" + (" OFF" if kernel in off else ""))
    if off and comparable:
        print(f"off by more than {100 * ALLOWED:.0f} %, or not in both: {', '.join(sorted(off))}. Where that is meant: .ci/counts.py --write",
              file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
