#!/usr/bin/env python3
"""Holds README.md to the program: what `cruisefit demo` prints is the text between the `demo-output` marks.

    python3 docs/check_demo.py target/release/cruisefit

Prints the difference and ends with status 1. To put the program's words into README.md, add `--write`. Standard library only.
"""

import difflib
import subprocess
import sys
import tempfile
from pathlib import Path

README = Path(__file__).resolve().parent.parent / "README.md"
BEGIN, END = "<!-- demo-output -->\n```text\n", "```\n<!-- /demo-output -->\n"


def main():
    binary = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([binary, "demo", "--no-progress"], cwd=folder, check=True, capture_output=True, text=True)
    before, rest = README.read_text(encoding="utf-8").split(BEGIN)
    shown, after = rest.split(END)
    if done.stdout == shown:
        print("README.md shows what `cruisefit demo` prints")
        return
    if "--write" in sys.argv:
        README.write_text(before + BEGIN + done.stdout + END + after, encoding="utf-8")
        print("README.md: demo output written")
        return
    difference = difflib.unified_diff(shown.splitlines(), done.stdout.splitlines(), "README.md", "cruisefit demo", lineterm="")
    print("\n".join(difference))
    sys.exit(1)


main()
