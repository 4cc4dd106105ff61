"""Packs files into a .tar.gz or .zip with the same bytes for the same files: names sorted, no owners, one time.

    python3 release/archive.py ARCHIVE FILE...

The time of every entry is SOURCE_DATE_EPOCH (https://reproducible-builds.org/specs/source-date-epoch/). Python 3.10 or
later, standard library only.
"""

import gzip
import os
import pathlib
import sys
import tarfile
import time
import zipfile

# ZIP knows no earlier time.
EARLIEST = 315532800


def main(archive: str, files: list[str]) -> None:
    """Writes `archive`; every file is in a folder that is called as the archive is."""
    epoch = max(int(os.environ["SOURCE_DATE_EPOCH"]), EARLIEST)
    folder = pathlib.Path(archive).name.removesuffix(".zip").removesuffix(".tar.gz")
    entries = sorted((f"{folder}/{pathlib.Path(file).name}", pathlib.Path(file)) for file in files)
    if archive.endswith(".zip"):
        write_zip(archive, entries, epoch)
    else:
        write_tar(archive, entries, epoch)


def mode(file: pathlib.Path) -> int:
    """Runs for everybody, or is read by everybody: not the umask of who builds."""
    return 0o755 if file.name.startswith("cruisefit") else 0o644


def write_zip(archive: str, entries: list[tuple[str, pathlib.Path]], epoch: int) -> None:
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as packed:
        for name, file in entries:
            entry = zipfile.ZipInfo(name, time.gmtime(epoch)[:6])
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = 3
            entry.external_attr = mode(file) << 16
            packed.writestr(entry, file.read_bytes())


def write_tar(archive: str, entries: list[tuple[str, pathlib.Path]], epoch: int) -> None:
    with open(archive, "wb") as raw, gzip.GzipFile("", "wb", 9, raw, mtime=epoch) as zipped:
        with tarfile.open(fileobj=zipped, mode="w", format=tarfile.USTAR_FORMAT) as packed:
            for name, file in entries:
                entry = tarfile.TarInfo(name)
                entry.size = file.stat().st_size
                entry.mtime = epoch
                entry.mode = mode(file)
                with file.open("rb") as content:
                    packed.addfile(entry, content)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
