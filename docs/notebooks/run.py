#!/usr/bin/env python3
"""Runs every notebook of this folder and fails where one does. What they show is not stored in the repository.

    python docs/notebooks/run.py [--output DIR]

Needs nbclient, ipykernel and what the notebooks import. Without Java those that import pyspark are skipped, and it says so.
"""

import argparse
import shutil
import sys
import time
from pathlib import Path

import nbformat
from nbclient import NotebookClient

HERE = Path(__file__).resolve().parent


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", type=Path, help="folder for the notebooks as run")
    output = parser.parse_args().output
    notebooks = sorted(HERE.glob("*.ipynb"))
    if not notebooks:
        sys.exit("no notebook found")
    for path in notebooks:
        notebook = nbformat.read(path, as_version=4)
        nbformat.validate(notebook)
        code = "".join(cell.source for cell in notebook.cells)
        if "pyspark" in code and shutil.which("java") is None:
            print(f"skipped: {path.name} (no Java)")
            continue
        begun = time.monotonic()
        NotebookClient(notebook, timeout=600, resources={"metadata": {"path": str(HERE)}}).execute()
        print(f"ok {path.name} ({time.monotonic() - begun:.0f} s)")
        if output:
            output.mkdir(parents=True, exist_ok=True)
            nbformat.write(notebook, output / path.name)


if __name__ == "__main__":
    main()
