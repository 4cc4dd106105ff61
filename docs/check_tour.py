#!/usr/bin/env python3
"""Runs the commands of the tour and holds what the page shows to what the program prints.

    python3 docs/check_tour.py target/release/cruisefit

Every `$ cruisefit …` of a `console` block runs, in the page's order, in a folder of its own with the repository's fixtures. Each
line that the page shows below it must be among the lines printed, in that order; `…` matches anything. Standard library only.
"""

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/src/tour.md"


def commands(text):
    """Each command with the lines shown below it."""
    for block in re.findall(r"^```console\n(.*?)^```", text, flags=re.M | re.S):
        for part in re.split(r"^\$ ", block, flags=re.M)[1:]:
            command, *shown = part.rstrip("\n").split("\n")
            yield command, [line for line in shown if line.strip() != "…"]


def pattern(line):
    return re.compile(".*".join(map(re.escape, line.split("…"))))


def missing(shown, printed):
    """The first shown line that is not printed after those before it."""
    rest = iter(printed)
    for line in shown:
        if not any(pattern(line).fullmatch(candidate) for candidate in rest):
            return line
    return None


def main():
    binary = Path(sys.argv[1]).resolve()
    wrong = ran = 0
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(ROOT / "fixtures", Path(folder) / "fixtures")
        os.symlink(binary, Path(folder) / "cruisefit")
        environment = os.environ | {"PATH": f"{folder}:{os.environ['PATH']}", "NO_COLOR": "1", "COLUMNS": "400"}
        for command, shown in commands(PAGE.read_text(encoding="utf-8")):
            done = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, capture_output=True, text=True)
            printed = (done.stdout + done.stderr).splitlines()
            ran += 1
            line = missing(shown, printed)
            if done.returncode != 0 or line is not None:
                wrong += 1
                print(f"$ {command}\n  status {done.returncode}; not printed: {line}\n  " + "\n  ".join(printed))
    print(f"{ran} commands of the tour, {wrong} of them print something else than the page shows")
    sys.exit(bool(wrong))


main()
