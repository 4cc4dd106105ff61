"""What a frame of pandas or polars has besides numbers: an index, types of its own, no row at all."""

from __future__ import annotations

import decimal

import numpy as np
import pandas as pd
import polars as pl
import pyarrow as pa
import pytest

import cruisefit
from test_recordings import MAPPING, recording

MACH = [0.78, 0.82, 0.80, 0.76, 0.81, 0.79]
POINTS = {"mass_kg": [15000.0] * 6, "pressure_altitude_ft": [43000.0] * 6, "mach": MACH}
RESULTS = [
    "fuel_flow_kg_s", "fuel_flow_std_kg_s", "specific_range_m_kg", "lift_coefficient", "drag_coefficient", "extrapolated",
]


@pytest.fixture(scope="module")
def flow_of_mach(initial) -> dict[float, float]:
    """Fuel flow at the Mach number of each row, from a table without an index."""
    predicted = initial.predict(pa.table(POINTS))
    return dict(zip(MACH, predicted.column("fuel_flow_kg_s").to_pylist()))


FRAME = pd.DataFrame(POINTS)
INDEXES = {
    "sorted": FRAME.sort_values("mach", ascending=False),
    "an evenly spaced selection": FRAME.iloc[1::2],
    "an uneven selection": FRAME.iloc[[0, 1, 3]],
    "reversed": FRAME[::-1],
    "sampled": FRAME.sample(4, random_state=1),
    "duplicates": pd.concat([FRAME, FRAME]),
    "texts": FRAME.set_axis(list("abcdef")),
    "a name": FRAME.set_axis(pd.Index([9, 8, 7, 6, 5, 4], name="id")),
    "a range with a name": FRAME.set_axis(pd.RangeIndex(10, 16, name="row")),
    "the name of a column": FRAME.set_axis(pd.Index(MACH[::-1], name="mach")),
    "times": FRAME.set_axis(pd.date_range("2024-03-01", periods=6, tz="UTC", name="time")),
    "levels": FRAME.set_axis(pd.MultiIndex.from_product([["x", "y"], [1, 2, 3]], names=["tail", None])),
}


@pytest.mark.parametrize("kind", sorted(INDEXES))
def test_a_frame_keeps_its_index(initial, flow_of_mach, kind):
    given = INDEXES[kind]
    before = given.copy()
    predicted = initial.predict(given)
    pd.testing.assert_index_equal(predicted.index, given.index, exact=True)
    pd.testing.assert_frame_equal(predicted[list(POINTS)], given)
    assert predicted["fuel_flow_kg_s"].tolist() == [flow_of_mach[mach] for mach in given["mach"]]
    # What is usually done with it: rows meet by the index.
    if given.index.is_unique:
        assigned = given.copy()
        assigned["flow"] = initial.predict(given)["fuel_flow_kg_s"]
        assert assigned["flow"].tolist() == predicted["fuel_flow_kg_s"].tolist()
    # The result is a copy: what is written into it is not written into what was given.
    predicted.iloc[0, 0] = 1.0
    pd.testing.assert_frame_equal(given, before)


EMPTY = {
    "polars": pl.DataFrame(POINTS).filter(pl.col("mach") > 2),
    "pandas": FRAME[FRAME["mach"] > 2],
    "pyarrow": pa.table(POINTS).slice(0, 0),
    "pyarrow without batches": pa.table(POINTS).schema.empty_table(),
    "a reader": pa.RecordBatchReader.from_batches(pa.table(POINTS).schema, []),
}


@pytest.mark.parametrize("kind", sorted(EMPTY))
def test_a_table_without_rows_has_the_columns_of_one_with_rows(initial, kind):
    predicted = initial.predict(EMPTY[kind])
    full = initial.predict(POINTS)
    if kind in ("polars", "pandas"):
        assert type(predicted) is type(EMPTY[kind])
    if kind == "pandas":
        predicted = pa.Table.from_pandas(predicted, preserve_index=False)
    predicted = pa.table(predicted)
    assert predicted.num_rows == 0
    assert predicted.column_names == full.column_names == [*POINTS, *RESULTS]
    assert predicted.schema.types == full.schema.types
    assert initial.predict(EMPTY["polars"], columns=["fuel_flow_kg_s"]).columns == [*POINTS, "fuel_flow_kg_s"]


def test_a_table_without_rows_has_the_error_where_fuel_flow_is_measured(initial):
    measured = pl.DataFrame({**POINTS, "fuel_flow_kg_h": [700.0] * 6})
    assert initial.predict(measured.clear()).schema == initial.predict(measured).schema


def test_the_columns_of_a_prediction_do_not_depend_on_values(initial):
    """So that parts of a table can be put together again."""
    parts = [{**POINTS, "fuel_flow_kg_h": [flow] * 6} for flow in (720.0, None, float("nan"))]
    predicted = [
        initial.predict(frame(part))
        for part in parts
        for frame in (pl.DataFrame, lambda part: pl.DataFrame(part, schema_overrides={"fuel_flow_kg_h": pl.Float64}))
    ]
    assert all(table.columns == [*POINTS, "fuel_flow_kg_h", *RESULTS, "error_percent"] for table in predicted)
    assert [table["error_percent"].null_count() for table in predicted] == [0, 0, 6, 6, 6, 6]
    # By name it is there too, of whatever nobody measured.
    asked = initial.predict(pl.DataFrame(POINTS), columns="error_percent")
    assert asked.columns == [*POINTS, "error_percent"] and asked["error_percent"].null_count() == 6
    assert initial.predict({**POINTS, "anti_ice": [0] * 6}, columns=["error_percent"]).column("error_percent").null_count == 6


@pytest.mark.parametrize("columns", [None, ["fuel_flow_kg_s"]])
@pytest.mark.parametrize("library", [pl.DataFrame, pd.DataFrame, pa.table])
def test_columns_of_an_earlier_prediction_are_left_out(initial, segments, library, columns):
    """As a table of pyarrow has them: none stays that another model predicted."""
    given = library({**POINTS, "X-row": list("abcdef")})
    of_another = initial.adapt(segments).model().predict(given)
    assert "remainder_percent" in list(getattr(of_another, "column_names", of_another.columns))
    again, once = (initial.predict(points, columns=columns) for points in (of_another, given))
    if library is pd.DataFrame:
        pd.testing.assert_frame_equal(again, once)
    else:
        assert again.equals(once)


def test_types_that_came_in_go_out(initial, flow_of_mach):
    """Also where the library that computes does not have the type, or decodes it to read it."""
    numbers = [2**60 + 1, 2**60 + 3, None, 5, 6, 7]
    polars = pl.DataFrame(POINTS).with_columns(
        pl.col("mach").cast(pl.Decimal(10, 3)),
        pl.Series("X-enum", ["a", "b"] * 3, dtype=pl.Enum(["a", "b"])),
        pl.Series("X-category", list("abcabc"), dtype=pl.Categorical),
        pl.Series("X-decimal", [decimal.Decimal("1.25")] * 6, dtype=pl.Decimal(10, 2)),
        pl.Series("X-list", [[1], [], None, [2, 3], [4], [5]]),
        pl.Series("anti_ice", [0] * 6, dtype=pl.Int128),
        pl.Series("X-object", [object()] * 6, dtype=pl.Object),
    )
    predicted = initial.predict(polars)
    assert predicted.columns == [*polars.columns, *RESULTS]
    assert predicted.select(polars.columns).schema == polars.schema
    # Text and decimals are read row by row, an oracle within 1e-12.
    assert predicted["fuel_flow_kg_s"].to_list() == pytest.approx([flow_of_mach[mach] for mach in MACH], rel=1e-12)

    pandas = FRAME.assign(**{
        "X-id": pd.array(numbers, dtype="Int64"), "X-category": pd.Categorical(list("abcabc")),
        "X-month": pd.period_range("2020-01", periods=6, freq="M"), "X-any": [1, "a", None, {}, 2.5, []],
    })
    predicted = initial.predict(pandas)
    pd.testing.assert_frame_equal(predicted[list(pandas.columns)], pandas)
    assert predicted["X-id"].tolist()[:2] == numbers[:2]

    arrow = pa.table({**POINTS, "X-id": pa.array(numbers), "X-category": pa.array(list("abcabc")).dictionary_encode(),
                      "anti_ice": pa.array([0] * 6).dictionary_encode(), "X-list": pa.array([[1], [], None, [2], [3], [4]]),
                      "X-decimal": pa.array([decimal.Decimal("1.25")] * 6, pa.decimal128(10, 2))})
    arrow = arrow.replace_schema_metadata({"made by": "a test"})
    predicted = initial.predict(arrow)
    assert predicted.select(arrow.column_names).equals(arrow, check_metadata=True)
    # A column that is read has to have a type that can be.
    with pytest.raises(cruisefit.InputError, match="column anti_ice: found type List"):
        initial.predict(pa.table({**POINTS, "anti_ice": pa.array([[1]] * 6)}))


def test_of_a_recordings_index_levels_with_a_name_are_columns():
    """A time often is the index; positions and labels without a name mean nothing."""
    columns = pd.DataFrame(recording(900, 1.0))
    mapping = MAPPING.format(more="")
    expected = cruisefit.segment(columns, mapping=mapping).state()
    for frame in (
        columns.set_index("utc"),
        columns.set_index("utc", drop=False),
        columns.set_index(["tail", "utc"]),
        columns.set_axis(np.arange(900)[::-1] // 2),
        columns.set_axis(pd.MultiIndex.from_product([range(2), range(450)])),
    ):
        assert cruisefit.segment(frame, mapping=mapping).state().equals(expected)
        assert "__index_level" not in cruisefit.mapping(frame)


def test_segments_are_selected_in_pandas(segments):
    rows = segments.table(pd.DataFrame())
    uneven = rows.iloc[[0, 1, 3]]
    assert len(cruisefit.Segments.from_table(uneven, "C750")) == 3
    state = pa.table(segments.state()).to_pandas()
    assert len(cruisefit.Segments.from_state(state[::-1]).flights) == len(state)
