#!/usr/bin/env python3
"""The public interface of the library crates, held to .ci/api/CRATE.txt: no change of it goes unseen.

    .ci/api.py            compares; 1 and the difference if an interface has changed
    .ci/api.py --write    makes the interface as it is the one that is held

Read from the formatted source. That is enough because the lint `unreachable_pub` lets nothing be `pub` that cannot be reached from
outside: signatures, fields, variants, traits, implementations of traits for public types, and as they are written the calls of
macros that make such items. Values of constants and bodies are no part of it.
"""

import difflib
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
HELD = ROOT / ".ci/api"
# No library of ours: the program, the Python package, the tests' own.
NO_LIBRARY = {"cli", "python", "test-support"}
KEPT_ATTRIBUTES = re.compile(r"#\[(derive\(.*\)|non_exhaustive|repr\(.*\)|deprecated.*)\]")
ITEM = re.compile(r"pub (?:const |async )*(fn|struct|enum|trait|type|const|static|use|mod)\b")
BODY_KEPT = {"struct", "enum", "trait"}


def code_lines(path: pathlib.Path) -> list[str]:
    """Lines without comments, up to the tests, attributes of several lines in one."""
    lines: list[str] = []
    for line in path.read_text().splitlines():
        if line == "#[cfg(test)]":
            lines.append(line)
            continue
        line = re.sub(r"\s*//.*$", "", line) if '"' not in line else line
        if not line.strip() or line.lstrip().startswith("//"):
            continue
        if lines and lines[-1].lstrip().startswith("#[") and not lines[-1].endswith("]"):
            lines[-1] += " " + line.strip()
        else:
            lines.append(line)
    return lines


def block(lines: list[str], first: int) -> list[str]:
    """From a line to the one that closes what it opens: rustfmt sets it under the first one's beginning."""
    indent = re.match(r" *", lines[first])[0]
    for last in range(first, len(lines)):
        text = lines[last]
        at_indent = text.startswith(indent) and not text.startswith(indent + " ")
        if at_indent and (last > first or text.count("{") == text.count("}")) and text.rstrip().endswith(("}", ";", ")")):
            return lines[first : last + 1]
    return lines[first:]


def head(lines: list[str], first: int) -> list[str]:
    """From a line to the one that ends what is said before a body."""
    last = first
    while not lines[last].endswith(("{", ";", "{}")):
        last += 1
    return lines[first : last + 1]


def joined(lines: list[str]) -> str:
    text = " ".join(line.strip() for line in lines)
    return re.sub(r",? ?([)>\]])", r"\1", re.sub(r"([(<\[]) ", r"\1", text))


def signature(kind: str, lines: list[str]) -> str:
    """What callers can see of an item."""
    if kind not in BODY_KEPT:
        cut = [" = "] if kind in ("const", "static") else [" {"] if kind == "fn" else []
        text = joined(lines)
        for mark in cut:
            text = text.split(mark)[0]
        return text.rstrip(";{ ")
    if len(lines) == 1:
        return lines[0].strip()
    seen = [lines[0].strip()]
    for line in lines[1:]:
        words = line.strip()
        if kind == "struct" and not (words.startswith("pub ") or words in ("}", ");")):
            if seen[-1] != "…":
                seen.append("…")
        elif not words.startswith("#["):
            seen.append(words)
    return joined(seen)


def items(path: pathlib.Path, public: set[str], makers: set[str]) -> list[str]:
    lines, found, owner, attributes = code_lines(path), [], "", []
    place = 0
    while place < len(lines):
        line = lines[place].strip()
        if lines[place] == "#[cfg(test)]":
            place += 1 + len(block(lines, place + 1))
            continue
        if line.startswith("#["):
            attributes += [line] if KEPT_ATTRIBUTES.fullmatch(line) else []
            place += 1
            continue
        item, implementation = ITEM.match(line), re.match(r"impl\b", lines[place])
        if item:
            whole = (block if item[1] in BODY_KEPT else head)(lines, place)
            found.append(" ".join([*attributes, owner + signature(item[1], whole)]))
            place += len(whole)
        elif implementation:
            whole = head(lines, place)
            text = joined(whole).rstrip("{} ")
            name = re.search(r"(?:for|^impl(?:<.*?>)?) (?:&|mut |'\w+ )*(?:\w+::)*(\w+)[^ ]*(?: where.*)?$", text)
            of_trait = " for " in text
            if of_trait and (name is None or name[1] in public):
                found.append(text)
            owner = "" if of_trait else text.removeprefix("impl").strip() + "::"
            place += len(whole)
        elif (call := re.match(r"([a-z_]+)! ?[({]", lines[place])) and call[1] in makers:
            whole = block(lines, place)
            found.append(joined(whole))
            place += len(whole)
        else:
            if lines[place] == "}":
                owner = ""
            place += 1
        attributes = []
    return found


def interface(crate: pathlib.Path) -> str:
    source = crate / "src"
    paths = [p for p in sorted(source.rglob("*.rs")) if p.stem != "tests" and "tests" not in p.parts]
    text = "\n".join(p.read_text() for p in paths)
    public = set(re.findall(r"\bpub (?:struct|enum|trait) (\w+)", text))
    # A definition ends with a brace at the beginning of a line.
    macros = re.findall(r"^macro_rules! (\w+) \{(.*?)^\}", text, re.M | re.S)
    makers = {name for name, body in macros if re.search(r"^\s*(pub (const fn|fn|struct|enum|const|static|type) |impl )", body, re.M)}
    parts = []
    for path in paths:
        if found := items(path, public, makers):
            parts.append(f"# {path.relative_to(source)}\n" + "\n".join(found) + "\n")
    return "\n".join(parts)


def main() -> int:
    crates = [p.parent for p in sorted(ROOT.glob("crates/*/Cargo.toml")) if p.parent.name not in NO_LIBRARY]
    now = {crate.name: interface(crate) for crate in crates}
    if sys.argv[1:] == ["--write"]:
        HELD.mkdir(exist_ok=True)
        for old in HELD.glob("*.txt"):
            old.unlink()
        for name, text in now.items():
            (HELD / f"{name}.txt").write_text(text)
    held = {path.stem: path.read_text() for path in HELD.glob("*.txt")}
    changed = [name for name in sorted(held.keys() | now.keys()) if held.get(name) != now.get(name)]
    for name in changed:
        before, after = (texts.get(name, "").splitlines() for texts in (held, now))
        print("\n".join(difflib.unified_diff(before, after, f"held/{name}", f"now/{name}", lineterm="", n=0)))
    count = sum(1 for text in now.values() for line in text.splitlines() if line and not line.startswith("# "))
    if changed:
        print(f"the public interface of {', '.join(changed)} has changed. Where that is meant: .ci/api.py --write", file=sys.stderr)
        return 1
    print(f"{count} public items of {len(now)} crates, as they were")
    return 0


if __name__ == "__main__":
    sys.exit(main())
