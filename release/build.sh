#!/usr/bin/env bash
# Builds what a release consists of, to release/out (or OUT), meant to be the same bytes for the same commit and toolchain:
#
#     release/build.sh                     # all: linux windows wheel
#     release/build.sh linux               # cruisefit-VERSION-x86_64-linux-musl.tar.gz: one static binary
#     release/build.sh static              # cruisefit-VERSION-x86_64-linux-static.tar.gz: the same with the C library of GNU linked
#                                          # in, where the musl target is not at hand
#     release/build.sh windows             # cruisefit-VERSION-x86_64-windows.zip
#     release/build.sh wheel               # cruisefit-VERSION-cp310-abi3-….whl
#     release/build.sh --check             # what is missing on this machine; nothing is built
#     release/build.sh --tag               # also demands that CHANGELOG.md has the version and git a tag of it
#     STD_FROM_SOURCE=1 release/build.sh linux windows
#                                          # where the targets cannot be fetched: the standard library is built from source, by a
#                                          # nightly toolchain (NIGHTLY, as `nightly`) with its component rust-src
#
# Needs rustup's targets x86_64-unknown-linux-musl and x86_64-pc-windows-gnu, musl-gcc (Debian: musl-tools),
# x86_64-w64-mingw32-gcc (Debian: gcc-mingw-w64-x86-64), maturin 1.9.4 or later, python3. A part whose tools are missing
# is refused before anything is built. RELEASE_PROFILE=dev builds faster, for a trial of this script.
#
# Tested (release/test.sh): archives have the same bytes twice; a machine without the tools is told what it lacks. Measured:
# the parts `static` and `linux`, built twice in different folders, have the same bytes; `linux` and `windows` with the library
# from source run the demo as the README shows it, the one in an empty root, the other under Wine.
#
# Same bytes: times are those of the commit (SOURCE_DATE_EPOCH), paths of this machine are mapped away, archives have
# neither owners nor times nor an order of their own.
set -euo pipefail
cd "$(dirname "$0")/.."

version=$(sed -n 's/^version = "\(.*\)"$/\1/p' Cargo.toml | head -1)
out=${OUT:-release/out}
profile=${RELEASE_PROFILE:-release}
folder=$profile
[ "$profile" != dev ] || folder=debug
target=${CARGO_TARGET_DIR:-target}
export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)}
registry=${CARGO_HOME:-$HOME/.cargo}
export CARGO_INCREMENTAL=0 LC_ALL=C TZ=UTC
export RUSTFLAGS="--remap-path-prefix=$PWD=/cruisefit --remap-path-prefix=$registry=/cargo ${RUSTFLAGS:-}"
export CFLAGS="-ffile-prefix-map=$PWD=/cruisefit -ffile-prefix-map=$registry=/cargo ${CFLAGS:-}"

fail() { printf 'release: %s\n' "$*" >&2; exit 2; }

# The toolchain of cross-built parts, and what it has to build beside the program.
nightly=${NIGHTLY:-nightly}
cross=(cargo)
library=()
if [ -n "${STD_FROM_SOURCE:-}" ]; then
  cross=(cargo "+$nightly")
  library=(-Z build-std=std,panic_abort)
  # Where there is no such toolchain, that is said with everything else that is missing.
  RUSTFLAGS="--remap-path-prefix=$(rustc "+$nightly" --print sysroot 2>/dev/null || true)=/rust $RUSTFLAGS"
fi

# One line for each tool that is missing, with what brings it.
missing_for() {
  local triple=$1 compiler=$2 package=$3
  command -v "$compiler" >/dev/null 2>&1 || echo "$compiler (apt-get install $package)"
  if [ -n "${STD_FROM_SOURCE:-}" ]; then
    cargo "+$nightly" --version >/dev/null 2>&1 || echo "the toolchain $nightly (rustup toolchain install $nightly -c rust-src)"
    return
  fi
  [ -d "$(rustc --print sysroot 2>/dev/null)/lib/rustlib/$triple" ] ||
    echo "the Rust target $triple (rustup target add $triple)"
}
missing() {
  case "$1" in
    linux) missing_for x86_64-unknown-linux-musl musl-gcc musl-tools ;;
    static)
      [ -f "$(cc -print-file-name=libc.a 2>/dev/null)" ] || echo "cc and libc.a (apt-get install gcc libc6-dev)"
      ;;
    windows)
      missing_for x86_64-pc-windows-gnu x86_64-w64-mingw32-gcc gcc-mingw-w64-x86-64
      ;;
    wheel) command -v maturin >/dev/null 2>&1 || echo "maturin (pip install 'maturin>=1.9.4,<2')" ;;
  esac
  command -v python3 >/dev/null 2>&1 || echo "python3"
}

# The version has a heading in CHANGELOG.md, and this commit its tag.
check_tag() {
  grep -q "^## $version" CHANGELOG.md || fail "CHANGELOG.md has no heading \"## $version\""
  [ "$(git describe --tags --exact-match 2>/dev/null)" = "v$version" ] ||
    fail "this commit is not tagged v$version (git tag v$version)"
  [ -z "$(git status --porcelain --untracked-files=no)" ] || fail "files differ from the commit"
}

# Binary, licences, README and CHANGELOG as an archive without times, owners or an order of its own.
pack() {
  python3 release/archive.py "$1" "$2" README.md CHANGELOG.md LICENSE-APACHE LICENSE-MIT \
    crates/page/fonts/OFL.txt
  echo "$1: $(wc -c <"$1") bytes, sha256 $(sha256sum "$1" | cut -d' ' -f1)"
}

build() {
  local triple=$1 binary=$2 archive=$3
  "${cross[@]}" build "${library[@]}" --locked --profile "$profile" --package cruisefit --target "$triple"
  pack "$out/$archive" "$target/$triple/$folder/$binary"
}

parts=() check=no tag=no
for argument in "$@"; do
  case "$argument" in
    --check) check=yes ;;
    --tag) tag=yes ;;
    linux | static | windows | wheel) parts+=("$argument") ;;
    *) sed -n '2,12s/^# \{0,1\}//p' "$0" >&2; exit 64 ;;
  esac
done
[ "${#parts[@]}" -gt 0 ] || parts=(linux windows wheel)

lacking=""
for part in "${parts[@]}"; do
  while IFS= read -r line; do
    [ -z "$line" ] || lacking+="  $part: $line"$'\n'
  done < <(missing "$part")
done
if [ -n "$lacking" ]; then
  fail "this machine lacks
${lacking%$'\n'}
name the other parts to build them alone: release/build.sh linux|static|windows|wheel"
fi
[ "$tag" = no ] || check_tag
if [ "$check" = yes ]; then
  echo "everything is there for: ${parts[*]} (version $version, time $SOURCE_DATE_EPOCH)"
  exit 0
fi

mkdir -p "$out"
for part in "${parts[@]}"; do
  case "$part" in
    linux)
      if [ -n "${STD_FROM_SOURCE:-}" ]; then
        # What a fetched target brings: the C library's start files come from musl-gcc, the unwinder from the compiler. That
        # one may ask a newer C library of GNU where frames are; here nobody knows, and a panic has no backtrace.
        mkdir -p "$target/unwinder"
        unwinder=$(cd "$target/unwinder" && pwd)
        cp "$(cc -print-file-name=libgcc_eh.a)" "$unwinder/libunwind.a"
        echo 'int _dl_find_object(void *address, void *found) { return -1; }' |
          musl-gcc -c -x c - -o "$unwinder/frames.o"
        ar qD "$unwinder/libunwind.a" "$unwinder/frames.o"
        # Of a static program at a place of its own choice (PIE) musl-gcc may not know how it is linked.
        linking=" -C linker=musl-gcc -C link-self-contained=no -C relocation-model=static -L native=$unwinder"
      fi
      RUSTFLAGS="$RUSTFLAGS${linking:-}" \
      CC_x86_64_unknown_linux_musl=musl-gcc \
      build x86_64-unknown-linux-musl cruisefit "cruisefit-$version-x86_64-linux-musl.tar.gz"
      ;;
    static)
      RUSTFLAGS="$RUSTFLAGS -C target-feature=+crt-static" \
      build x86_64-unknown-linux-gnu cruisefit "cruisefit-$version-x86_64-linux-static.tar.gz"
      ;;
    windows)
      # The linker of mingw writes the time into the file unless it is told not to.
      CARGO_TARGET_X86_64_PC_WINDOWS_GNU_RUSTFLAGS="$RUSTFLAGS -C link-arg=-Wl,--no-insert-timestamp" \
      RUSTFLAGS="$RUSTFLAGS -C link-arg=-Wl,--no-insert-timestamp" \
      build x86_64-pc-windows-gnu cruisefit.exe "cruisefit-$version-x86_64-windows.zip"
      ;;
    wheel)
      maturin build --locked --profile "${profile/release/wheel}" --manifest-path crates/python/Cargo.toml --out "$out"
      sha256sum "$out"/cruisefit-"$version"-*.whl
      ;;
  esac
done
