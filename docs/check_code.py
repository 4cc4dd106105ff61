#!/usr/bin/env python3
"""Compiles and runs the Rust of README.md and of the book.

    python3 docs/check_code.py

Every fenced block marked `rust` becomes a program that depends on the crates of this workspace; a block without `fn main` is
put into one. Where the page goes on with "It prints `…`", that is what the program must print. A block marked `rust,ignore` is
left out. Builds in target/book-code with the workspace's Cargo.lock. Standard library only.
"""

import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BLOCK = re.compile(r"^```rust\n(.*?)^```\n\s*(?:It prints `([^`]*)`)?", re.M | re.S)


def pages():
    return [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "ARCHITECTURE.md", *sorted((ROOT / "docs/src").rglob("*.md"))]


def main():
    work = ROOT / "target/book-code"
    shutil.rmtree(work, ignore_errors=True)
    (work / "src/bin").mkdir(parents=True)
    workspace = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))["workspace"]
    crates = {name: value for name, value in workspace["dependencies"].items() if isinstance(value, dict) and "path" in value}

    programs, used = {}, set()
    for page in pages():
        for code, printed in BLOCK.findall(page.read_text(encoding="utf-8")):
            name = f"{page.stem.lower().replace('.', '_')}_{len(programs) + 1}"
            if "fn main" not in code:
                code = f"fn main() -> Result<(), Box<dyn std::error::Error>> {{\n{code}\nOk(())\n}}\n"
            (work / f"src/bin/{name}.rs").write_text(code, encoding="utf-8")
            programs[name] = (page.relative_to(ROOT), printed)
            used |= {crate for crate in crates if re.search(rf"\b{crate.replace('-', '_')}::", code)}
    if not programs:
        sys.exit("no Rust found: is the mark of the blocks another one?")

    version = workspace.get("package", {}).get("edition", "2024")
    manifest = [f'[package]\nname = "book-code"\nversion = "0.0.0"\nedition = "{version}"\npublish = false\n', "[workspace]\n", "[dependencies]"]
    for name in sorted(used):
        package = crates[name].get("package", name)
        manifest.append(f'{name} = {{ package = "{package}", path = "{ROOT / crates[name]["path"]}" }}')
    (work / "Cargo.toml").write_text("\n".join(manifest) + "\n", encoding="utf-8")
    shutil.copy(ROOT / "Cargo.lock", work / "Cargo.lock")

    environment = os.environ | {"CARGO_TARGET_DIR": os.environ.get("CARGO_TARGET_DIR", str(ROOT / "target"))}
    subprocess.run(["cargo", "build", "--quiet", "--bins", "--offline"], cwd=work, env=environment, check=True)
    wrong = 0
    for name, (page, printed) in programs.items():
        binary = Path(environment["CARGO_TARGET_DIR"]) / "debug" / name
        done = subprocess.run([binary], capture_output=True, text=True)
        if done.returncode != 0:
            wrong += 1
            print(f"{page}: the program fails:\n{done.stderr}")
        elif printed and done.stdout.strip() != printed:
            wrong += 1
            print(f"{page}: prints `{done.stdout.strip()}`, the page says `{printed}`")
        else:
            print(f"ok {page}")
    sys.exit(bool(wrong))


main()
