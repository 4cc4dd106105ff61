"""Pages in notebooks, and files written whole or not at all."""

from __future__ import annotations

import contextlib
import html
import os
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Literal

from . import _native
from .errors import InputError, warn

__all__ = ["Chart", "DiagnosisChart", "TailChart", "framed", "is_content", "names_of", "read_text", "write_bytes"]


TailChart = Literal[
    "histogram", "time", "forecast", "surface", "relief", "specific-range", "engines", "polar"
]
"""A chart of a model or of a tail: ``cruisefit plot --chart``."""

DiagnosisChart = Literal["waterfall", "gap-map"]
"""A chart of a diagnosis."""


class Chart:
    """Charts as SVG, which a notebook shows."""

    def __init__(self, svg: str) -> None:
        self.svg = svg

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes SVG, PNG or PDF, by the ending of the path: the bytes of ``cruisefit plot``.

        Raises:
            InputError: The path has another ending.

        Warns:
            DataWarning: The font of PNG and PDF does not have a character of a name; an SVG has it.
        """
        ending = Path(path).suffix.lower().removeprefix(".")
        if ending == "svg":
            write_bytes(path, self.svg.encode())
            return
        content, unknown = _native.picture(self.svg, ending)
        write_bytes(path, content)
        if unknown:
            warn([f"the font of PNG and PDF does not have {unknown!r}: boxes in {path}; an SVG has them"])

    def _repr_svg_(self) -> str:
        return self.svg


def names_of(asked: str | Sequence[str]) -> list[str]:
    """One name, or several, as a list."""
    return [asked] if isinstance(asked, str) else list(asked)


def framed(page: str, height_px: int = 600) -> str:
    """A page in a frame of its own, so that neither its styles nor the notebook's reach the other."""
    return (
        f'<iframe srcdoc="{html.escape(page, quote=True)}" sandbox="" '
        f'style="width:100%;height:{height_px}px;border:0"></iframe>'
    )


def read_text(path: str | os.PathLike[str]) -> str:
    """The text of a file (UTF-8).

    Raises:
        InputError: It is no text.
    """
    try:
        return Path(path).read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        found = f"byte 0x{error.object[error.start]:02x}"
        raise InputError(f"found {found}, expected text in UTF-8", file=os.fspath(path)) from None


def is_content(text: str) -> bool:
    """Whether a text is the content of a file (RON) rather than its path, which may have parentheses too."""
    if "(" not in text:
        return False
    # What is written on one line may be longer than the name of a file can be: `Path.exists` would raise.
    return "\n" in text or (text.rstrip().endswith(")") and not os.path.exists(text))


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
