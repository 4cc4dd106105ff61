"""Reports and recordings, reduced to stabilised segments."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

from . import _native
from ._columnar import ENDINGS as _COLUMNAR_ENDINGS, opened, require_pyarrow
from ._inputs import Inputs
from ._pages import is_content, read_text
from ._tables import Table, as_stream, is_table, like
from .errors import InputError, expected, found_and_expected, in_python, warn_of_refused

if TYPE_CHECKING:
    from .model import Model

__all__ = ["PRESETS", "Check", "Refused", "Report", "Segments", "check", "mapping", "segment"]

PRESETS = ("ghazi-2020-table-4", "airbus-report-02", "airbus-report-02-short")
"""Names of the trim criteria; the first one is the default."""

Report = Union[str, "os.PathLike[str]", bytes, tuple[str, bytes]]
"""A path (file, folder or glob), the bytes of a report, or its name and bytes."""

_BINARY = (bytes, bytearray, memoryview)
_REPORT_ENDINGS = (".txt", ".rpt", ".gz")
_RECORDING_ENDINGS = (".csv", ".gz", ".zst", *_COLUMNAR_ENDINGS)


@dataclass(frozen=True)
class Refused:
    """A report, flight or point that was refused while the rest continued.

    Attributes:
        path: File, or what the caller calls its bytes.
        line: Line from 1, where the refusal has one.
        column: Column (character) from 1, where the refusal has one.
        reason: What was found and what was expected.
    """

    path: str
    line: int | None
    column: int | None
    reason: str

    @property
    def found(self) -> str | None:
        """What was found, where the reason has the form "found …, expected …"."""
        return found_and_expected(self.reason)[0]

    @property
    def expected(self) -> str | None:
        """What was expected."""
        return found_and_expected(self.reason)[1]

    def __str__(self) -> str:
        place = self.path
        if self.line is not None:
            place += f":{self.line}"
            if self.column is not None:
                place += f":{self.column}"
        return f"{place}: {self.reason}"


def refused_of(rows: Iterable[tuple[str, int | None, int | None, str]]) -> list[Refused]:
    """What the native half refused."""
    return [Refused(path, line, column, in_python(reason)) for path, line, column, reason in rows]


class Segments:
    """Flights reduced to their stabilised segments: what models adapt to, are evaluated on and are diagnosed with.

    It is a table of segments itself (Arrow C interface): one row per segment, in SI units unless the name of a column says
    otherwise; a column per engine and per optional signal, null where its input is missing. Made by :func:`segment` or
    :meth:`from_table`.
    """

    def __init__(self, flights: _native.Flights) -> None:
        self._flights = flights

    @property
    def refused(self) -> list[Refused]:
        """Reports that were refused, and flights that contradict another one, with their reasons."""
        return refused_of(self._flights.refused())

    @property
    def tails(self) -> list[str]:
        """Every tail once, in order."""
        return self._flights.tails()

    @property
    def criteria(self) -> str:
        """Name of the trim criteria by which the segments were found."""
        return self._flights.criteria

    @property
    def flights(self) -> Table:
        """One row per flight, each once: path, tail, flight, start, aircraft type, engines, samples, segments, end, SHA-256 of
        the content, fuel burnt by gauges and meters (kg), notes."""
        return like(self._flights.table())

    def table(self, library: object = None) -> Table:
        """The table of segments, in the library that ``library`` (a table) is of, otherwise in pyarrow."""
        return like(self._flights.segments(), library)

    def to_csv(self) -> bytes:
        """The table as ``cruisefit segment`` writes it."""
        return self._flights.segments_csv()

    def of_tails(self, *tails: str) -> Segments:
        """The flights of these tails alone."""
        return Segments(self._flights.of_tails(tails))

    def state(self) -> Table:
        """One row per flight with all that it was reduced to (column ``segments_csv``), for a file or another machine:
        :meth:`from_state` reads it back to the same bits."""
        return like(self._flights.state())

    @classmethod
    def from_state(cls, table: Table, criteria: str = PRESETS[0]) -> Segments:
        """Flights from :meth:`state`.

        Raises:
            InputError: A column is missing, a value is not what its column holds, or there are no such criteria.
        """
        return cls(_native.Flights.from_state(as_stream(table), criteria))

    @classmethod
    def from_table(
        cls, table: Table, aircraft_type: str, criteria: str = PRESETS[0]
    ) -> Segments:
        """Flights from a table of segments alone (``segments/TAIL.csv``, or :meth:`table` after a selection of rows).

        Args:
            table: Rows with the columns of a table of segments.
            aircraft_type: Type code of the aircraft, which a table of segments does not hold.
            criteria: Trim criteria by which the segments were found.

        Raises:
            InputError: A column is missing, a value is not what its column holds, or there are no such criteria.
        """
        return cls(_native.Flights.from_segments(as_stream(table), aircraft_type, criteria))

    def __add__(self, other: Segments) -> Segments:
        """Flights of both, each once.

        Raises:
            InputError: Their segments were found by other trim criteria, by which a model would not continue.
        """
        others = flights_of(other)
        if other.criteria != self.criteria:
            raise InputError(
                f"criteria: found segments by {self.criteria!r} and by {other.criteria!r}, expected the same of both"
            )
        flights = self._flights.and_([others])
        flights.look_through()
        return Segments(flights)

    def __len__(self) -> int:
        return self._flights.count_segments()

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        return self._flights.segments().__arrow_c_stream__(requested_schema)

    def __repr__(self) -> str:
        return (
            f"<Segments: {len(self)} segments of {len(self._flights)} flights, {len(self.tails)} tails, "
            f"{len(self._flights.refused())} refused>"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickled, (self.state(), self.criteria, self._flights.refused_as_read())


def flights_of(segments: Segments) -> _native.Flights:
    """Segments as the native half takes them.

    Raises:
        InputError: Something else.
    """
    expected(segments, Segments, "cruisefit.segment makes them of reports, and with a mapping of tables")
    return segments._flights


def _unpickled(
    state: Table, criteria: str, refused: Sequence[tuple[str, int | None, int | None, str]]
) -> Segments:
    return Segments(Segments.from_state(state, criteria)._flights.with_refused(refused))


def segment(
    reports: Report | Sequence[Report] | Table,
    *,
    mapping: str | os.PathLike[str] | None = None,
    criteria: str = PRESETS[0],
    name: str = "table",
    threads: int | None = None,
) -> Segments:
    """Finds the stabilised segments of reports or recordings; needs no model.

    Args:
        reports: Paths (files; folders, searched with all below them for .txt, .rpt and .gz, with a mapping for recordings, but
            not what ``adapt`` keeps there; patterns, ``**`` for folders of any depth), bytes, or pairs
            of name and bytes; one or several. Recordings are delimited text, plain or packed (.csv, .gz, .zst), Parquet
            (.parquet) and Arrow (.arrow, .arrows, .feather, .ipc); the last two need pyarrow. They are read piece by piece, so
            that they may be of any length. With a mapping also a table (Arrow C interface) whose rows are samples and whose
            columns the mapping names; its other columns may be of any type. A null and NaN are values that are missing.
        mapping: Mapping file (RON), its text, or the name of a preset, for recordings of another layout.
        criteria: Trim criteria that decide which samples are steady, one of :data:`PRESETS`. Source: Ghazi et al. 2020,
            table 4, the first; Airbus, Getting to Grips with Aircraft Performance Monitoring, report <02>, the second.
        name: What results call a table.
        threads: Threads to use; all processors without it.

    Returns:
        The segments; reports that were refused are in :attr:`Segments.refused`, and a :class:`DataWarning` says that there are
        some.

    Raises:
        InputError: No report at all, unknown criteria, or a mapping that is none.
        FileNotFoundError: A path, or a pattern, that matches nothing.
        ModuleNotFoundError: A Parquet or Arrow file without pyarrow.
    """
    reading = _native.Source(criteria, None if mapping is None else _mapping(mapping))
    if is_table(reports):
        return _looked_through(reading.rows(name, as_stream(reports), threads))
    inputs, contents = _found(reports, _RECORDING_ENDINGS if mapping else _REPORT_ENDINGS)
    paths = sorted(inputs.files)
    require_pyarrow([*((str(path), path) for path in paths), *contents])
    read = reading.files(paths, inputs.skipped, opened, threads)
    if contents:
        read = read.and_([reading.contents(contents, opened, threads)])
    if inputs.refused:
        read = read.with_refused([*inputs.refused, *read.refused_as_read()])
    return _looked_through(read)


def _found(reports: Any, endings: tuple[str, ...]) -> tuple[Inputs, list[tuple[str, bytes]]]:
    """The files that were named, and what is in memory with its names.

    Raises:
        InputError: There is neither.
        TypeError: Something that is no report.
    """
    inputs = Inputs(endings)
    contents: list[tuple[str, bytes]] = []
    searched: list[Path] = []
    for one in _several(reports):
        if isinstance(one, _BINARY):
            contents.append((f"report {len(contents) + 1}", bytes(one)))
        elif isinstance(one, tuple):
            name, content = one
            contents.append((name, bytes(content) if isinstance(content, _BINARY) else content))
        elif isinstance(one, (str, os.PathLike)):
            searched.append(Path(one))
            inputs.add(Path(one))
        else:
            collect = "; collect() it first" if hasattr(one, "collect") else ""
            one_by_one = "; a table is read by itself, and Segments are added up" if is_table(one) else ""
            raise TypeError(
                f"found {type(one).__name__}, expected a path, bytes, or a name and bytes{collect}{one_by_one}"
            )
    if not inputs.files and not contents:
        where = f" in {', '.join(map(str, searched))}" if searched else ""
        skipped = f"; files skipped for their endings: {inputs.skipped}" if inputs.skipped else ""
        unlisted = "".join(f"; {path}: {reason}" for path, _, _, reason in inputs.refused)
        raise InputError(f"found no cruise report{where}, expected one or more{skipped}{unlisted}")
    return inputs, contents


def _several(reports: Any) -> Iterable[Any]:
    """One report or several, one by one."""
    is_named = isinstance(reports, tuple) and len(reports) == 2 and isinstance(reports[1], _BINARY)
    # A file that is open gives its lines one by one, none of which is a report.
    is_one = is_named or isinstance(reports, (str, *_BINARY)) or hasattr(reports, "read")
    return [reports] if is_one or not isinstance(reports, Iterable) else reports


def _looked_through(flights: _native.Flights) -> Segments:
    flights.look_through()
    segments = Segments(flights)
    warn_of_refused(segments.refused, len(flights))
    return segments


def mapping(recording: str | os.PathLike[str] | bytes | Table, *, name: str = "table") -> str:
    """A first mapping for a recording, from the names and values of its columns: ``cruisefit mapping``. Lines marked ``// ?``
    are guesses to check; the text, corrected, is what :func:`segment` takes as ``mapping``.

    Args:
        recording: A recording as :func:`segment` reads it (path or bytes), or a table whose rows are samples, of which the
            first 50 000 are looked at.
        name: What errors call a table or bytes.

    Raises:
        InputError: The recording has no line of column names, or cannot be read.
        FileNotFoundError: There is no such file.
        ModuleNotFoundError: A Parquet or Arrow file without pyarrow.
    """
    if isinstance(recording, bytes):
        require_pyarrow([(name, recording)])
        return _native.mapping_of_content(name, recording, opened)
    if is_table(recording):
        return _native.mapping_of_table(name, as_stream(recording))
    path = Path(recording)
    if not path.exists():
        raise FileNotFoundError(f"{path}: no such file")
    require_pyarrow([(str(path), path)])
    return _native.mapping_of_content(str(path), None, opened)


class Check:
    """What is wrong with recorded data."""

    def __init__(self, document: bytes, text: str) -> None:
        self._document = document
        self._text = text

    def to_dict(self) -> dict[str, Any]:
        """The document of ``cruisefit check --json``."""
        document: dict[str, Any] = json.loads(self._document)
        return document

    def to_json(self) -> bytes:
        """The bytes of the same."""
        return self._document

    @property
    def findings(self) -> list[dict[str, Any]]:
        """Findings, the most serious first: code, severity, tail, flight, message, likely cause, and more."""
        found: list[dict[str, Any]] = self.to_dict()["findings"]
        return found

    def __repr__(self) -> str:
        return self._text


def check(segments: Segments, models: Model | Sequence[Model] = ()) -> Check:
    """What is wrong with reports, before any modelling: units, frozen or wrong channels, copies, dates; with models also
    against the book. For this, ``segments`` has to come from :func:`segment`: a table of segments has lost the samples.

    Args:
        segments: Flights of any tails.
        models: Model, or several, to compare fuel flow with.

    Raises:
        InputError: Two models claim the same tail or type.
    """
    from .model import Model, natives_of

    of_models = natives_of(models) if isinstance(models, Model) or models else []
    return Check(*_native.check(of_models, flights_of(segments)))


def _mapping(mapping: str | os.PathLike[str]) -> str:
    """The text of a mapping file; a text and the name of a preset as they are."""
    text = os.fspath(mapping)
    if is_content(text):
        return text
    path = Path(text)
    return read_text(path) if path.suffix or path.exists() else text
