#!/usr/bin/env bash
# Builds the book to docs/book and checks it: no warning, every internal link and anchor, every page in SUMMARY.md.
#
#     docs/build.sh            # then look at docs/book/index.html: it loads nothing from a network
#
# What is missing is installed to target/book-tools, in the versions below, which belong together (mdbook-katex brings
# KaTeX 0.16.4). Needs cargo, python3, and npm for the fonts of the equations; a network at the first run only.
set -euo pipefail
cd "$(dirname "$0")/.."

MDBOOK=0.5.3
MDBOOK_KATEX=0.10.0
KATEX=0.16.4

tools="${BOOK_TOOLS:-$PWD/target/book-tools}"
export PATH="$tools/bin:$PATH"

# Unoptimised: built in half the time, and they read one book.
[ "$(mdbook --version 2>/dev/null)" = "mdbook v$MDBOOK" ] ||
  cargo install mdbook --version "$MDBOOK" --locked --debug --no-default-features --features search --root "$tools"
[ "$(mdbook-katex --version 2>/dev/null)" = "mdbook-katex $MDBOOK_KATEX" ] ||
  cargo install mdbook-katex --version "$MDBOOK_KATEX" --locked --debug --root "$tools"
if ! grep -qs "KaTeX $KATEX" docs/katex.css; then
  mkdir -p "$tools"
  (cd "$tools" && npm pack --silent "katex@$KATEX" >/dev/null)
  python3 docs/katex_css.py "$tools/katex-$KATEX.tgz" docs/katex.css
fi

log=$(mktemp)
trap 'rm -f "$log"' EXIT
mdbook build docs 2>&1 | tee "$log"
if grep -Eq 'WARN|ERROR' "$log"; then
  echo "the book was built with warnings" >&2
  exit 1
fi
python3 docs/check_book.py docs/book
