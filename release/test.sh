#!/usr/bin/env bash
# Tests of the release scripts that need no other toolchain: archives have the same bytes twice, and a machine that lacks a
# toolchain is told so, before anything is built. A second or two.
set -euo pipefail
cd "$(dirname "$0")/.."
fail() { printf 'release/test.sh: %s\n' "$*" >&2; exit 1; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# Same bytes, whatever the times and modes of the files.
export SOURCE_DATE_EPOCH=1700000000
for round in one two; do
  mkdir -p "$scratch/$round"
  printf 'binary' >"$scratch/$round/cruisefit"
  cp README.md LICENSE-MIT "$scratch/$round/"
done
chmod 700 "$scratch/one/cruisefit"
touch -d 2001-01-01 "$scratch/one/README.md"
for ending in tar.gz zip; do
  for round in one two; do
    mkdir -p "$scratch/$round/out"
    (umask 0$((RANDOM % 2))77; python3 release/archive.py "$scratch/$round/out/cruisefit-0.tar.gz" \
      "$scratch/$round"/{README.md,cruisefit,LICENSE-MIT})
    python3 release/archive.py "$scratch/$round/out/cruisefit-0.$ending" "$scratch/$round"/{cruisefit,LICENSE-MIT,README.md}
  done
  cmp "$scratch"/{one,two}/out/cruisefit-0.$ending || fail ".$ending differs"
done
tar -tzvf "$scratch/one/out/cruisefit-0.tar.gz" | grep -q -- '-rwxr-xr-x 0/0 .*cruisefit-0/cruisefit$' ||
  fail "the binary cannot be run"

# Without the tools: status 2, and each is named with what brings it.
for tool in bash sed head dirname grep; do ln -s "$(command -v $tool)" "$scratch/$tool"; done
printf '#!/bin/sh\necho /nowhere\n' >"$scratch/rustc"
chmod +x "$scratch/rustc"
status=0
said=$(PATH="$scratch" RELEASE_PROFILE=dev "$scratch/bash" release/build.sh 2>&1) || status=$?
[ "$status" = 2 ] || fail "status $status without toolchains: $said"
for wanted in "linux: musl-gcc (apt-get install musl-tools)" \
  "windows: the Rust target x86_64-pc-windows-gnu (rustup target add x86_64-pc-windows-gnu)" "wheel: maturin"; do
  [[ "$said" == *"$wanted"* ]] || fail "\"$wanted\" is not in: $said"
done
status=0
release/build.sh macos >/dev/null 2>&1 || status=$?
[ "$status" = 64 ] || fail "a part that does not exist: status $status"
version=$(sed -n 's/^version = "\(.*\)"$/\1/p' Cargo.toml | head -1)
grep -q "^ARG VERSION=$version$" release/Containerfile || fail "Containerfile is not of version $version"
echo "ok release scripts"
