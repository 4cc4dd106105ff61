"""A performance model of an aircraft, with what it has learnt."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from . import _native
from ._pages import Chart, TailChart, names_of, read_text, write_bytes
from ._tables import Table, as_points, is_frame, like, with_prediction
from .errors import InputError, PredictionWarning, expected, warn
from .segments import Segments

if TYPE_CHECKING:
    from .adaptation import Adaptation, Evaluation, Law
    from .diagnosis import Diagnosis

__all__ = ["Model", "types"]


class Model:
    """A performance model: aircraft, drag table over lift coefficient and Mach number, and what was learnt.

    Made by :meth:`load`, :meth:`initial` or by an adaptation. It does not change; adapting makes another one.
    """

    def __init__(self, native: _native.Model) -> None:
        self._native = native

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Model:
        """A model from a file ``MODEL.ron``.

        Raises:
            InputError: The file is no model, is of a newer format, or was damaged (its checksum does not match).
        """
        return cls(_native.Model.from_text(read_text(path), path))

    @classmethod
    def from_text(cls, text: str, name: str = "model") -> Model:
        """A model from the text of its file; ``name`` is what messages call it."""
        return cls(_native.Model.from_text(text, name))

    @classmethod
    def initial(
        cls, aircraft: str | os.PathLike[str], guide: str | os.PathLike[str]
    ) -> Model:
        """The initial model of an aircraft from its flight-planning guide.

        Args:
            aircraft: Path of the aircraft file (RON).
            guide: Path of the guide (CSV: ``weight_lb`` or ``mass_kg``, ``pressure_altitude_ft``, ``true_airspeed_kt``,
                ``fuel_flow_lb_h`` or ``fuel_flow_kg_h`` of all engines, optionally ``isa_deviation_c``).

        Raises:
            InputError: A file is not what it should be, with line and column; or the guide does not determine the drag
                polynomial.
        """
        native, findings = _native.Model.initial(
            (os.fspath(aircraft), read_text(aircraft)), (os.fspath(guide), read_text(guide))
        )
        warn(findings)
        return cls(native)

    @classmethod
    def of_type(cls, type_code: str) -> Model:
        """The initial model of a type from the public model of Poll and Schumann, where there is no guide: what
        ``cruisefit guide`` and ``cruisefit init`` make. Its authors expect fuel burn within 5 % in the majority of cases.

        Args:
            type_code: One of :func:`types`, or a type code that it also stands for: ``A320``, ``B738``, …

        Raises:
            InputError: A type without a public model.
        """
        aircraft, guide = _native.public_guide(type_code)
        native, findings = _native.Model.initial(("AIRCRAFT.ron", aircraft), ("guide.csv", guide))
        warn(findings)
        return cls(native)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the model file, whole or not at all: the bytes that the command line writes."""
        write_bytes(path, self.to_text().encode())

    def to_text(self) -> str:
        """The text of the model file."""
        return self._native.to_text()

    def predict(
        self,
        points: Table,
        *,
        table_only: bool = False,
        deviations: bool = True,
        columns: Sequence[str] | None = None,
        strict: bool = False,
        threads: int | None = None,
    ) -> Table:
        """Fuel flow and specific range at flight points: level flight without acceleration.

        Args:
            points: A table with the columns ``weight_lb`` or ``mass_kg``; ``pressure_altitude_ft`` or ``flight_level``;
                ``mach``; optionally ``isa_deviation_c`` (otherwise the ISA), ``fuel_flow_lb_h`` or ``fuel_flow_kg_h``
                (measured, all engines), ``date``, ``cg_percent_mac``, ``anti_ice``, ``latitude_deg``, ``true_heading_deg``.
                Columns whose names begin with ``X-`` have no meaning; any other name is refused.
            table_only: Predict with the drag table alone, without what else the model has learnt.
            deviations: State standard deviations. They take most of the time of a learnt model: without them millions of points
                are predicted several times as fast, and ``fuel_flow_std_kg_s`` is null.
            columns: Columns of the prediction that are wanted, in any order; all without it. What nobody wants is not computed:
                ``columns=["fuel_flow_kg_s"]`` takes half the time of ``deviations=False``.
            strict: Refuse points without a prediction, rather than warn of them.
            threads: Threads to use; all processors without it.

        Returns:
            The same rows and columns (of the same types, not copied; a frame of pandas is copied and keeps its index) and
            ``fuel_flow_kg_s`` (all engines), ``fuel_flow_std_kg_s`` (null by law
            ``paper``), ``specific_range_m_kg``, ``lift_coefficient``, ``drag_coefficient``, ``extrapolated`` (1 outside the
            guide's range), where measured fuel flow is a column ``error_percent`` = 100 (measured − predicted)/measured, and
            where more than the table was learnt ``remainder_percent`` and ``beyond_flights`` (1 beyond what was flown). Columns
            of these names in the table are left out: they are of another prediction. Results are null
            where the point is outside the model's table or lacks a value that it needs (null or NaN), and a
            :class:`PredictionWarning` says how many are.

        Raises:
            InputError: A column is missing or unknown, or a value is outside its limits, with row and column; or ``columns`` has a
                name that no column of predictions has.
        """
        adds_columns = is_frame(points)
        stated = (deviations, None if columns is None else names_of(columns), not adds_columns)
        table, without, first = self._native.predict(
            as_points(points), "table" if table_only else "whole", stated, threads
        )
        if first is not None:
            row, reason = first
            message = f"{without} points have no prediction; the first is row {row}: {reason}"
            if strict:
                raise InputError(message, line=row)
            warnings.warn(message, PredictionWarning, stacklevel=2)
        return with_prediction(points, table) if adds_columns else like(table, points)

    def adapt(
        self,
        segments: Segments,
        *,
        law: Law = "bayes",
        threshold_percent: float | None = None,
        remainder: bool = True,
        older_flights: bool = True,
        accept: bool = False,
        threads: int | None = None,
    ) -> Adaptation:
        """Adapts the model's initial part to flights: one adapted model per tail. See :func:`cruisefit.adapt`."""
        from .adaptation import adapt

        return adapt(
            segments,
            [self],
            law=law,
            threshold_percent=threshold_percent,
            remainder=remainder,
            older_flights=older_flights,
            accept=accept,
            threads=threads,
        )

    def evaluate(
        self, segments: Segments, *, table_only: bool = False, threads: int | None = None
    ) -> Evaluation:
        """The fuel-flow error of the model as it is over flights; nothing is adapted. See :func:`cruisefit.evaluate`."""
        from .adaptation import evaluate

        return evaluate(segments, [self], table_only=table_only, threads=threads)

    def diagnose(
        self,
        segments: Segments,
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
        """Where the model differs from flights and which effect it lacks. See :func:`cruisefit.diagnose`."""
        from .diagnosis import diagnose

        return diagnose(
            segments,
            [self],
            effects=effects,
            without=without,
            pool=pool,
            fleet=fleet,
            table_only=table_only,
            allow_learnt=allow_learnt,
            accept=accept,
            events=events,
            threads=threads,
        )

    def table(self, library: object = None) -> Table:
        """The drag table, one row per node: lift coefficient, Mach number, drag coefficient, confidence (how much was learnt
        there), drag coefficient of the initial model, extrapolated (1 outside the guide's range)."""
        return like(self._native.table(), library)

    def polynomial(self, library: object = None) -> Table:
        """The six-coefficient polynomial nearest to the drag table, with its covariance by law ``bayes``."""
        return like(self._native.polynomial(), library)

    def plot(self, charts: TailChart | Sequence[TailChart] = ()) -> Chart:
        """The model's charts: ``cruisefit plot MODEL.ron``.

        Args:
            charts: Names of the charts to draw (``polar``, ``surface``, ``relief``); all that there are without any.

        Raises:
            InputError: There is no such chart, or nothing is left to draw: a model alone has no errors.
        """
        return Chart(self._native.plot(names_of(charts)))

    @property
    def name(self) -> str:
        """What messages call the model: its path, or its tail."""
        return self._native.name

    @property
    def tail(self) -> str | None:
        """The tail whose flights it has learnt; none for an initial model."""
        return self._native.tail

    @property
    def aircraft_name(self) -> str:
        """Name of the aircraft."""
        return self._native.aircraft_name

    @property
    def aircraft_type(self) -> str:
        """Type code of the aircraft, as in the header of its reports."""
        return self._native.aircraft_type

    @property
    def engines(self) -> int:
        """Number of engines."""
        return self._native.engines

    @property
    def law(self) -> str | None:
        """Law by which it has learnt (``bayes``, ``paper``); none for an initial model."""
        return self._native.law

    @property
    def flights_learnt(self) -> int:
        """Number of flights that it has learnt."""
        return self._native.flights

    def __repr__(self) -> str:
        learnt = (
            f"{self.flights_learnt} flights of {self.tail} learnt by law {self.law}, "
            f"{100 * self._native.informed_nodes:.0f} % of the nodes informed"
            if self.law
            else "initial"
        )
        applied = f", {self._native.applied}" if self._native.applied else ""
        return f"<Model {self.aircraft_name} ({self.aircraft_type}): {learnt}{applied}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickled, (self.to_text(), self.name)


def natives_of(models: Model | Sequence[Model]) -> list[_native.Model]:
    """One model or several, as the native half takes them.

    Raises:
        InputError: Something else, or none.
    """
    several = [models] if isinstance(models, Model) else models
    if isinstance(several, (str, bytes, os.PathLike)) or not isinstance(several, Iterable):
        expected(several, Model, "Model.load reads the file of one")
    several = list(several)
    for one in several:
        expected(one, Model, "Model.load reads the file of one")
    if not several:
        raise InputError("models: found none, expected one or more")
    return [one._native for one in several]


def _unpickled(text: str, name: str) -> Model:
    return Model.from_text(text, name)


def types() -> list[tuple[str, str, list[str]]]:
    """The types with a public model (:meth:`Model.of_type`): type code, name, type codes that it also stands for."""
    return _native.public_types()
