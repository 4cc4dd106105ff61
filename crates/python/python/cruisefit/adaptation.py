"""Models adapted to flights, and evaluated on them."""

from __future__ import annotations

import datetime
import hashlib
import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal

from . import _native
from ._folder import folder_lock
from ._pages import Chart, TailChart, framed, names_of, read_text, write_bytes
from ._tables import Table, like
from .errors import InputError, expected, in_python, warn, warn_of_refused
from .model import Model, natives_of
from .segments import Refused, Segments, flights_of, refused_of

__all__ = ["Adaptation", "Evaluation", "Law", "Monitoring", "adapt", "evaluate", "merge"]

Law = Literal["bayes", "paper"]
"""Laws of adaptation: ``bayes``, a smooth correction with a standard deviation at every node, and ``paper``, the local law of
Ghazi et al. 2020 with its global refit."""

_TITLE_OF_ADAPTATION = "Adaptation of performance models to cruise reports"
_TITLE_OF_EVALUATION = "Evaluation of performance models on cruise reports"


class _Run:
    """What an adaptation and an evaluation have in common."""

    _title = ""

    def __init__(self, native: _native.Adapted) -> None:
        self._native = native

    @property
    def tails(self) -> list[str]:
        """Tails, in order."""
        return self._native.tails()

    @property
    def refused(self) -> list[Refused]:
        """Reports that were refused, with their reasons."""
        return refused_of(self._native.refused())

    @property
    def summary(self) -> dict[str, Any]:
        """``summary.json``: flights, segments and fuel-flow errors (per cent of recorded) of every tail."""
        summary: dict[str, Any] = json.loads(self._native.summary_json())
        return summary

    def summary_json(self) -> bytes:
        """The bytes of ``summary.json``."""
        return self._native.summary_json()

    @property
    def findings(self) -> str:
        """Serious findings in the data, in words; empty where there are none. :func:`cruisefit.check` lists all."""
        return in_python(self._native.findings())

    def notes(self, tail: str) -> list[str]:
        """What is worth knowing about a tail's data."""
        return self._native.notes(tail)

    def segments(self, tail: str, library: object = None) -> Table:
        """A tail's segments with the lift and drag coefficients, predicted fuel flow (kg/s) and error (per cent) by its
        initial table (of an evaluation: by its table as it is)."""
        return like(self._native.segments(tail), library)

    def page(self) -> str:
        """The result as one HTML page with charts: ``report.html``. Of more than 200 tails it has the table of the fleet and links
        to the pages of tails, which :meth:`Adaptation.write` puts beside it; a tail's charts are :meth:`plot`."""
        return self._native.page(self._title)

    def plot(self, tail: str, charts: TailChart | Sequence[TailChart] = ()) -> Chart:
        """A tail's charts, its segments among them: ``cruisefit plot DIR --tail TAIL``.

        Args:
            tail: Tail.
            charts: Names of the charts to draw: ``histogram``, ``time``, ``forecast``, ``surface``, ``relief``,
                ``specific-range``, ``engines``, ``polar``; all without any.

        Raises:
            InputError: There is no such tail or chart, or nothing is left to draw.
        """
        return Chart(self._native.plot(tail, names_of(charts)))

    def _repr_html_(self) -> str:
        return framed(self.page())

    def __repr__(self) -> str:
        return self._native.summary_text()


class Adaptation(_Run):
    """Tails with what they have learnt: what ``cruisefit adapt`` keeps in a folder."""

    _title = _TITLE_OF_ADAPTATION

    def model(self, tail: str | None = None) -> Model:
        """A tail's adapted model; without a name that of the only tail.

        Raises:
            InputError: There is no such tail.
            ValueError: Several tails and no name.
        """
        if tail is None:
            if len(self.tails) != 1:
                raise ValueError(f"found {len(self.tails)} tails, expected the name of one")
            tail = self.tails[0]
        return Model(self._native.model(tail))

    @property
    def models(self) -> dict[str, Model]:
        """Every tail's adapted model."""
        return {tail: Model(self._native.model(tail)) for tail in self.tails}

    def segments_csv(self, tail: str) -> bytes:
        """The bytes of ``segments/TAIL.csv``."""
        return self._native.segments_csv(tail)

    def flights_csv(self, tail: str) -> bytes:
        """The bytes of ``flights/TAIL.csv``: the flights that the tail has learnt."""
        return self._native.flights_csv(tail)

    def begun(self, tail: str) -> str:
        """SHA-256 of what the tail was begun with: initial model, law, settings, trim criteria."""
        return self._native.begun(tail)

    def write(self, folder: str | os.PathLike[str]) -> None:
        """Writes a new folder: the files that ``cruisefit adapt`` writes into one, which can go on from it. While it is
        written it is locked as the command line locks it; ``STATE.ron``, without which it holds nothing, comes last.

        Raises:
            FileExistsError: The folder exists and is not empty. What a folder holds is continued with :meth:`read` and
                ``begun``, and written to another one; or at the command line.
            BlockingIOError: Another process is writing the folder; the text names it.
        """
        target = Path(folder)
        target.mkdir(parents=True, exist_ok=True)
        with folder_lock(target) as lock:
            if any(file != lock for file in target.iterdir()):
                raise FileExistsError(f"{target}: found a folder with files, expected a new one")
            files = self._native.files(self._title)
            for name, content in sorted(files, key=lambda file: file[0] == "STATE.ron"):
                file = target / name
                file.parent.mkdir(parents=True, exist_ok=True)
                write_bytes(file, content)

    @classmethod
    def read(cls, folder: str | os.PathLike[str], *, strict: bool = True) -> Adaptation:
        """What a folder of ``cruisefit adapt`` or of :meth:`write` holds, to be continued as ``begun``.

        Args:
            folder: The folder.
            strict: Refuse a folder of which a tail cannot be read. Without it such a tail is left out, as ``cruisefit monitor``
                leaves it out, with a :class:`DataWarning`: to look at the others, not to be continued, since the tail would begin
                anew.

        Raises:
            InputError: A file was changed or damaged.
            FileNotFoundError: The folder has no ``STATE.ron``, or a file that it names is not there.
        """
        source = Path(folder)
        tails = []
        damaged = []
        for tail, begun, named in _native.Adapted.state(read_text(source / "STATE.ron")):
            try:
                stored = _stored_files(source, begun, named)
                if not strict:
                    _native.Adapted.stored([stored])
                tails.append(stored)
            except (InputError, OSError) as error:
                if strict:
                    raise
                damaged.append(f"tail {tail} is left out: {error}")
        warn(damaged)
        return cls(_native.Adapted.stored(tails))

    @classmethod
    def stored(cls, tails: Sequence[tuple[Model, bytes, bytes, str]]) -> Adaptation:
        """An adaptation to be continued, from what it gave for each tail: model, :meth:`segments_csv`, :meth:`flights_csv`
        and :meth:`begun`."""
        return cls(
            _native.Adapted.stored(
                [(model._native, segments, flights, begun) for model, segments, flights, begun in tails]
            )
        )

    def monitor(
        self,
        *,
        events: bytes | str | os.PathLike[str] | None = None,
        alert: Sequence[str] = (),
        co2_kg_per_kg: float | None = None,
        fuel_price_per_kg: float | None = None,
        flights_per_year: float | None = None,
        basic_performance_factor_percent: float | None = None,
        quick: bool = False,
        since: str | datetime.date | None = None,
        threads: int | None = None,
    ) -> Monitoring:
        """What changed on these tails, when and by how much: ``cruisefit monitor``.

        Args:
            events: Events to measure (CSV: ``date,tail,kind,note``), a path or bytes.
            alert: Rules: ``deviation=PCT`` (present level), ``trend=PCT`` (per year), ``change=PCT`` or ``change=PCT/DAYSd``.
            co2_kg_per_kg: kg of CO₂ from a kg of fuel.
            fuel_price_per_kg: Price of a kg of fuel, in any currency.
            flights_per_year: Flights a year; as many as were recorded without it.
            basic_performance_factor_percent: Basic factor of the flight management system, in per cent.
            quick: Leave out the deviation by the model before it learnt each flight.
            since: Only flights that began on or after this date (``2026-03-02``, or an instant with its offset; also as a date or
                an instant of ``datetime``).
            threads: Threads to use; all processors without it.

        Raises:
            InputError: A rule or events that are none, with their line; a factor that is not a finite number above 0 (the basic
                factor: not finite).

        Warns:
            DataWarning: A tail has nothing to monitor, cannot be monitored, or has events but no flight.
        """
        asked: dict[str, object] = {
            "events": events if events is None or isinstance(events, bytes) else Path(events).read_bytes(),
            "rules": names_of(alert),
            "co2_kg_per_kg": co2_kg_per_kg,
            "fuel_price": fuel_price_per_kg,
            "flights_per_year": flights_per_year,
            "basic_performance_factor_percent": basic_performance_factor_percent,
            "quick": quick,
            "since": since.isoformat() if isinstance(since, datetime.date) else since,
            "threads": threads,
        }
        return Monitoring(_native.monitor_tails(self._native, asked))

    def __reduce__(self) -> tuple[Any, ...]:
        tails = [
            (self.model(tail), self.segments_csv(tail), self.flights_csv(tail), self.begun(tail))
            for tail in self.tails
        ]
        return Adaptation.stored, (tails,)


class Monitoring:
    """Deviations, changes, events, fuel factors and costs of tails over months. In a notebook it shows its page."""

    def __init__(self, native: _native.Monitored) -> None:
        self._native = native

    def to_dict(self) -> dict[str, Any]:
        """``monitor.json``."""
        document: dict[str, Any] = json.loads(self._native.json())
        return document

    def to_json(self) -> bytes:
        """The bytes of ``monitor.json``."""
        return self._native.json()

    def table(self, name: str, library: object = None) -> Table:
        """One of the tables ``tails``, ``months``, ``flights``, ``changes``, ``events``, ``fleet``, ``alerts``.

        Raises:
            KeyError: There is no such table.
        """
        return like(dict(self._native.tables())[name], library)

    def page(self) -> str:
        """``monitor.html``."""
        return self._native.page()

    def plot(self, tails: str | Sequence[str] = ()) -> Chart:
        """Deviations over time: ``cruisefit plot monitor.json``.

        Args:
            tails: Tails to draw; all without any.

        Raises:
            InputError: There are no such tails.
        """
        return Chart(self._native.plot(names_of(tails)))

    def _repr_html_(self) -> str:
        return framed(self.page())

    def __repr__(self) -> str:
        names = ("tail", "flight", "change")
        counts = zip(self._native.counts(), names, strict=True)
        return f"<Monitoring: {', '.join(f'{n} {name}' + 's' * (n != 1) for n, name in counts)}>"


class Evaluation(_Run):
    """The fuel-flow error of models over flights."""

    _title = _TITLE_OF_EVALUATION


def adapt(
    segments: Segments,
    models: Model | Sequence[Model],
    *,
    begun: Adaptation | None = None,
    law: Law = "bayes",
    threshold_percent: float | None = None,
    remainder: bool = True,
    older_flights: bool = True,
    relearn: bool = False,
    accept: bool = False,
    threads: int | None = None,
) -> Adaptation:
    """Adapts models to flights until predicted fuel flow is recorded fuel flow: one adapted model per tail.

    Args:
        segments: Flights, of any tails and in any order; they are learnt in the order of flying.
        models: Model, or several to choose from. A flight takes the model of its tail, otherwise the one of its type. A model starts from
            its initial part and the effects applied to it.
        begun: What the tails have learnt before. A flight that is known there changes nothing; one known with other content
            is refused.
        law: ``bayes`` or ``paper``.
        threshold_percent: Law ``paper``: adapt where the error exceeds this, in per cent; the model's without it.
        remainder: Law ``bayes``: also learn what no table can hold (smooth remainder, N2 deck, noise).
        older_flights: Learn flights older than the newest known one, with a note; otherwise they are refused.
        relearn: Learn a flight that contradicts a known one in its place: its tail is learnt anew from its segments.
        accept: Also learn tails that are more than 15 % off the book, which are refused otherwise.
        threads: Threads to use; all processors without it. Tails are learnt in parallel.

    Returns:
        Adapted models, segments, summary, page; and what was refused. Serious findings in the data are
        :attr:`Adaptation.findings`, and a :class:`DataWarning` says that there are some.

    Raises:
        InputError: Two models claim the same tail or type, or ``begun`` was started with another model, law or setting.
    """
    if threshold_percent is not None and not threshold_percent >= 0:
        raise InputError(f"threshold_percent: found {threshold_percent}, expected 0 or more")
    options: dict[str, object] = {
        "law": law,
        "threshold_percent": threshold_percent,
        "remainder": "learn" if remainder else "leave",
        "older": "learn" if older_flights else "refuse",
        "contradictions": "relearn" if relearn else "refuse",
        "absurd": "accept" if accept else "refuse",
        "threads": threads,
    }
    adapted = Adaptation(
        _native.adapt(
            natives_of(models),
            flights_of(segments),
            options,
            begun_of(begun),
        )
    )
    warn_of_findings(adapted.findings)
    warn_of_new(segments, adapted.refused, len(adapted.tails))
    return adapted


def _stored_files(
    folder: Path, begun: str, named: Sequence[tuple[str, str]]
) -> tuple[_native.Model, bytes, bytes, str]:
    """Model, segments and flights of a tail, by their names and SHA-256, and what it was begun with.

    Raises:
        InputError: A file was changed or damaged.
        OSError: One cannot be read.
    """
    contents = []
    for name, sha256 in named:
        content = (folder / name).read_bytes()
        if hashlib.sha256(content).hexdigest() != sha256:
            message = "its SHA-256 is not that of STATE.ron: it was changed or damaged"
            raise InputError(message, file=str(folder / name))
        contents.append(content)
    model, segments, flights = contents
    return _native.Model.from_text(model.decode(), folder / named[0][0]), segments, flights, begun


def added(parts: Sequence[Adaptation], summaries: Sequence[bytes]) -> Adaptation:
    """What the parts of tails have learnt by law ``bayes`` without a remainder, as one adaptation that can be continued.

    Args:
        parts: One for each part of the flights, of which none has a flight of another.
        summaries: ``summary.json`` of the call that learnt each part, and of calls that learnt nothing of theirs: what became of
            the reports of all.

    Raises:
        InputError: Parts of another initial model or setting, or a flight that two have learnt.
    """
    return Adaptation(_native.added([part._native for part in parts], summaries))


def begun_of(begun: Adaptation | None) -> _native.Adapted | None:
    """What is continued, as the native half takes it.

    Raises:
        InputError: Something else.
    """
    if begun is None:
        return None
    expected(begun, Adaptation, "Adaptation.read reads a folder")
    return begun._native


def warn_of_new(segments: Segments, refused: Sequence[Refused], left: int) -> None:
    """Warns of what was refused beside what :func:`cruisefit.segment` has warned of."""
    known = set(segments.refused)
    warn_of_refused([one for one in refused if one not in known], left)


def warn_of_findings(findings: str) -> None:
    """Warns of serious findings in the data."""
    if findings:
        warn([findings.strip()])


def evaluate(
    segments: Segments,
    models: Model | Sequence[Model],
    *,
    table_only: bool = False,
    threads: int | None = None,
) -> Evaluation:
    """The fuel-flow error of models as they are over flights: 100 (recorded − predicted)/recorded, in per cent; positive, the
    aircraft burns more than the model predicts. Nothing is adapted.

    Args:
        segments: Flights of any tails.
        models: Model, or several to choose from, as for :func:`adapt`.
        table_only: By the drag table alone, without what else the models have learnt.
        threads: Threads to use; all processors without it.

    Raises:
        InputError: Two models claim the same tail or type.
    """
    predicts = "table" if table_only else "whole"
    evaluation = Evaluation(
        _native.evaluate(natives_of(models), flights_of(segments), predicts, threads)
    )
    warn_of_new(segments, evaluation.refused, len(evaluation.tails))
    return evaluation


def merge(models: Sequence[Model]) -> Model:
    """Adds what models of one initial model have learnt by law ``bayes`` (the remainder, which is learnt from segments, is left
    out).

    Raises:
        InputError: Models of another initial model, law or setting, or a flight that two have learnt.
    """
    return Model(_native.merge(natives_of(models)))
