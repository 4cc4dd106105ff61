"""The lock by which the command line keeps a folder of ``adapt`` to one process at a time."""

from __future__ import annotations

import datetime
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

__all__ = ["folder_lock"]

_LOCK = ".cruisefit-lock"


@contextmanager
def folder_lock(folder: Path) -> Iterator[Path]:
    """Holds the lock of a folder; gives its file, which is removed at the end.

    Raises:
        BlockingIOError: Another process holds it; the text names that process.
    """
    path = folder / _LOCK
    descriptor = _locked(path)
    try:
        since = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")
        os.ftruncate(descriptor, 0)
        os.write(descriptor, f"process {os.getpid()} on {socket.gethostname()} (since {since})\n".encode())
        yield path
    finally:
        # Removed while it is still held: whoever waits for it finds that it is gone and takes a new one.
        path.unlink(missing_ok=True)
        os.close(descriptor)


def _locked(path: Path) -> int:
    while True:
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            _lock(descriptor)
        except OSError:
            holder = os.pread(descriptor, 1000, 0).decode(errors="replace").strip() if hasattr(os, "pread") else ""
            os.close(descriptor)
            raise BlockingIOError(f"{path.parent}: {holder or 'another process'} is writing it") from None
        try:
            same = os.path.samestat(os.fstat(descriptor), os.stat(path))
        except FileNotFoundError:
            same = False
        if same:
            return descriptor
        # The holder before removed its file: this was the lock of nothing.
        os.close(descriptor)


def _lock(descriptor: int) -> None:
    try:
        import fcntl
    except ImportError:  # Windows
        import msvcrt

        getattr(msvcrt, "locking")(descriptor, getattr(msvcrt, "LK_NBLCK"), 1)
        return
    fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
