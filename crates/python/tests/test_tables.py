"""Tables of pyarrow, polars, pandas and DuckDB, in and out; random points across types."""

from __future__ import annotations

import datetime

import duckdb
import numpy as np
import pandas as pd
import polars as pl
import pyarrow as pa
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cruisefit
from conftest import FIXTURES

ROWS = {
    "mass_kg": [15000.0, 14000.0, 13500.5],
    "pressure_altitude_ft": [43000.0, 41000.0, 39000.0],
    "mach": [0.82, 0.80, 0.78],
    "isa_deviation_c": [0.0, -5.0, 10.25],
}


def fuel_flow(table) -> list[float]:
    return pa.table(table).column("fuel_flow_kg_s").to_pylist()


def test_every_library_gives_the_same_and_gets_its_own(initial):
    arrow = pa.table(ROWS)
    expected = fuel_flow(initial.predict(arrow))
    assert all(value > 0 for value in expected)
    for given_table, kind in [
        (arrow, pa.Table),
        (pl.DataFrame(ROWS), pl.DataFrame),
        (pd.DataFrame(ROWS), pd.DataFrame),
        (duckdb.sql("select * from arrow"), pa.Table),
        (arrow.to_batches()[0], pa.Table),
        (ROWS, pa.Table),
    ]:
        predicted = initial.predict(given_table)
        assert isinstance(predicted, kind)
        back = predicted if kind is not pd.DataFrame else pa.Table.from_pandas(predicted)
        assert fuel_flow(back) == expected


def test_columns_that_come_in_go_out_without_a_copy(initial):
    table = pa.table(ROWS)
    predicted = initial.predict(table)
    for name in table.column_names:
        ours, theirs = predicted.column(name).chunk(0), table.column(name).chunk(0)
        assert ours.buffers()[1].address == theirs.buffers()[1].address


def test_a_table_cut_anywhere_is_the_same_table(initial):
    table = pa.table(ROWS)
    cut = pa.concat_tables([table.slice(0, 1), table.slice(1)])
    assert initial.predict(cut).combine_chunks().equals(initial.predict(table).combine_chunks())
    assert fuel_flow(initial.predict(table.slice(1))) == fuel_flow(initial.predict(table))[1:]


def test_a_measured_fuel_flow_and_a_date(initial):
    table = pa.table({**ROWS, "fuel_flow_kg_h": [700.0, None, 650.0],
                      "date": [datetime.date(2018, 5, 20)] * 3})
    predicted = initial.predict(table)
    flow = fuel_flow(predicted)[0] * 3600
    error = predicted.column("error_percent").to_pylist()
    assert error[0] == pytest.approx(100 * (700 - flow) / 700, rel=1e-12)
    assert error[1] is None


def test_points_outside_the_table_are_null_and_said(initial):
    table = pa.table({**ROWS, "mach": [0.82, 0.2, 0.78]})
    with pytest.warns(cruisefit.PredictionWarning, match="1 points have no prediction; the first is row 2"):
        predicted = initial.predict(table)
    assert [value is None for value in fuel_flow(predicted)] == [False, True, False]
    with pytest.raises(cruisefit.InputError) as caught:
        initial.predict(table, strict=True)
    assert caught.value.line == 2
    assert str(caught.value).startswith("row 2: 1 points have no prediction")
    with pytest.raises(cruisefit.InputError, match="^column speed: unknown column"):
        initial.predict({**ROWS, "speed": [1.0, 2.0, 3.0]})


@pytest.mark.parametrize("column", sorted(ROWS))
@pytest.mark.parametrize("further", [{}, {"anti_ice": [1, 0, None]}, {"fuel_flow_kg_h": [700.0, 710.0, 720.0]}])
def test_a_missing_value_costs_its_row(initial, column, further):
    """As a point outside the table does; a value that is there and absurd is an error of the table."""
    whole = initial.predict({**ROWS, **further})
    for nothing in (None, float("nan")):
        table = pl.DataFrame({**ROWS, **further, column: [ROWS[column][0], nothing, ROWS[column][2]]})
        with pytest.warns(cruisefit.PredictionWarning, match=f"1 points .* row 2: {column}: no value"):
            predicted = initial.predict(table)
        flow = predicted["fuel_flow_kg_s"].to_list()
        assert flow[1] is None and predicted["fuel_flow_kg_s"].null_count() == 1
        assert [flow[0], flow[2]] == pytest.approx(fuel_flow(whole)[::2], rel=1e-12)
        if "fuel_flow_kg_h" in further:
            assert predicted["error_percent"].null_count() == 1
        with pytest.raises(cruisefit.InputError, match="no value") as caught:
            initial.predict(table, strict=True)
        assert caught.value.line == 2
    with pytest.raises(cruisefit.InputError, match="found"):
        initial.predict({**ROWS, **further, column: [ROWS[column][0], 1e9, ROWS[column][2]]})
    gone = pl.DataFrame({**ROWS, **further, column: [None] * 3}, schema_overrides={column: pl.Float64})
    with pytest.warns(cruisefit.PredictionWarning, match="3 points"):
        assert initial.predict(gone)["fuel_flow_kg_s"].null_count() == 3


TYPES = {
    "float64": lambda v: pa.array(v, pa.float64()),
    "text": lambda v: pa.array([repr(x) for x in v], pa.string()),
    "large_text": lambda v: pa.array([repr(x) for x in v], pa.large_string()),
    "dictionary": lambda v: pa.array([repr(x) for x in v]).dictionary_encode(),
}


@settings(max_examples=300, deadline=None)
@given(
    rows=st.lists(
        st.tuples(
            st.floats(10_000, 16_000), st.floats(33_000, 45_000), st.floats(0.65, 0.88),
            st.floats(-20, 20),
        ),
        min_size=1,
        max_size=8,
    ),
    types=st.lists(st.sampled_from(sorted(TYPES)), min_size=4, max_size=4),
    cut=st.integers(0, 8),
)
@pytest.mark.filterwarnings("ignore::cruisefit.PredictionWarning")
def test_random_points_across_types(initial, rows, types, cut):
    columns = list(zip(*rows))
    plain = pa.table({name: pa.array(values, pa.float64()) for name, values in zip(ROWS, columns)})
    typed = pa.table({name: TYPES[kind](values) for name, kind, values in zip(ROWS, types, columns)})
    typed = pa.concat_tables([typed.slice(0, cut), typed.slice(cut)])
    assert fuel_flow(initial.predict(typed)) == fuel_flow(initial.predict(plain))


def test_whole_numbers_and_single_precision(initial):
    whole = pa.table({"mass_kg": pa.array([15000], pa.int32()),
                      "pressure_altitude_ft": pa.array([43000], pa.uint16()),
                      "mach": pa.array(np.array([0.8125], np.float32)), "anti_ice": [True]})
    plain = pa.table({"mass_kg": [15000.0], "pressure_altitude_ft": [43000.0], "mach": [0.8125]})
    assert fuel_flow(initial.predict(whole)) == fuel_flow(initial.predict(plain))


def test_segments_are_a_table(segments):
    rows = pa.table(segments)
    assert rows.num_rows == len(segments) > 0
    assert isinstance(segments.table(pl.DataFrame()), pl.DataFrame)
    assert duckdb.sql("select count(*) from rows").fetchall() == [(len(segments),)]
    again = cruisefit.Segments.from_table(rows, "C750")
    assert again.to_csv() == segments.to_csv()


def test_rows_of_a_table_of_segments_are_used_once_in_any_order(initial, segments, tmp_path):
    """Two exports that overlap, rows as a database gives them; from memory and from a file."""
    rows = segments.table(pl.DataFrame())
    expected = initial.adapt(cruisefit.Segments.from_table(rows, "C750")).model().to_text()
    shuffled = rows.sample(fraction=1.0, shuffle=True, seed=1)
    assert initial.adapt(cruisefit.Segments.from_table(shuffled, "C750")).model().to_text() == expected
    overlapping = pl.concat([rows, shuffled.head(20)])
    with pytest.warns(cruisefit.DataWarning, match="20 rows of a table of segments are copies of others"):
        again = cruisefit.Segments.from_table(overlapping, "C750")
    assert again.to_csv() == segments.to_csv()
    overlapping.write_csv(tmp_path / "S.csv")
    with pytest.warns(cruisefit.DataWarning, match="20 rows"):
        assert cruisefit.segment(tmp_path / "S.csv").to_csv() == segments.to_csv()
    # Rows of one instant that differ are no copies, and a table without rows has its columns.
    other = rows.head(1).with_columns(pl.col("mass_kg") + 1.0)
    assert len(cruisefit.Segments.from_table(pl.concat([rows, other]), "C750")) == len(rows) + 1
    for empty in (rows.clear(), rows.to_arrow().slice(0, 0), rows.to_pandas().head(0)):
        assert len(cruisefit.Segments.from_table(empty, "C750")) == 0


def test_a_recording_as_rows_of_a_table():
    """The rows of a CSV recording, read by polars, are the recording."""
    path = FIXTURES / "a320-traffic" / "fuelflow_a320.csv.gz"
    criteria = "airbus-report-02"  # the default finds no steady segment in it
    by_file = cruisefit.segment(path, mapping="traffic-a320", criteria=criteria)
    rows = pl.read_csv(path, infer_schema=False)
    by_rows = cruisefit.segment(rows, mapping="traffic-a320", criteria=criteria, name=path.name)
    assert len(by_file) > 0
    assert by_rows.to_csv() == by_file.to_csv()


def test_columns_of_a_whole_model_are_single_predictions():
    """A heading changes nothing where the latitude is missing, but such points are predicted one by one."""
    folder = FIXTURES / "global5000"
    initial = cruisefit.Model.initial(folder / "AIRCRAFT.ron", folder / "guide.csv")
    model = initial.adapt(cruisefit.segment(folder / "reports")).model()
    draw = np.random.default_rng(20261122).uniform
    points = pa.table({
        "mass_kg": draw(24_000, 40_000, 500), "pressure_altitude_ft": draw(30_000, 48_000, 500),
        "mach": draw(0.70, 0.90, 500), "isa_deviation_c": draw(-15, 15, 500),
    })
    together = model.predict(points)
    one_by_one = model.predict(points.append_column("true_heading_deg", pa.array([90.0] * 500)))
    assert "remainder_percent" in together.column_names
    for name in together.column_names[4:]:
        ours, theirs = together.column(name), one_by_one.column(name)
        assert ours.is_valid().equals(theirs.is_valid()) and ours.null_count < 100
        scale = {"remainder_percent": 100.0, "fuel_flow_std_kg_s": 1e-3}.get(name, 0.0)
        # Columns are predicted from tables of the model's functions, within 1e-9, of their deviations in single precision.
        tolerance = 1e-5 if name == "fuel_flow_std_kg_s" else 1e-9
        ours, theirs = (column.drop_null().to_numpy() for column in (ours, theirs))
        assert np.all(np.abs(ours - theirs) <= tolerance * np.maximum(np.abs(theirs), scale)), name
