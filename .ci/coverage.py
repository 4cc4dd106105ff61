#!/usr/bin/env python3
"""Lines that tests reach, crate by crate, from `cargo llvm-cov --json --summary-only`; fails below the least."""

import json
import re
import sys

# The command line's remainder is messages of the operating system's failures, which a test cannot cause everywhere.
LEAST = {"cli": 85.0}
LEAST_OF_STAGES = 92.0
STAGES = ["units", "lut", "atmos", "flight", "report", "track", "segmenter", "perf-model", "effects", "adapt", "refit",
          "monitor", "diagnose"]


def main() -> int:
    files = json.load(open(sys.argv[1]))["data"][0]["files"]
    sums: dict[str, list[int]] = {}
    for file in files:
        found = re.search(r"/crates/([^/]+)/src/", file["filename"])
        if found:
            lines = file["summary"]["lines"]
            entry = sums.setdefault(found[1], [0, 0])
            entry[0] += lines["covered"]
            entry[1] += lines["count"]
    low = 0
    for name, (covered, count) in sorted(sums.items()):
        share = 100.0 * covered / count
        least = LEAST.get(name, LEAST_OF_STAGES if name in STAGES else 0.0)
        low += share < least
        print(f"{name:12} {share:5.1f} % of {count} lines" + (f", least {least:.0f} %" if least else "")
              + (" MISSED" if share < least else ""))
    return 1 if low else 0


if __name__ == "__main__":
    sys.exit(main())
