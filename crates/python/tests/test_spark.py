"""A fleet on Spark gives what one machine gives, to the bit; a poisoned report costs its row."""

from __future__ import annotations

import json
import os
import shutil
import sys
import warnings

import pytest
from conftest import FIXTURES

import cruisefit

pyspark = pytest.importorskip("pyspark")
if shutil.which("java") is None:
    pytest.skip("no Java", allow_module_level=True)

from pyspark.sql import SparkSession  # noqa: E402

import cruisefit.spark  # noqa: E402

PLAN = """(
    seed: 20261122,
    aircraft: Preset(citation_x),
    tails: [
        (tail: "T-1", flights: Designed((flights: 7))),
        (tail: "T-2", flights: Designed((flights: 3))),
        (tail: "T-3", flights: Designed((flights: 5))),
    ],
)
"""


@pytest.fixture(scope="module")
def session():
    os.environ["PYSPARK_PYTHON"] = os.environ["PYSPARK_DRIVER_PYTHON"] = sys.executable
    # CRUISEFIT_SPARK=local[2] where two executors of their own are too many.
    master = os.environ.get("CRUISEFIT_SPARK", "local-cluster[2,1,1024]")
    session = (
        SparkSession.builder.master(master)
        .config("spark.ui.enabled", "false")
        .config("spark.sql.shuffle.partitions", "3")
        .config("spark.driver.memory", "1g")
        .config("spark.executor.memory", "1g")
        .getOrCreate()
    )
    session.sparkContext.setLogLevel("ERROR")
    yield session
    session.stop()


@pytest.fixture(scope="module")
def reports():
    return cruisefit.simulate(PLAN).reports


@pytest.fixture(scope="module")
def model():
    folder = FIXTURES / "ghazi-2020"
    return cruisefit.Model.initial(folder / "AIRCRAFT.ron", folder / "guide.csv")


@pytest.fixture(scope="module")
def flights(session, reports):
    poisoned = [("zz-cut.txt", reports[0][1][:3000]), ("zz-junk", b"\0\1"), ("zz-null", None)]
    frame = session.createDataFrame(reports + poisoned, "name string, content binary").repartition(4)
    return cruisefit.spark.flights(frame, report="content", path="name").cache()


@pytest.fixture(scope="module")
def adapted(flights, model):
    return cruisefit.spark.adapt(flights, [model]).cache()


def test_a_poisoned_report_costs_its_row(flights, reports):
    refused = {row.path: row for row in cruisefit.spark.refused(flights).collect()}
    assert set(refused) == {"zz-cut.txt", "zz-junk", "zz-null"}
    alone = cruisefit.segment([("zz-cut.txt", reports[0][1][:3000])]).refused[0]
    row = refused["zz-cut.txt"]
    assert (row.refused, row.refused_line, row.refused_column) == (alone.reason, alone.line, alone.column)
    assert flights.where("refused is null").count() == len(reports)


def test_segments_are_those_of_one_machine(flights, reports):
    alone = cruisefit.segment(reports).table().to_pylist()
    rows = [row.asDict() for row in cruisefit.spark.segment(flights).collect()]
    key = lambda row: (row["tail"], row["start"], row["flight"], row["time_s"])  # noqa: E731
    assert len(rows) == len(alone)
    for ours, theirs in zip(sorted(rows, key=key), sorted(alone, key=key), strict=True):
        assert {name: ours[name] for name in theirs} == theirs


def test_copies_and_contradictions_do_not_depend_on_partitions(session, reports):
    """Eight reports, each twice under two names, and one that says something else of a flight; no path of one of them."""
    copies = [(f"copy of {name}", content) for name, content, *_ in reports]
    name, content = reports[0][0], reports[0][1]
    altered = content[:-200] if isinstance(content, str) else bytes(content[:-200])
    altered = altered[: altered.rindex("\n" if isinstance(altered, str) else b"\n") + 1]
    rows = [tuple(report[:2]) for report in reports] + copies + [(f"other {name}", altered)]
    rows = [(name, content.encode() if isinstance(content, str) else content) for name, content in rows]
    alone = cruisefit.segment(rows)
    rows[3] = (None, rows[3][1])
    found = set()
    for partitions in (1, 7):
        frame = session.createDataFrame(rows, "name string, content binary").repartition(partitions)
        read = cruisefit.spark.flights(frame, report="content", path="name").cache()
        assert read.count() == len(rows)
        found.add((cruisefit.spark.segment(read).count(), cruisefit.spark.refused(read).count()))
    assert found == {(len(alone), 0)}
    with warnings.catch_warnings():
        warnings.simplefilter("error", cruisefit.DataWarning)
        cruisefit.spark.segment(read)


def test_a_tail_that_never_had_a_model_keeps_its_reason(flights, model):
    folder = FIXTURES / "global5000"
    other = cruisefit.Model.initial(folder / "AIRCRAFT.ron", folder / "guide.csv")
    without = cruisefit.spark.adapt(flights, [other])
    again = cruisefit.spark.adapt(flights.where("tail = 'nobody'"), [model], begun=without).collect()
    assert len(again) == 3 and all("aircraft type" in row.error for row in again)
    diagnosed = cruisefit.spark.diagnose(flights, without).collect()
    assert len(diagnosed) == 3 and {row.error for row in diagnosed} == {"the tail has no model"}


def test_models_are_those_of_one_machine(adapted, model, reports):
    alone = model.adapt(cruisefit.segment(reports))
    rows = {row.tail: row for row in adapted.collect()}
    assert sorted(rows) == alone.tails
    for tail, row in rows.items():
        assert row.error is None and row.flights == row.flights_new
        assert row.model == alone.model(tail).to_text()
        assert row.segments_csv.encode() == alone.segments_csv(tail)


def test_nights_and_parquet(session, model, reports, tmp_path):
    """Two nights, the state between them in Parquet: what the same nights give on one machine."""
    names = sorted(name for name, _ in reports)
    nights = [[r for r in reports if r[0] in set(names[k::2])] for k in range(2)]
    frame = lambda rows: cruisefit.spark.flights(  # noqa: E731
        session.createDataFrame(rows, "name string, content binary"), report="content", path="name"
    )
    cruisefit.spark.adapt(frame(nights[0]), [model]).write.parquet(str(tmp_path / "night"))
    begun = session.read.parquet(str(tmp_path / "night"))
    rows = cruisefit.spark.adapt(frame(nights[1] + nights[0][:1]), [model], begun=begun).collect()
    one = model.adapt(cruisefit.segment(nights[0]))
    alone = cruisefit.adapt(cruisefit.segment(nights[1]), [model], begun=one)
    assert {row.tail: row.model for row in rows} == {t: m.to_text() for t, m in alone.models.items()}
    assert sum(json.loads(row.summary)["reports"]["already_known"] for row in rows) == 1


def test_parts_are_added_up(flights, adapted, model):
    """In parts nothing is learnt but the table, and sums differ in their last digits."""
    rows = {row.tail: row for row in cruisefit.spark.adapt(flights, [model], parts=2).collect()}
    whole = {row.tail: cruisefit.Model.from_text(row.model) for row in adapted.collect()}
    assert sorted(rows) == sorted(whole)
    for tail, row in rows.items():
        assert row.error is None, row.error
        ours = cruisefit.Model.from_text(row.model)
        assert ours.flights_learnt == whole[tail].flights_learnt
        drag = [model.table().column("drag_coefficient").to_pylist() for model in (ours, whole[tail])]
        # Outlier weights of a part are found without the other part: the project's measured difference is 7.6e-4.
        assert max(abs(a / b - 1) for a, b in zip(*drag, strict=True)) < 1e-2


def test_the_sum_of_parts_goes_on(session, model, reports, tmp_path):
    """Two nights, of which the first was learnt in parts; a flight that contradicts another is refused within its part."""
    frame = lambda rows: cruisefit.spark.flights(  # noqa: E731
        session.createDataFrame(rows, "name string, content binary"), report="content", path="name"
    )
    ordered = sorted(reports)
    later, first = [ordered[6]], ordered[:6] + ordered[7:]
    name, content = first[0]
    altered = content[: content.rindex(b"\n", 0, len(content) - 200) + 1]
    begun = cruisefit.spark.adapt(frame([*first, (f"zz {name}", altered)]), [model], parts=2)
    begun.write.parquet(str(tmp_path / "night"))
    begun = session.read.parquet(str(tmp_path / "night"))
    known = {row.tail: row for row in begun.collect()}
    assert all(row.error is None and row.flights == row.flights_new for row in known.values())
    summaries = [json.loads(row.summary) for row in known.values()]
    assert sum(one["reports"]["read"] for one in summaries) == len(first)
    assert [one["path"] for summary in summaries for one in summary["reports"]["refused"]] == [f"zz {name}"]

    night = cruisefit.spark.adapt(frame([*later, first[-1]]), [model], begun=begun, remainder=False).collect()
    alone = model.adapt(cruisefit.segment(first + later), remainder=False)
    for row in night:
        assert row.error is None
        assert row.segments_csv.encode() == alone.segments_csv(row.tail)
        assert row.flights == alone.model(row.tail).flights_learnt
    assert sum(row.flights_new for row in night) == 1
    assert all(row.error is None for row in cruisefit.spark.monitor(begun, quick=True).collect())

    # What cannot go on keeps what it had, with the reason.
    kept = cruisefit.spark.adapt(frame(later), [model], begun=begun).collect()
    (row,) = [row for row in kept if row.error is not None]
    assert "remainder=False" in row.error
    for name in ("model", "segments_csv", "flights_csv", "begun", "flights"):
        assert row[name] == known[row.tail][name]
    refused = cruisefit.spark.adapt(frame(first), [model], parts=2, threshold_percent=1.0).collect()
    assert len(refused) == 3 and all("threshold" in row.error for row in refused)


def test_a_model_without_its_flights_is_kept_and_refused_by_name(model, reports):
    """As the sums of parts were before they were kept with their flights."""
    import pyarrow as pa

    from cruisefit.spark import _ADAPTED, _continued

    row = {"tail": "T-1", "flights": 7, "flights_new": 7, "model": "text"}
    known = pa.Table.from_pylist([row], schema=_ADAPTED)
    (found,) = _continued("T-1", known, known.slice(0, 0), lambda before, table: before).to_pylist()
    assert found["error"].startswith("InputError: found a model without segments_csv, flights_csv, begun")
    assert (found["model"], found["flights"], found["flights_new"]) == ("text", 7, 0)


def test_evaluation_and_diagnosis(flights, adapted, model, reports):
    segments = cruisefit.segment(reports)
    own = cruisefit.adapt(segments, [model])
    evaluated = {row.tail: row for row in cruisefit.spark.evaluate(flights, adapted).collect()}
    found = cruisefit.spark.diagnose(flights, adapted, allow_learnt=True).collect()
    assert len(found) == len(evaluated) == 3
    for row in found:
        of_tail = segments.of_tails(row.tail)
        alone = own.model(row.tail).diagnose(of_tail, allow_learnt=True)
        assert row.error is None and row.diagnosis == alone.to_json()
        assert row.verdict == alone.diagnoses[0].verdict.kind
        evaluation = own.model(row.tail).evaluate(of_tail)
        assert evaluated[row.tail].summary.encode() == evaluation.summary_json()


def test_monitoring(flights, adapted, model, reports):
    own = cruisefit.adapt(cruisefit.segment(reports), [model])
    for row in cruisefit.spark.monitor(adapted, quick=True).collect():
        document = own.monitor(quick=True).to_dict()
        (tail,) = [one for one in document["tails"] if one["tail"] == row.tail]
        # Alone it is at no conditions but its own: those of its type take the other tails.
        assert tail.pop("at_type_conditions_percent") is not None
        (alone,) = json.loads(row.monitor)["tails"]
        assert alone.pop("at_type_conditions_percent") is None
        assert row.error is None and alone == tail


def test_a_fleet_at_once(flights, model):
    rows = cruisefit.spark.fleet(flights, [model], later=flights).collect()
    assert len(rows) == 3
    # The later flights are the learnt ones: each is refused by name.
    assert all(row.model and "ledger" in row.later_error for row in rows)


def test_a_tail_without_a_model_costs_its_row(flights):
    folder = FIXTURES / "global5000"
    other = cruisefit.Model.initial(folder / "AIRCRAFT.ron", folder / "guide.csv")
    rows = cruisefit.spark.adapt(flights, [other]).collect()
    assert len(rows) == 3 and all("aircraft type" in row.error for row in rows)


def test_recordings_whose_samples_are_rows(session):
    """Samples in any order, by flight: the flights of one machine."""
    from test_recordings import MAPPING, recording

    import pyarrow as pa

    columns = recording(900, 1.0)
    table = pa.table(columns)
    mapping = MAPPING.format(more="")
    alone = cruisefit.segment(table, mapping=mapping)
    shuffled = table.take(pa.array([(7 * row) % 900 for row in range(900)]))
    frame = session.createDataFrame(shuffled.to_pandas()).repartition(3)
    read = cruisefit.spark.recordings(frame, flight=["tail", "flight"], time="utc", mapping=mapping)
    rows = sorted(read.collect(), key=lambda row: row.path)
    assert [row.path for row in rows] == ["D-ABCD/XX,2", "D-ABCD/XX1"]
    theirs = {row["flight"]: row for row in alone.state().to_pylist()}
    for row in rows:
        assert row.refused is None
        assert (row.content, row.segments_csv) == tuple(
            theirs[row.flight][name] for name in ("content", "segments_csv")
        )
    broken = frame.drop("mach")
    (reason,) = {
        row.refused
        for row in cruisefit.spark.recordings(broken, flight="flight", time="utc", mapping=mapping).collect()
    }
    assert "mach" in reason
