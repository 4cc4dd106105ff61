"""Inputs that fuzzing found worth keeping, packed: one file a target, which the tests read on a stable compiler too.

    python3 fuzz/corpora.py unpack      from crates/cli/tests/hostile/corpora/TARGET.gz to fuzz/corpus/TARGET/, to go on from
    python3 fuzz/corpora.py pack        the other way, largest inputs last; inputs above 16 kB are left out

A packed file is gzip of the inputs in the order of their lengths and bytes, each behind its length in four bytes, little end first.
Standard library only.
"""
import gzip
import hashlib
import pathlib
import struct
import sys

FUZZ = pathlib.Path(__file__).resolve().parent
PACKED = FUZZ.parent / "crates/cli/tests/hostile/corpora"
LARGEST = 16_384


def unpack():
    for packed in sorted(PACKED.glob("*.gz")):
        folder = FUZZ / "corpus" / packed.stem
        folder.mkdir(parents=True, exist_ok=True)
        rest = gzip.decompress(packed.read_bytes())
        while rest:
            (length,) = struct.unpack_from("<I", rest)
            content, rest = rest[4 : 4 + length], rest[4 + length :]
            (folder / hashlib.sha1(content).hexdigest()).write_bytes(content)


def pack():
    PACKED.mkdir(exist_ok=True)
    for folder in sorted((FUZZ / "corpus").iterdir()):
        inputs = sorted({path.read_bytes() for path in folder.iterdir()}, key=lambda one: (len(one), one))
        kept = [one for one in inputs if len(one) <= LARGEST]
        content = b"".join(struct.pack("<I", len(one)) + one for one in kept)
        (PACKED / f"{folder.name}.gz").write_bytes(gzip.compress(content, 9, mtime=0))
        print(f"{folder.name}: {len(kept)} of {len(inputs)} inputs")


if __name__ == "__main__":
    {"pack": pack, "unpack": unpack}[sys.argv[1]]()
