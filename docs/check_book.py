#!/usr/bin/env python3
"""Checks the built book, and the Markdown files that link into it.

    python3 docs/check_book.py docs/book

- Every link and image of the built pages that stays inside the book leads to a file, and to an anchor of it.
- No page shows the source of an equation, or loads anything from a network.
- Every Markdown file below docs/src is in SUMMARY.md.
- Links between files of README.md, CONTRIBUTING.md, ARCHITECTURE.md and crates/README.md lead to files and headings.
- Every equation id that a page or the source code cites, such as `[diagnosis.22]`, is on its page.

Prints what is wrong and ends with status 1. Standard library only.
"""

import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

ROOT = Path(__file__).resolve().parent.parent
SOURCE = ROOT / "docs/src"
LOOSE = ["README.md", "CONTRIBUTING.md", "ARCHITECTURE.md", "CHANGELOG.md", "crates/README.md"]
PAGES_OF_EQUATIONS = {page.stem: page for page in sorted((SOURCE / "theory").glob("*.md"))}
PAGES_OF_EQUATIONS |= {
    "virtual": SOURCE / "theory/virtual_aircraft.md",
    "flow": SOURCE / "theory/geostrophic_flow.md",
    "applying": SOURCE / "guides/applying.md",
    "monitoring": SOURCE / "guides/monitoring.md",
}


class Page(HTMLParser):
    """Ids, links and visible text of one built page."""

    def __init__(self, text):
        super().__init__()
        self.ids, self.links, self.loads, self.words = set(), [], [], []
        self.hidden = 0
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        found = dict(attributes)
        if "id" in found:
            self.ids.add(found["id"])
        if tag == "a" and found.get("href"):
            self.links.append(found["href"])
        if found.get("src"):
            self.loads.append(found["src"])
        if tag == "link" and found.get("href"):
            self.loads.append(found["href"])
        self.hidden += tag in ("annotation", "code", "script", "style")

    def handle_endtag(self, tag):
        self.hidden -= tag in ("annotation", "code", "script", "style")

    def handle_data(self, data):
        if not self.hidden:
            self.words.append(data)


def external(link):
    return re.match(r"[a-z]+:|//", link)


def built_pages(book):
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in sorted(book.rglob("*.html"))}
    pages = {path: page for path, page in pages.items() if path.name not in ("print.html", "toc.html", "404.html")}
    for path, page in pages.items():
        name = path.relative_to(book)
        for link in page.links + page.loads:
            if external(link):
                if link in page.loads and not link.startswith("data:"):
                    yield f"{name}: loads {link} from a network"
                continue
            file, _, anchor = unquote(link).partition("#")
            target = (path.parent / file).resolve() if file else path
            if not target.exists():
                yield f"{name}: {link}: no such file"
            elif anchor and target in pages and anchor not in pages[target].ids:
                yield f"{name}: {link}: no such heading"
        if re.search(r"\$\$|\\(frac|sqrt|sum|left)\b", "".join(page.words)):
            yield f"{name}: shows the source of an equation"


def without_code(text):
    return re.sub(r"```.*?```|`[^`\n]*`", "", text, flags=re.S)


def headings(text):
    """Anchors as GitHub and mdBook make them."""
    found = set()
    for title in re.findall(r"^#+ (.*)$", re.sub(r"```.*?```", "", text, flags=re.S), flags=re.M):
        plain = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", title).replace("`", "")
        found.add(re.sub(r"[^\w\- ]", "", plain.lower()).strip().replace(" ", "-"))
    return found


def loose_files():
    for name in LOOSE:
        path = ROOT / name
        for link in re.findall(r"\]\(([^)\s]+)\)", without_code(path.read_text(encoding="utf-8"))):
            if external(link):
                continue
            file, _, anchor = link.partition("#")
            target = (path.parent / file).resolve() if file else path
            if not target.exists():
                yield f"{name}: {link}: no such file"
            elif anchor and target.suffix == ".md" and anchor not in headings(target.read_text(encoding="utf-8")):
                yield f"{name}: {link}: no such heading"


def summary():
    listed = set(re.findall(r"\]\(([^)]+\.md)\)", (SOURCE / "SUMMARY.md").read_text(encoding="utf-8")))
    for page in sorted(SOURCE.rglob("*.md")):
        name = str(page.relative_to(SOURCE))
        if name != "SUMMARY.md" and name not in listed:
            yield f"docs/src/{name}: not in SUMMARY.md"


def equations():
    defined = {}
    for name, page in PAGES_OF_EQUATIONS.items():
        text = page.read_text(encoding="utf-8")
        defined[name] = set(re.findall(rf"\[{name}\.(\d+)\]", text))
    sources = sorted((ROOT / "crates").rglob("*.rs")) + sorted(SOURCE.rglob("*.md"))
    for path in sources:
        for name, number in re.findall(r"\[([a-z]+)\.(\d+)\]`", path.read_text(encoding="utf-8")):
            if name in defined and number not in defined[name]:
                yield f"{path.relative_to(ROOT)}: cites [{name}.{number}], which no page has"


def main():
    book = Path(sys.argv[1]).resolve()
    wrong = [*built_pages(book), *summary(), *loose_files(), *equations()]
    print("\n".join(wrong) or "the book's links, anchors, equations and pages are in order")
    sys.exit(bool(wrong))


main()
