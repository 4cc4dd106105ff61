#!/usr/bin/env bash
# Builds the book to docs/book and checks it: no warning, every internal link and anchor, every page in SUMMARY.md.
#
#     docs/build.sh            # then look at docs/book/index.html: it loads nothing from a network
#
# What is missing is installed to target/book-tools, in the versions below. Needs cargo, python3, and node with npm for the
# equations; a network at the first run only.
set -euo pipefail
cd "$(dirname "$0")/.."

MDBOOK=0.5.3
KATEX_VERSION=0.16.4

tools="${BOOK_TOOLS:-$PWD/target/book-tools}"
export PATH="$tools/bin:$PATH"

# Unoptimised: built in half the time, and they read one book.
[ "$(mdbook --version 2>/dev/null)" = "mdbook v$MDBOOK" ] ||
  cargo install mdbook --version "$MDBOOK" --locked --debug --no-default-features --features search --root "$tools"
export KATEX="$tools/katex-$KATEX_VERSION/dist/katex.min.js"
if ! [ -f "$KATEX" ]; then
  (cd "$tools" && npm pack --silent "katex@$KATEX_VERSION" >/dev/null)
  mkdir -p "$tools/katex-$KATEX_VERSION"
  tar -xzf "$tools/katex-$KATEX_VERSION.tgz" -C "$tools/katex-$KATEX_VERSION" --strip-components 1
fi
grep -qs "KaTeX $KATEX_VERSION" docs/katex.css ||
  python3 docs/katex_css.py "$tools/katex-$KATEX_VERSION.tgz" docs/katex.css

log=$(mktemp)
trap 'rm -f "$log"' EXIT
mdbook build docs 2>&1 | tee "$log"
if grep -Eq 'WARN|ERROR' "$log"; then
  echo "the book was built with warnings" >&2
  exit 1
fi
python3 docs/check_book.py docs/book
