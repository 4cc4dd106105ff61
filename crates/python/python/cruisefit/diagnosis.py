"""Diagnoses: where models differ from flights, which effect they lack, how far the gap shrinks."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, TypeVar

from . import _native
from ._pages import Chart, DiagnosisChart, framed, names_of, read_text
from .adaptation import warn_of_findings, warn_of_new
from .errors import in_python
from .model import Model, natives_of
from .segments import Refused, Segments, flights_of, refused_of

__all__ = [
    "Cause",
    "Diagnosis",
    "Gap",
    "Magnitude",
    "Slice",
    "TailDiagnosis",
    "Verdict",
    "diagnose",
    "effects",
    "explain",
    "plot_trials",
]

Interval = tuple[float, float]
_T = TypeVar("_T")


@dataclass(frozen=True)
class Gap:
    """The gap, ln recorded − ln predicted fuel flow, in per cent, before anything is added to the model. Of insufficient data
    no gap is computed: its numbers are ``None``.

    Attributes:
        mean_percent: Mean.
        rms_percent: Root mean square.
        rms_ci95: 95 % interval of the root mean square, by flight.
        noise_floor_rms_percent: Root mean square that noise alone produces.
        detected: Whether there is more than noise.
        p_value: Probability of as large a deviation without any effect.
    """

    mean_percent: float | None
    rms_percent: float | None
    rms_ci95: Interval | None
    noise_floor_rms_percent: float | None
    detected: bool
    p_value: float | None


@dataclass(frozen=True)
class Slice:
    """A region in which the gap lies: its mean gap in per cent with 95 % interval, its share of the gap, its p-value (which
    accounts for the search)."""

    slice: str
    bounds: dict[str, tuple[float | None, float | None]]
    segments: int
    mean_gap_percent: float
    ci95: Interval
    share_of_gap: float
    p_value: float


@dataclass(frozen=True)
class Magnitude:
    """The size of an effect in its unit, with 95 % interval."""

    value: float
    unit: str
    ci95: Interval


@dataclass(frozen=True)
class Cause:
    """An effect that the model may lack.

    Attributes:
        effect: Name in the library (:func:`effects`).
        probability: Probability that it is the larger one of what acts.
        magnitude: Its size.
        effect_class: Effects that these flights cannot distinguish from it, itself first.
        rms_after_percent: Root mean square of the gap with it in the model, on flights to which it was not fitted.
        closure: Share of the explainable gap that it closes on those flights.
        closure_ci95: 95 % interval of the closure.
        since: The instant from which it holds, as ``2019-06-01T00:00:00Z``: of a step its date, of a history that of its last
            fall, or of its beginning where it has none; none for what has no date.
        level: With ``fleet=True`` whose it is, were it this effect: ``type``, ``tail`` or ``sensor``; none where the fleet has
            no finding whose class it belongs to.
    """

    effect: str
    probability: float
    magnitude: Magnitude
    effect_class: list[str] = field(default_factory=list)
    rms_after_percent: float | None = None
    closure: float | None = None
    closure_ci95: Interval | None = None
    since: str | None = None
    level: str | None = None


@dataclass(frozen=True)
class Contribution:
    """What one effect makes of the gap, all effects of the library acting at once.

    Attributes:
        effect: Its name.
        magnitude: Its size.
        rms_percent: Root mean square of the change of fuel flow that it makes, %.
        rms_ci95: 95 % interval of that.
        leads: Probability that it makes the largest change of all.
    """

    effect: str
    magnitude: Magnitude
    rms_percent: float
    rms_ci95: Interval
    leads: float


@dataclass(frozen=True)
class MonthGap:
    """The gap in one calendar month, UTC.

    Attributes:
        month: Year and month, as ``2026-03``.
        flights: Flights that were used.
        segments: Segments that were used.
        mean_gap_percent: Mean gap, %.
        ci95: 95 % interval by flight; none for a single flight.
        after_percent: Mean gap with the named effects in the model, %; none where nothing is named.
        after_ci95: 95 % interval of that.
    """

    month: str
    flights: int
    segments: int
    mean_gap_percent: float
    ci95: Interval | None = None
    after_percent: float | None = None
    after_ci95: Interval | None = None


@dataclass(frozen=True)
class Verdict:
    """The conclusion.

    Attributes:
        kind: ``no_gap``, ``effects``, ``outside_library`` or ``insufficient_data``.
        effects: Effects that act.
        effect_class: Effects that these flights cannot distinguish from the first.
        probability: Probability of the first effect.
        closure: Share of the explainable gap closed on unseen flights; none where the gap is too small.
        closure_ci95: Its 95 % interval.
        advice: What to do, in a sentence or two.
    """

    kind: str
    effects: list[str]
    advice: str
    effect_class: list[str] = field(default_factory=list)
    probability: float = 0.0
    closure: float | None = None
    closure_ci95: Interval | None = None


@dataclass(frozen=True)
class TailDiagnosis:
    """One tail's diagnosis (tail ``*``: a pool of all tails).

    Attributes:
        causes: The most probable first.
        months: The gap in each calendar month, the newest last.
        where: Regions in which the gap lies, the clearest first.
        contributions: What each effect makes of the gap, all of them at once, the likeliest largest one first; empty where no
            gap is detected.
        not_testable: Effects that these data cannot test, and what each needs.
        lines: The diagnosis in plain words.
        record: Its part of ``diagnosis.json``, with all that the attributes leave out.
    """

    tail: str
    flights: int
    segments: int
    gap: Gap
    months: list[MonthGap]
    where: list[Slice]
    causes: list[Cause]
    contributions: list[Contribution]
    not_testable: dict[str, list[str]]
    verdict: Verdict
    lines: list[str]
    record: dict[str, Any] = field(repr=False)


class Diagnosis:
    """Diagnoses of one or several tails. In a notebook it shows the page of ``cruisefit diagnose``."""

    def __init__(self, native: _native.Diagnosed) -> None:
        self._native = native
        self._document: dict[str, Any] = json.loads(native.json())
        records = self._document["diagnoses"]
        self._diagnoses = [
            _tail_diagnosis(record, lines)
            for record, (_, lines) in zip(records, native.lines(), strict=True)
        ]

    @property
    def diagnoses(self) -> list[TailDiagnosis]:
        """One diagnosis per tail, in the order of the tails."""
        return list(self._diagnoses)

    def __getitem__(self, tail: str) -> TailDiagnosis:
        for diagnosis in self._diagnoses:
            if diagnosis.tail == tail:
                return diagnosis
        raise KeyError(tail)

    def __len__(self) -> int:
        return len(self._diagnoses)

    @property
    def fleets(self) -> list[dict[str, Any]]:
        """With ``fleet=True`` all tails of a type compared: what was found of the type, of single tails and of their sensors
        (``findings``), and the sizes of all effects of type and tails."""
        fleets: list[dict[str, Any]] = self._document.get("fleets", [])
        return fleets

    @property
    def refused(self) -> list[Refused]:
        """Reports that were refused, among them flights that the model has learnt."""
        refused = self._document["reports"]["refused"]
        return refused_of((one["path"], one["line"], one["column"], one["reason"]) for one in refused)

    @property
    def findings(self) -> str:
        """Serious findings in the data, in words; empty where there are none. :func:`cruisefit.check` lists all."""
        return in_python(self._native.findings())

    def to_dict(self) -> dict[str, Any]:
        """``diagnosis.json``."""
        document: dict[str, Any] = json.loads(self._native.json())
        return document

    def to_json(self) -> str:
        """The text of ``diagnosis.json``."""
        return self._native.json()

    def page(self) -> str:
        """``diagnosis.html``."""
        return self._native.page()

    def plot(
        self, charts: DiagnosisChart | Sequence[DiagnosisChart] = (), *, tails: str | Sequence[str] = ()
    ) -> Chart:
        """From the gap to the noise, and where the gap is: ``cruisefit plot diagnosis.json``.

        Args:
            charts: ``waterfall``, ``gap-map``; both without any.
            tails: Tails to draw; all without any.

        Raises:
            InputError: There are no such charts or tails.
        """
        return Chart(self._native.plot(names_of(tails), names_of(charts)))

    def _repr_html_(self) -> str:
        return framed(self.page())

    def __repr__(self) -> str:
        texts = ["\n  ".join(one.lines) for one in self._diagnoses] + self._native.fleet_texts()
        return "\n\n".join(texts)


def diagnose(
    segments: Segments,
    models: Model | Sequence[Model],
    *,
    effects: Sequence[str] = (),
    without: Sequence[str] = (),
    pool: bool = False,
    fleet: bool = False,
    table_only: bool = False,
    allow_learnt: bool = False,
    accept: bool = False,
    events: bytes | str | os.PathLike[str] | None = None,
    threads: int | None = None,
) -> Diagnosis:
    """Compares models with flights that they have not learnt: where is a gap, which effect is lacking, how far does the gap
    shrink on flights to which that effect was not fitted?

    Args:
        segments: Flights, of any tails.
        models: Model, or several to choose from. A flight takes the model of its tail, otherwise the one of its type.
        effects: Look for these effects only (names: :func:`effects`).
        without: Leave these effects out.
        pool: One diagnosis for all tails of a type together.
        fleet: Also compare all tails of a type: what all share, what one tail has, what its sensors have.
        table_only: Count as gap what the model has learnt beyond its drag table.
        allow_learnt: Also diagnose flights that the model has learnt, whose gap it hides.
        accept: Also diagnose tails that are more than 15 % off the book, which are refused otherwise.
        events: What was done to which tail and when (CSV: ``date,tail,kind,note``), a path or bytes: steps and histories try
            these dates too.
        threads: Threads to use; all processors without it. Tails are diagnosed in parallel.

    Raises:
        InputError: An effect that the library does not have, or two models that claim the same tail or type.
    """
    asked: dict[str, object] = {
        "effects": names_of(effects),
        "without": names_of(without),
        "pool": pool,
        "fleet": fleet,
        "table_only": table_only,
        "allow_learnt": allow_learnt,
        "events": events if events is None or isinstance(events, bytes) else Path(events).read_bytes(),
        "absurd": "accept" if accept else "refuse",
        "threads": threads,
    }
    diagnosis = Diagnosis(_native.diagnose(natives_of(models), flights_of(segments), asked))
    warn_of_findings(diagnosis.findings)
    warn_of_new(segments, diagnosis.refused, len(diagnosis))
    return diagnosis


def effects(engines: int = 2) -> list[tuple[str, str, str]]:
    """The library of effects of an aircraft with so many engines: name, unit, what it changes.

    Args:
        engines: Number of engines, 1 to 4.

    Raises:
        InputError: Another number of engines.
    """
    return _native.effects(engines)


class Explanation(str):
    """A text that a notebook shows as it is."""

    __slots__ = ()

    def __repr__(self) -> str:
        return str(self)


def explain(topic: str | None = None) -> Explanation:
    """What a topic is: an effect (``tsfc_engine_2``), a column of a report (``FQ``), trim criteria or a verdict
    (``outside_library``): what ``cruisefit explain`` prints.

    Args:
        topic: Name of the topic; the names of all without one.

    Raises:
        InputError: There is no such topic; the nearest one is named.
    """
    text = _native.explain(topic)
    return Explanation(text.replace("cruisefit explain TOPIC", "cruisefit.explain(TOPIC)", 1))


def plot_trials(path: str | os.PathLike[str]) -> Chart:
    """What was planted against what was found, a matrix for each group of blind trials: ``cruisefit plot trials.json``.

    Args:
        path: ``trials.json`` of ``cruisefit trial``.

    Raises:
        InputError: It is no such file.
    """
    return Chart(_native.plot_trials(read_text(path)))


def _tail_diagnosis(record: dict[str, Any], lines: list[str]) -> TailDiagnosis:
    return TailDiagnosis(
        tail=record["tail"],
        flights=record["flights"],
        segments=record["segments"],
        gap=_read(Gap, record["gap"]),
        months=[_read(MonthGap, one) for one in record.get("months", [])],
        where=[_read(Slice, one) for one in record["where"]],
        causes=[_cause(one) for one in record["causes"]],
        contributions=[_contribution(one) for one in record.get("contributions", [])],
        not_testable={one["effect"]: one["needs"] for one in record["not_testable"]},
        verdict=_read(Verdict, _with_class(record["verdict"])),
        lines=lines,
        record=record,
    )


def _cause(record: dict[str, Any]) -> Cause:
    return _read(Cause, {**_with_class(record), "magnitude": _read(Magnitude, record["magnitude"])})


def _contribution(record: dict[str, Any]) -> Contribution:
    return _read(Contribution, {**record, "magnitude": _read(Magnitude, record["magnitude"])})


def _with_class(record: dict[str, Any]) -> dict[str, Any]:
    """``class`` is a word of the language."""
    return {**record, "effect_class": record.get("class", [])}


def _read(kind: type[_T], record: dict[str, Any]) -> _T:
    """A record as a data class: pairs as tuples; fields that the class does not have stay in the record."""
    names = {one.name for one in fields(kind)}  # type: ignore[arg-type]
    pairs = {"rms_ci95", "ci95", "closure_ci95", "after_ci95"}
    values: dict[str, Any] = {name: value for name, value in record.items() if name in names}
    for name in pairs & values.keys():
        if values[name] is not None:
            values[name] = tuple(values[name])
    if "bounds" in values:
        values["bounds"] = {name: tuple(pair) for name, pair in values["bounds"].items()}
    return kind(**values)
