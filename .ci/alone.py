#!/usr/bin/env python3
"""Every crate by itself: none lives on a feature that another crate asks of a common dependency.

A crate's code can depend on the features of its direct dependencies only. Where they are the same for the crate alone and for
the whole workspace, the workspace's build has compiled the crate as it is alone. Where the workspace has more of them, the
crate is checked alone.
"""

import json
import re
import subprocess
import sys

CARGO = ["cargo"]


def output(*arguments: str) -> str:
    return subprocess.run([*CARGO, *arguments], check=True, stdout=subprocess.PIPE, text=True).stdout


def features(edges: str, *selection: str) -> dict[str, set[str]]:
    """Features of each package, as resolved for this selection of packages."""
    found: dict[str, set[str]] = {}
    lines = output("tree", "--locked", "--edges", edges, "--prefix", "none", "--format", "{p}|{f}", *selection)
    for line in lines.splitlines():
        package, _, names = line.removesuffix(" (*)").partition("|")
        # Without its path: the same package in both.
        package = re.sub(r" \(.*", "", package)
        found.setdefault(package, set()).update(filter(None, names.split(",")))
    return found


def main() -> int:
    packages = json.loads(output("metadata", "--locked", "--no-deps", "--format-version", "1"))["packages"]
    together = features("all", "--workspace")
    for package in packages:
        name = package["name"]
        alone = features("normal,build", "--package", name, "--depth", "1")
        missing = {
            dependency: sorted(together[dependency] - names)
            for dependency, names in alone.items()
            if together[dependency] - names
        }
        if not missing:
            print(f"ok {name}: the features of the workspace's build")
            continue
        words = "; ".join(f"{dependency} without {', '.join(names)}" for dependency, names in missing.items())
        print(f"checking {name} alone: {words}", flush=True)
        checked = subprocess.run([*CARGO, "check", "--quiet", "--locked", "--package", name])
        if checked.returncode:
            print(f"failed: {name} does not build by itself", file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
