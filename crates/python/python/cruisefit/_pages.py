"""Pages in notebooks, and files written whole or not at all."""

from __future__ import annotations

import contextlib
import html
import os
import tempfile
from pathlib import Path

__all__ = ["Chart", "framed", "read_text", "write_bytes"]


class Chart:
    """Charts as SVG, which a notebook shows."""

    def __init__(self, svg: str) -> None:
        self.svg = svg

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the SVG file: the bytes of ``cruisefit plot``."""
        write_bytes(path, self.svg.encode())

    def _repr_svg_(self) -> str:
        return self.svg


def framed(page: str, height_px: int = 600) -> str:
    """A page in a frame of its own, so that neither its styles nor the notebook's reach the other."""
    return (
        f'<iframe srcdoc="{html.escape(page, quote=True)}" sandbox="" '
        f'style="width:100%;height:{height_px}px;border:0"></iframe>'
    )


def read_text(path: str | os.PathLike[str]) -> str:
    """The text of a file (UTF-8)."""
    return Path(path).read_text(encoding="utf-8")


def write_bytes(path: str | os.PathLike[str], content: bytes) -> None:
    """Writes a file whole or not at all: to a temporary file beside it, which then takes its name."""
    target = Path(path)
    handle, name = tempfile.mkstemp(prefix=".cruisefit-", suffix=".tmp", dir=target.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        Path(name).chmod(0o644)
        os.replace(name, target)
    except BaseException:
        with contextlib.suppress(FileNotFoundError):
            Path(name).unlink()
        raise
