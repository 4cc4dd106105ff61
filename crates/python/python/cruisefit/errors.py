"""Exceptions of cruisefit: each says where its input is wrong, what was found and what was expected."""

from __future__ import annotations

import re
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path

__all__ = ["CruisefitError", "DataWarning", "InputError", "InternalError", "PredictionWarning"]


class CruisefitError(Exception):
    """What every exception of this package is.

    Attributes:
        message: The reason, without the position.
        file: File, or what the caller calls its bytes; ``None`` where the input has no name.
        line: Line of a text, or row of a table, from 1; ``None`` where no line is at fault.
        column: Column of a text (character, from 1) or name of a table's column; ``None`` where no column is at fault.
        found: What was found there, where the reason has the form "found …, expected …".
        expected: What was expected there.
    """

    def __init__(
        self,
        message: str,
        file: str | None = None,
        line: int | None = None,
        column: int | str | None = None,
    ) -> None:
        message = in_python(message)
        self.message = message
        self.file = file
        self.line = line
        self.column = column
        self.found, self.expected = found_and_expected(message)
        where = ""
        if file is not None:
            where = f"{file}:"
        if line is not None:
            # A table that was given as one has rows, and no line of names above them.
            where += f" line {line}," if where else f"row {line},"
        if column is not None:
            where += f" column {column},"
        where = where.rstrip(",").rstrip(":").strip()
        super().__init__(f"{where}: {message}" if where else message)

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (self.message, self.file, self.line, self.column)


class InputError(CruisefitError, ValueError):
    """A file, table or argument that is wrong. Nothing was done."""


class InternalError(CruisefitError, RuntimeError):
    """A fault of cruisefit itself. Nothing was done."""


class PredictionWarning(UserWarning):
    """Rows of flight points for which the model has no prediction; their results are null."""


class DataWarning(UserWarning):
    """What recorded data or a model gives reason to look at: serious findings, copies of reports, dates that cannot be right,
    what was left out. What the command line prints as ``WARN``."""


def found_and_expected(message: str) -> tuple[str | None, str | None]:
    """The two halves of a reason of the form "found …, expected …"; ``None`` where it has another form.

    >>> found_and_expected('found "1.781", expected MACH of 0.1 to 0.99')
    ('"1.781"', 'MACH of 0.1 to 0.99')
    >>> found_and_expected("no such file")
    (None, None)
    """
    _, separator, rest = message.partition("found ")
    found, comma, expected = rest.partition(", expected ")
    if not separator or not comma:
        return None, None
    return found, expected


_OPTION = re.compile(r"--(accept|allow-learnt|relearn|table-only)\b")


def in_python(message: str) -> str:
    """A message of the command line's with its options as arguments.

    >>> in_python("--allow-learnt diagnoses it anyway")
    'allow_learnt=True diagnoses it anyway'
    """
    return _OPTION.sub(lambda option: option[1].replace("-", "_") + "=True", message)


def expected(found: object, kind: type, made_by: str) -> None:
    """Refuses an argument that is of another type.

    Raises:
        InputError: It is.
    """
    if not isinstance(found, kind):
        what = type(found).__name__
        raise InputError(f"found {what}, expected {kind.__name__}: {made_by}")


def warn_of_refused(refused: Sequence[object], left: int) -> None:
    """Says that something was refused while the rest continued, and what the first of it was."""
    if refused:
        others = f" and {len(refused) - 1} more (all of them: .refused)" if len(refused) > 1 else ""
        nothing = "" if left else "; nothing is left"
        warn([f"refused: {refused[0]}{others}{nothing}"])


def warn(messages: Sequence[str]) -> None:
    """Raises a :class:`DataWarning` for each message, at the line outside of this package that led here."""
    package = str(Path(__file__).parent)
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and frame.f_code.co_filename.startswith(package):
        level, frame = level + 1, frame.f_back
    for message in _by_kind(messages):
        warnings.warn(in_python(message), DataWarning, stacklevel=level)


# As many of a kind are raised one by one, as the command line prints them.
_ONE_BY_ONE = 3
_NUMBER = re.compile(r"\d+")


def _by_kind(messages: Sequence[str]) -> list[str]:
    """Many messages that differ in their numbers alone as the first of them and how many there are.

    >>> _by_kind(["line 10: x", "y", "line 9: x", "line 11: x", "line 12: x"])
    ['line 9: x (and 3 more of this kind)', 'y']
    """
    kinds: dict[str, list[str]] = {}
    for message in messages:
        kinds.setdefault(_NUMBER.sub("0", message), []).append(message)
    shown = []
    for kind in kinds.values():
        if len(kind) <= _ONE_BY_ONE:
            shown.extend(kind)
            continue
        first = min(kind, key=lambda message: [int(number) for number in _NUMBER.findall(message)])
        shown.append(f"{first} (and {len(kind) - 1} more of this kind)")
    return shown
