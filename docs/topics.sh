#!/usr/bin/env bash
# The page of topics, from the program's own text: docs/topics.sh target/debug/cruisefit
set -euo pipefail
program=$(realpath "${1:?usage: docs/topics.sh PROGRAM}")
cd "$(dirname "$0")"
"$program" explain --book >src/guides/topics.md
