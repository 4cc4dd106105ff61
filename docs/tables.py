#!/usr/bin/env python3
"""Takes tables out of a Markdown file and writes them as CSV.

    python3 docs/tables.py FILE.md DIR NAME=HEADER|NUMBER …

Writes DIR/NAME.csv from all tables whose first column is headed HEADER, or from table NUMBER, counted from 1; where a file has
several of a header, a first column `part` holds the heading above each. For the full tables of docs/src/validation/tables, from what `cruisefit trial` and the scripts in
docs/figures print. Standard library only.
"""

import csv
import re
import sys
from pathlib import Path


def tables(text):
    """Heading and rows of every table."""
    heading, rows = "", []
    for line in [*text.splitlines(), ""]:
        if line.startswith("|"):
            cells = [cell.strip().replace("`", "").replace("**", "") for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
            if not all(re.fullmatch(r":?-+:?", cell) for cell in cells):
                rows.append(cells)
        elif rows:
            yield heading, rows
            rows = []
        if line.startswith("#"):
            heading = line.strip("# ")


def main():
    source, folder, *wanted = sys.argv[1:]
    found = list(tables(Path(source).read_text(encoding="utf-8")))
    for want in wanted:
        name, header = want.split("=")
        numbered = found[int(header) - 1 : int(header)] if header.isdigit() else []
        of_it = numbered or [table for table in found if table[1][0][0] == header]
        if not of_it:
            sys.exit(f"{source}: no table whose first column is headed {header!r}")
        with open(Path(folder) / f"{name}.csv", "w", newline="", encoding="utf-8") as output:
            writer = csv.writer(output, lineterminator="\n")
            if len(of_it) == 1:
                writer.writerows(of_it[0][1])
            else:
                writer.writerow(["part", *of_it[0][1][0]])
                writer.writerows([heading, *row] for heading, rows in of_it for row in rows[1:])


main()
