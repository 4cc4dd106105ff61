"""Fleets on Spark: the chain over DataFrames, grouped by tail.

Reports are rows of a DataFrame with a binary column (:func:`flights`), recordings rows of samples (:func:`recordings`). Reading is spread over reports, learning and diagnosing over tails: after
reading, a flight has shrunk to its segments (some kilobytes), so a year of one tail fits a task whatever its reports' size, and
a tail with many flights costs no more reading than others. A report that cannot be read costs its row: it comes back with its
reason. Results are columns of text and numbers that Parquet and Delta hold, the same to the bit as on one machine.

>>> flights = cruisefit.spark.flights(reports)                 # doctest: +SKIP
>>> adapted = cruisefit.spark.adapt(flights, [model])          # doctest: +SKIP
>>> adapted.write.parquet("adapted")                           # doctest: +SKIP
>>> later = cruisefit.spark.flights(later_reports)             # doctest: +SKIP
>>> cruisefit.spark.diagnose(later, adapted)                   # doctest: +SKIP

Needs ``pip install cruisefit[spark]`` (PySpark 4 or later) on the driver and on the workers.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import pyarrow as pa
from pyspark.sql import functions as F
from pyspark.sql.pandas.types import from_arrow_schema

from . import _native, adaptation, diagnosis
from ._columnar import opened
from ._pages import read_text
from .errors import InputError
from .model import Model
from .segments import PRESETS, Segments, refused_of, segment as read_segments

if TYPE_CHECKING:
    from pyspark.sql import DataFrame

    from .adaptation import Law

__all__ = ["adapt", "diagnose", "evaluate", "fleet", "flights", "monitor", "recordings", "refused", "segment"]

_FLIGHT = [
    ("path", pa.string()),
    ("tail", pa.string()),
    ("flight", pa.string()),
    ("start", pa.string()),
    ("aircraft_type", pa.string()),
    ("engines", pa.float64()),
    ("samples", pa.int64()),
    ("segments", pa.int64()),
    ("end", pa.string()),
    ("content", pa.string()),
    ("content_of_file", pa.string()),
    ("gauged_kg", pa.float64()),
    ("metered_kg", pa.float64()),
    ("gauged_std_kg", pa.float64()),
    ("notes", pa.string()),
    ("segments_csv", pa.string()),
]
_REFUSAL = [
    ("refused", pa.string()),
    ("refused_line", pa.int64()),
    ("refused_column", pa.int64()),
]
_FLIGHTS = pa.schema([*_FLIGHT, ("criteria", pa.string()), *_REFUSAL])

_ADAPTED = pa.schema(
    [
        ("tail", pa.string()),
        ("flights", pa.int64()),
        ("flights_new", pa.int64()),
        ("model", pa.string()),
        ("segments_csv", pa.string()),
        ("flights_csv", pa.string()),
        ("begun", pa.string()),
        ("summary", pa.string()),
        ("error", pa.string()),
    ]
)
_EVALUATED = pa.schema([("tail", pa.string()), ("summary", pa.string()), ("error", pa.string())])
_MONITORED = pa.schema(
    [("tail", pa.string()), ("monitor", pa.string()), ("alerts", pa.int64()), ("error", pa.string())]
)
_DIAGNOSED = pa.schema(
    [
        ("tail", pa.string()),
        ("flights", pa.int64()),
        ("segments", pa.int64()),
        ("verdict", pa.string()),
        ("effects", pa.string()),
        ("probability", pa.float64()),
        ("gap_rms_percent", pa.float64()),
        ("closure", pa.float64()),
        ("diagnosis", pa.string()),
        ("error", pa.string()),
    ]
)
_ENGINES = 4
_PER_ENGINE = ("fuel_flow_{}_kg_s", "n2_{}_percent", "n1_{}_percent", "exhaust_gas_temperature_{}_k")


def flights(
    reports: DataFrame,
    *,
    report: str = "report",
    path: str | None = None,
    mapping: str | os.PathLike[str] | None = None,
    criteria: str = PRESETS[0],
) -> DataFrame:
    """Reads reports: one row per flight, or per report that was refused. Flights are not compared here: of copies and of
    reports that contradict each other all are rows, which :func:`segment`, :func:`adapt` and the others use once.

    Args:
        reports: A row per report.
        report: Name of the binary column that holds a report, plain or gzip.
        path: Name of a column that says what a report is called; without it, or where it is null, it is called by the hash of
            its bytes. Two reports of one flight are told apart by it.
        mapping: Mapping file on the driver, or name of a preset, for recordings of another layout.
        criteria: Trim criteria, one of :data:`cruisefit.PRESETS`.

    Returns:
        Columns ``path``, ``tail``, ``flight``, ``start``, ``aircraft_type``, ``engines``, ``samples``, ``segments`` (number),
        ``end``, ``content`` and ``content_of_file`` (SHA-256), ``gauged_kg``, ``metered_kg``, ``gauged_std_kg``, ``notes``, ``segments_csv``, ``criteria``; and of
        a refused report ``refused`` (the reason), ``refused_line``, ``refused_column``, the others null.
    """
    rule = _mapping_text(mapping)
    name = F.concat(F.lit("sha256:"), F.sha2(F.col(report), 256))
    if path:
        name = F.coalesce(F.col(path).cast("string"), name)
    rows = reports.select(name.alias("path"), F.col(report).alias("report"))

    def read(batches: Iterator[pa.RecordBatch]) -> Iterator[pa.RecordBatch]:
        for batch in batches:
            paths = batch.column(0).to_pylist()
            contents = batch.column(1).to_pylist()
            yield from _read_batch(paths, contents, rule, criteria)

    return rows.mapInArrow(read, from_arrow_schema(_FLIGHTS))


def recordings(
    rows: DataFrame,
    *,
    flight: str | Sequence[str],
    time: str,
    mapping: str | os.PathLike[str],
    criteria: str = PRESETS[0],
) -> DataFrame:
    """Reads recordings whose samples are rows: one row per flight, or per recording that was refused.

    Args:
        rows: A row per sample, in any order, with the columns that the mapping names.
        flight: The column, or columns, that say which flight a sample is of: tail and flight, for example.
        time: The column by which the samples of a flight are put in order.
        mapping: Mapping file on the driver, its text, or name of a preset.
        criteria: Trim criteria, one of :data:`cruisefit.PRESETS`.

    Returns:
        The columns of :func:`flights`; ``path`` is what ``flight`` holds, separated by slashes.
    """
    rule = _mapping_text(mapping)
    by = [flight] if isinstance(flight, str) else list(flight)

    def read(key: tuple[Any, ...], table: pa.Table) -> pa.Table:
        name = "/".join(str(one.as_py()) for one in key)
        try:
            found = read_segments(
                table.sort_by(time), mapping=rule, criteria=criteria, name=name, threads=1
            )
            return pa.Table.from_batches(_rows_of(found, [], criteria), schema=_FLIGHTS)
        except InputError as error:
            row = {"path": name, "refused": error.message, "refused_line": error.line}
            return pa.Table.from_pylist([row], schema=_FLIGHTS)

    return rows.groupBy(*by).applyInArrow(read, from_arrow_schema(_FLIGHTS))


def refused(flights: DataFrame) -> DataFrame:
    """The reports that :func:`flights` refused: ``path``, ``refused``, ``refused_line``, ``refused_column``."""
    return flights.where(F.col("refused").isNotNull()).select(
        "path", "refused", "refused_line", "refused_column"
    )


def segment(reports: DataFrame, **options: Any) -> DataFrame:
    """Stabilised segments: one row per segment, with the columns of :class:`cruisefit.Segments` for four engines; each flight is
    used once, and one that contradicts another is left out. Reports that were refused have no segment: see :func:`refused`.

    Args:
        reports: Reports, or the result of :func:`flights`.
        options: As for :func:`flights`.
    """
    read = _as_flights(reports, options)
    schema = _segments_schema()

    def rows(table: pa.Table) -> pa.Table:
        return _in_schema(_segments_of(table).table(), schema)

    # By tail, since whether a flight is used once must not depend on how rows are distributed.
    flown = read.where(F.col("refused").isNull())
    return flown.groupBy("tail").applyInArrow(rows, from_arrow_schema(schema))


def adapt(
    reports: DataFrame,
    models: Sequence[Model],
    *,
    begun: DataFrame | None = None,
    law: Law = "bayes",
    threshold_percent: float | None = None,
    remainder: bool = True,
    accept: bool = False,
    parts: int | None = None,
    **options: Any,
) -> DataFrame:
    """Adapts models to flights: one row per tail.

    Args:
        reports: Reports, or the result of :func:`flights`.
        models: Models to choose from: a flight takes that of its tail, otherwise that of its type.
        begun: The result of an earlier call: its tails go on from there, and flights that they know change nothing. A tail that
            cannot go on keeps the model that it had, with an error.
        law: ``bayes`` or ``paper``.
        threshold_percent: Law ``paper``: adapt where the error exceeds this, in per cent.
        remainder: Law ``bayes``: also learn what no table can hold.
        accept: Also learn tails that are more than 15 % off the book, which otherwise come back with an error.
        parts: Law ``bayes``: learn each tail in so many parts in parallel and add them up, for a tail with more flights than
            one task should hold. Sums in another order differ in the last digits, and no remainder is learnt: the next night
            continues with ``begun`` and ``remainder=False``.
        options: As for :func:`flights`.

    Returns:
        Columns ``tail``, ``flights`` (in the ledger), ``flights_new``, ``model`` (text of the model file), ``segments_csv``
        (all segments learnt), ``flights_csv`` (all flights learnt), ``begun`` (SHA-256 of what the tail was begun with),
        ``summary`` (JSON of ``summary.json``, refused flights among it), ``error`` (why a tail has no
        model, or only the one that it had; null otherwise).
    """
    read = _as_flights(reports, options).where(F.col("refused").isNull())
    if parts is not None:
        if begun is not None or law != "bayes":
            raise ValueError("parts: found with begun or law paper, expected law bayes from the beginning")

    def learn(before: adaptation.Adaptation | None, table: pa.Table) -> adaptation.Adaptation:
        return adaptation.adapt(
            _segments_of(table),
            models,
            begun=before,
            law=law,
            threshold_percent=threshold_percent,
            remainder=remainder and parts is None,
            accept=accept,
            threads=1,
        )

    schema = from_arrow_schema(_ADAPTED)
    if begun is None:

        def grouped(key: tuple[Any, ...], table: pa.Table) -> pa.Table:
            return _row_or_error(_ADAPTED, key[0].as_py(), lambda: _adapted_row(learn(None, table)))

        if parts is None:
            return read.groupBy("tail").applyInArrow(grouped, schema)
        part = F.pmod(F.xxhash64("start", "flight"), F.lit(parts))
        return read.groupBy("tail", part).applyInArrow(grouped, schema).groupBy("tail").applyInArrow(_added, schema)

    def continued(key: tuple[Any, ...], known: pa.Table, table: pa.Table) -> pa.Table:
        return _continued(key[0].as_py(), known, table, learn)

    return begun.groupBy("tail").cogroup(read.groupBy("tail")).applyInArrow(continued, schema)


def evaluate(reports: DataFrame, models: Model | Sequence[Model] | DataFrame, **options: Any) -> DataFrame:
    """The fuel-flow error of models as they are: one row per tail (``tail``, ``summary``, ``error``).

    Args:
        reports: Reports, or the result of :func:`flights`.
        models: Models, or the result of :func:`adapt`, whose tails then each have their own.
        options: As for :func:`flights`.
    """

    def one(table: pa.Table, own: Sequence[Model]) -> dict[str, Any]:
        result = adaptation.evaluate(_segments_of(table), own, threads=1)
        return {"summary": result.summary_json().decode()}

    return _by_tail(reports, models, _EVALUATED, one, options)


def monitor(adapted: DataFrame, **options: Any) -> DataFrame:
    """What changed on tails, when and by how much: one row per tail (``tail``, ``monitor``: JSON of ``monitor.json`` of this
    tail, ``alerts``: how many rules fired, ``error``). Each tail is looked at by itself: its level at the mean conditions of all
    tails of its type takes the others, and is null.

    Args:
        adapted: The result of :func:`adapt`.
        options: As for :meth:`cruisefit.Adaptation.monitor`; ``events`` as bytes.
    """

    def one(key: tuple[Any, ...], table: pa.Table) -> pa.Table:
        def row() -> dict[str, Any]:
            known = table.slice(0, 1).to_pylist()[0]
            if known["model"] is None:
                return {"error": known["error"]}
            found = _stored(known).monitor(**options, threads=1)
            return {"monitor": found.to_json().decode(), "alerts": len(found.to_dict()["alerts"])}

        return _row_or_error(_MONITORED, key[0].as_py(), row)

    return adapted.groupBy("tail").applyInArrow(one, from_arrow_schema(_MONITORED))


def fleet(
    reports: DataFrame, models: Sequence[Model], later: DataFrame | None = None, **options: Any
) -> DataFrame:
    """A fleet at once: reports learnt, and later ones diagnosed against what was learnt.

    Args:
        reports: Reports to learn, or the result of :func:`flights`.
        models: Models to choose from.
        later: Reports that are not learnt, to be diagnosed; without them nothing is diagnosed.
        options: As for :func:`flights`, for both.

    Returns:
        The columns of :func:`adapt`, and with ``later`` those of :func:`diagnose` but ``tail`` with the prefix ``later_``.
    """
    adapted = adapt(_as_flights(reports, options), models).localCheckpoint(eager=False)
    if later is None:
        return adapted
    found = diagnose(_as_flights(later, options), adapted)
    for name in found.columns:
        if name != "tail":
            found = found.withColumnRenamed(name, f"later_{name}")
    return adapted.join(found, "tail", "left")


def diagnose(
    reports: DataFrame,
    models: Model | Sequence[Model] | DataFrame,
    *,
    effects: Sequence[str] = (),
    without: Sequence[str] = (),
    table_only: bool = False,
    allow_learnt: bool = False,
    **options: Any,
) -> DataFrame:
    """Where models differ from flights and which effect they lack: one row per tail.

    Args:
        reports: Reports, or the result of :func:`flights`.
        models: Models, or the result of :func:`adapt`, whose tails then each have their own.
        effects: Look for these effects only.
        without: Leave these effects out.
        table_only: Count as gap what the model has learnt beyond its drag table.
        allow_learnt: Also diagnose flights that the model has learnt.
        options: As for :func:`flights`.

    Returns:
        Columns ``tail``, ``flights``, ``segments``, ``verdict`` (its kind), ``effects`` (separated by commas), ``probability``,
        ``gap_rms_percent``, ``closure``, ``diagnosis`` (JSON of ``diagnosis.json``), ``error``.
    """

    def one(table: pa.Table, own: Sequence[Model]) -> dict[str, Any]:
        found = diagnosis.diagnose(
            _segments_of(table),
            own,
            effects=effects,
            without=without,
            table_only=table_only,
            allow_learnt=allow_learnt,
            threads=1,
        )
        if not found.diagnoses:
            reasons = "; ".join(one.reason for one in found.refused[:3])
            return {"diagnosis": found.to_json(), "error": f"no flight left: {reasons}"}
        tail = found.diagnoses[0]
        return {
            "flights": tail.flights,
            "segments": tail.segments,
            "verdict": tail.verdict.kind,
            "effects": ",".join(tail.verdict.effects),
            "probability": tail.verdict.probability,
            "gap_rms_percent": tail.gap.rms_percent,
            "closure": tail.verdict.closure,
            "diagnosis": found.to_json(),
        }

    return _by_tail(reports, models, _DIAGNOSED, one, options)


def _by_tail(
    reports: DataFrame,
    models: Model | Sequence[Model] | DataFrame,
    schema: pa.Schema,
    one: Callable[[pa.Table, Sequence[Model]], dict[str, Any]],
    options: dict[str, Any],
) -> DataFrame:
    """One row per tail, by models of the driver or by the models that the tails have learnt."""
    read = _as_flights(reports, options).where(F.col("refused").isNull())
    if isinstance(models, (Model, Sequence)):
        given = [models] if isinstance(models, Model) else models

        def grouped(key: tuple[Any, ...], table: pa.Table) -> pa.Table:
            return _row_or_error(schema, key[0].as_py(), lambda: one(table, given))

        return read.groupBy("tail").applyInArrow(grouped, from_arrow_schema(schema))

    def of_tail(known: pa.Table, table: pa.Table) -> dict[str, Any]:
        own = [row for row in known.to_pylist() if row["model"] is not None]
        if not own:
            return {"error": "the tail has no model"}
        return one(table, [Model.from_text(row["model"], row["tail"]) for row in own])

    def cogrouped(key: tuple[Any, ...], known: pa.Table, table: pa.Table) -> pa.Table:
        if table.num_rows == 0:
            return schema.empty_table()
        return _row_or_error(schema, key[0].as_py(), lambda: of_tail(known, table))

    known = models.select("tail", "model").groupBy("tail")
    return known.cogroup(read.groupBy("tail")).applyInArrow(cogrouped, from_arrow_schema(schema))


def _continued(
    tail: str,
    known: pa.Table,
    table: pa.Table,
    learn: Callable[[adaptation.Adaptation | None, pa.Table], adaptation.Adaptation],
) -> pa.Table:
    """The row of a tail after a night, from its row before it and the night's flights. What cannot be done costs the night, and
    not what the tail has learnt."""
    row = known.slice(0, 1).to_pylist()[0] if known.num_rows else {}
    if row.get("model") is None:
        # A tail that has no model yet, and perhaps no flight that it could learn.
        without = {"error": row.get("error") or "nothing learnt: no flight"}
        return _row_or_error(
            _ADAPTED, tail, lambda: _adapted_row(learn(None, table)) if table.num_rows else without
        )

    def night() -> dict[str, Any]:
        before = _stored(row)
        return _adapted_row(learn(before, table) if table.num_rows else before)

    kept = {**{name: row.get(name) for name in _ADAPTED.names}, "flights_new": 0, "summary": None}
    return _row_or_error(_ADAPTED, tail, night, kept)


def _added(key: tuple[Any, ...], table: pa.Table) -> pa.Table:
    """The row of a tail from those of its parts: what they refused is refused, and one that cannot be learnt is no part of a sum."""

    def row() -> dict[str, Any]:
        rows = table.to_pylist()
        wrong = {one["error"] for one in rows if one["summary"] is None}
        if wrong:
            return {"error": "; ".join(sorted(wrong))}
        learnt = [_stored(one) for one in rows if one["model"] is not None]
        return _adapted_row(adaptation.added(learnt, [one["summary"].encode() for one in rows]))

    return _row_or_error(_ADAPTED, key[0].as_py(), row)


def _read_batch(
    paths: list[str], contents: list[bytes | None], mapping: str | None, criteria: str
) -> Iterator[pa.RecordBatch]:
    """Rows of flights and of refusals; a null is a refusal."""
    pairs = [(path, content) for path, content in zip(paths, contents) if content is not None]
    if pairs:
        read = read_segments(pairs, mapping=mapping, criteria=criteria, threads=1)
    else:
        read = None
    yield from _rows_of(read, [p for p, c in zip(paths, contents) if c is None], criteria)


def _rows_of(
    read: Segments | None, without_content: list[str], criteria: str
) -> Iterator[pa.RecordBatch]:
    if read is not None:
        state = read.state()
        state = state.append_column("criteria", pa.array([criteria] * state.num_rows, pa.string()))
        yield from _in_schema(state, _FLIGHTS).to_batches()
    rows: list[dict[str, Any]] = [
        {"path": path, "refused": "found null, expected a report"} for path in without_content
    ]
    # Of the reading alone: which flights contradict each other is found where all of a tail are together.
    for one in refused_of(read._flights.refused_as_read()) if read is not None else []:
        rows.append(
            {
                "path": one.path,
                "refused": one.reason,
                "refused_line": one.line,
                "refused_column": one.column,
            }
        )
    if rows:
        yield from pa.Table.from_pylist(rows, schema=_FLIGHTS).to_batches()


def _as_flights(reports: DataFrame, options: dict[str, Any]) -> DataFrame:
    if "segments_csv" in reports.columns and "refused" in reports.columns:
        if options:
            raise TypeError(f"found {sorted(options)}, which belong to the reading of these flights")
        return reports
    return flights(reports, **options)


def _segments_of(table: pa.Table) -> Segments:
    """Flights in an order that does not depend on how rows arrived."""
    table = table.sort_by([("start", "ascending"), ("flight", "ascending"), ("path", "ascending")])
    criteria = table.column("criteria")[0].as_py()
    return Segments.from_state(table.select([name for name, _ in _FLIGHT]), criteria)


def _adapted_row(adapted: adaptation.Adaptation) -> dict[str, Any]:
    if not adapted.tails:
        reasons = "; ".join(str(one) for one in adapted.refused[:3])
        return {"summary": adapted.summary_json().decode(), "error": f"nothing learnt: {reasons}"}
    tail = adapted.tails[0]
    summary = adapted.summary
    return {
        "flights": summary["tails"][0]["flights"],
        "flights_new": summary["tails"][0]["flights_new"],
        "model": adapted.model(tail).to_text(),
        "segments_csv": adapted.segments_csv(tail).decode(),
        "flights_csv": adapted.flights_csv(tail).decode(),
        "begun": adapted.begun(tail),
        "summary": adapted.summary_json().decode(),
    }


def _stored(row: dict[str, Any]) -> adaptation.Adaptation:
    """What a row of :func:`adapt` holds, to be continued.

    Raises:
        InputError: The row holds a model alone, such as parts had before they were kept with their flights.
    """
    missing = [name for name in ("segments_csv", "flights_csv", "begun") if row.get(name) is None]
    if missing:
        raise InputError(
            f"found a model without {', '.join(missing)}, expected a row of cruisefit.spark.adapt, which has all of them"
        )
    model = Model.from_text(row["model"], row["tail"])
    segments, flights = row["segments_csv"].encode(), row["flights_csv"].encode()
    return adaptation.Adaptation.stored([(model, segments, flights, row["begun"])])


def _row_or_error(
    schema: pa.Schema,
    tail: str,
    row: Callable[[], dict[str, Any]],
    otherwise: dict[str, Any] | None = None,
) -> pa.Table:
    """A tail that cannot be computed costs its row, of which ``otherwise`` is left, and not the job."""
    try:
        found = row()
    except Exception as error:
        found = {**(otherwise or {}), "error": f"{type(error).__name__}: {error}"}
    return pa.Table.from_pylist([{**found, "tail": tail}], schema=schema)


def _in_schema(table: pa.Table, schema: pa.Schema) -> pa.Table:
    """The table's columns in a fixed order and type; those that it does not have are null."""
    columns = [
        table.column(field.name).cast(field.type)
        if field.name in table.column_names
        else pa.nulls(table.num_rows, field.type)
        for field in schema
    ]
    return pa.Table.from_arrays(columns, schema=schema)


def _segments_schema() -> pa.Schema:
    """The columns of a table of segments, with those of four engines."""
    plain = Segments(_native.Source(PRESETS[0], None).contents([], opened, 1)).table().schema
    per_engine = [
        pa.field(name.format(engine), pa.float64())
        for name in _PER_ENGINE
        for engine in range(1, _ENGINES + 1)
    ]
    return pa.schema([*plain, *per_engine])


def _mapping_text(mapping: str | os.PathLike[str] | None) -> str | None:
    """The mapping as text, since its file is on the driver alone; the name of a preset as it is."""
    if mapping is None or not os.path.exists(mapping):
        return None if mapping is None else os.fspath(mapping)
    return read_text(mapping)
