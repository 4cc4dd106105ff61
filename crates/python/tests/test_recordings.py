"""A recording as a table in memory is the same recording as its text: same flights to the bit, same refusals at the same place."""

from __future__ import annotations

import datetime

import pandas as pd
import polars as pl
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cruisefit

MAPPING = """(
    format: 1,
    aircraft: Text("A320"),
    tail: Column("tail"),
    flight: Column("flight"),
    time: Timestamp(column: "utc", utc_offset: "Z"),
    quantities: {{
        "ALT": Recorded(column: "alt_ft", unit: "ft"),
        "MACH": Recorded(column: "mach", unit: "-"),
        "VTAS": Recorded(column: "tas_kt", unit: "kt"),
        "GSPD": Recorded(column: "gs_kt", unit: "kt"),
        "SAT": Recorded(column: "sat_degc", unit: "degC"),
        "WF": Recorded(column: "ff_kg_h", unit: "kg/h"),
    }},
    mass: GrossMass(column: "gw_kg", unit: "kg", largest_rise_kg: 50),
    {more}
)
"""
NUMBERS = {
    "alt_ft": 35_000.0, "mach": 0.78, "tas_kt": 450.0, "gs_kt": 460.0, "sat_degc": -56.5,
    "ff_kg_h": 2400.0, "gw_kg": 65_000.0,
}
BEGINNING = datetime.datetime(2024, 3, 1, 12)


def recording(rows: int, wobble: float) -> dict[str, list]:
    """Two flights, level, long enough to be used."""
    columns: dict[str, list] = {
        "utc": [BEGINNING + datetime.timedelta(seconds=row) for row in range(rows)],
        "tail": ["D-ABCD"] * rows,
        "flight": ["XX1" if row < 2 * rows // 3 else "XX,2" for row in range(rows)],
    }
    for name, value in NUMBERS.items():
        scale = wobble * abs(value) * 1e-4
        columns[name] = [value + scale * ((7 * row) % 5 - 2) for row in range(rows)]
    columns["gw_kg"] = [NUMBERS["gw_kg"] - 0.05 * row for row in range(rows)]
    return columns


def text(value: object, zone: str = "Z") -> str:
    """A cell as the text of a recording has it."""
    if value is None:
        return ""
    if isinstance(value, datetime.datetime):
        return value.isoformat() + zone
    if isinstance(value, float):
        return repr(value).removesuffix(".0")
    written = str(value)
    return '"' + written.replace('"', '""') + '"' if "," in written or '"' in written else written


def as_text(columns: dict[str, list], zone: str = "") -> bytes:
    cells = (",".join(text(value, zone) for value in row) for row in zip(*columns.values()))
    lines = [",".join(columns), *cells]
    return ("\n".join(lines) + "\n").encode()


def assert_same(table: object, columns: dict[str, list], mapping: str, zone: str = "") -> cruisefit.Segments:
    by_rows = cruisefit.segment(table, mapping=mapping, name="recording.csv")
    by_text = cruisefit.segment(("recording.csv", as_text(columns, zone)), mapping=mapping)
    # The content of a flight is a hash of every bit of every sample.
    assert by_rows.state().equals(by_text.state())
    assert by_rows.refused == by_text.refused
    return by_rows


def test_a_flight_that_is_dropped_is_refused_by_its_name():
    """One of two flights is too short for a level part, another has no tail: each is in ``refused``, the rest is used."""
    columns = recording(1500, 1.0)  # XX1 has 1000 samples, XX,2 has 500
    mapping = MAPPING.format(
        more="cruise: (minimum_pressure_altitude_ft: 25000, band_ft: 200, minimum_duration_s: 600, trim_s: 60),"
    )
    with pytest.warns(cruisefit.DataWarning, match="XX,2"):
        read = cruisefit.segment(pa.table(columns), mapping=mapping, name="table")
    assert read.flights.column("flight").to_pylist() == ["XX1"]
    (refused,) = read.refused
    assert (refused.path, refused.line) == ("table", None)
    assert refused.reason.startswith("flight XX,2: found ") and "level" in refused.reason
    assert refused.expected == "a level part of at least 720 s, as the mapping's cruise requires"
    # With bad rows left out a flight whose every row is bad costs itself alone.
    columns["mach"] = [None if flight == "XX,2" else mach for flight, mach in zip(columns["flight"], columns["mach"])]
    with pytest.warns(cruisefit.DataWarning):
        read = cruisefit.segment(pa.table(columns), mapping=MAPPING.format(more="bad_rows: LeaveRowOut,"))
    assert [one.reason.split(":")[0] for one in read.refused] == ["flight XX,2"]


def test_a_time_without_a_zone_is_taken_with_the_offset_of_the_mapping():
    """Noon on a clock two hours ahead is ten o'clock in UTC, in a frame, a table and a text alike."""
    columns = recording(900, 1.0)
    mapping = MAPPING.format(more="").replace('utc_offset: "Z"', 'utc_offset: "+02:00"')
    by_text = cruisefit.segment(("recording.csv", as_text(columns)), mapping=mapping)
    assert by_text.flights.column("start").to_pylist()[0] == "2024-03-01T10:00:00Z"
    for table in (pa.table(columns), pl.DataFrame(columns), pd.DataFrame(columns)):
        found = cruisefit.segment(table, mapping=mapping, name="recording.csv")
        assert found.state().equals(by_text.state())
    # A zone in the table counts more than the mapping.
    zoned = pa.table({**columns, "utc": pa.array(columns["utc"], pa.timestamp("us", "UTC"))})
    found = cruisefit.segment(zoned, mapping=mapping, name="recording.csv")
    assert found.flights.column("start").to_pylist()[0] == "2024-03-01T12:00:00Z"
    # Nor is a clock guessed where the mapping does not say which it is.
    unknown = MAPPING.format(more="").replace(', utc_offset: "Z"', "")
    with pytest.warns(cruisefit.DataWarning):
        refused = cruisefit.segment(pa.table(columns), mapping=unknown).refused
    assert refused and "an offset" in refused[0].reason
    assert cruisefit.segment(zoned, mapping=unknown, name="recording.csv").flights.num_rows == 2
    # A first mapping marks the offset as a guess.
    (time,) = [line for line in cruisefit.mapping(pa.table(columns)).splitlines() if "Timestamp" in line]
    assert time.endswith("// ?")


def test_files_without_a_zone_are_read_as_the_frame_is(run, tmp_path):
    """Parquet and Arrow by the command line: local times are marked as such in the files, and instants as instants."""
    rule = tmp_path / "M.ron"
    rule.write_text(MAPPING.format(more="").replace('utc_offset: "Z"', 'utc_offset: "-05:30"'))
    columns = recording(900, 1.0)
    for zone, start in ((None, "2024-03-01T17:30:00Z"), ("UTC", "2024-03-01T12:00:00Z")):
        table = pa.table({**columns, "utc": pa.array(columns["utc"], pa.timestamp("us", zone))})
        expected = cruisefit.segment(table, mapping=rule)
        assert expected.flights.column("start").to_pylist()[0] == start
        pq.write_table(table, tmp_path / "rows.parquet")
        with pa.ipc.new_file(tmp_path / "rows.arrow", table.schema) as file:
            file.write_table(table)
        for name in ("rows.parquet", "rows.arrow"):
            told = run("segment", "--mapping", rule, tmp_path / name)
            assert told == expected.to_csv().decode(), (name, zone)


KINDS = {
    "float64": lambda values: pa.array(values, pa.float64()),
    "float32": lambda values: pa.array(values, pa.float64()).cast(pa.float32(), safe=False),
    "int32": lambda values: pa.array([None if v is None else round(v) for v in values], pa.int32()),
    "text": lambda values: pa.array([None if v is None else text(v) for v in values]),
    "large_text": lambda values: pa.array([None if v is None else text(v) for v in values], pa.large_string()),
    "dictionary": lambda values: pa.array([None if v is None else text(v) for v in values]).dictionary_encode(),
}
INSTANTS = {
    "microseconds": lambda values: pa.array(values, pa.timestamp("us")),
    "nanoseconds": lambda values: pa.array(values, pa.timestamp("ns", "UTC")),
    "seconds": lambda values: pa.array(values, pa.timestamp("s")),
    "text": lambda values: pa.array([text(v) for v in values]),
}
FAULTS = ["none", "null", "infinite", "word", "sentinel", "time back", "no tail", "blank tail"]


@settings(max_examples=300, deadline=None)
@given(
    rows=st.integers(800, 1000),
    wobble=st.floats(0, 2),
    kinds=st.lists(st.sampled_from(sorted(KINDS)), min_size=len(NUMBERS), max_size=len(NUMBERS)),
    instants=st.sampled_from(sorted(INSTANTS)),
    fault=st.sampled_from(FAULTS),
    place=st.tuples(st.integers(0, 10_000), st.sampled_from(sorted(NUMBERS))),
    more=st.sampled_from(["", "bad_rows: LeaveRowOut,", 'not_available: ["NaN", "-999"],']),
    cut=st.integers(0, 1000),
)
@pytest.mark.filterwarnings("ignore::cruisefit.DataWarning")
def test_random_recordings_across_types(rows, wobble, kinds, instants, fault, place, more, cut):
    columns = recording(rows, wobble)
    row, name = place[0] % rows, place[1]
    by_name = dict(zip(NUMBERS, kinds))
    if fault == "null":
        columns[name][row] = None
    elif fault == "infinite":
        columns[name][row], by_name[name] = float("inf"), "float64"
    elif fault == "word":
        columns[name][row], by_name[name] = "n/a", "text"
    elif fault == "sentinel":
        columns[name][row] = -999.0
    elif fault == "time back":
        columns["utc"][row] = BEGINNING - datetime.timedelta(seconds=5)
    elif fault == "no tail":
        columns["tail"][row] = None
    elif fault == "blank tail":
        columns["tail"][row] = " D-ABCD "
    arrays = {name: pa.array(values) for name, values in columns.items() if name not in NUMBERS and name != "utc"}
    arrays["utc"] = INSTANTS[instants](columns["utc"])
    arrays |= {name: KINDS[kind](columns[name]) for name, kind in by_name.items()}
    table = pa.table({name: arrays[name] for name in columns})
    for name, kind in by_name.items():
        if kind in ("float32", "int32"):  # what the table holds
            held = table.column(name).to_pylist()
            columns[name] = [None if v is None else float(v) if kind == "float32" else v for v in held]
    table = pa.concat_tables([table.slice(0, cut), table.slice(cut)])
    # A time without a zone is a text without one, whose offset the mapping has.
    zone = "Z" if instants in ("nanoseconds", "text") else ""
    read = assert_same(table, columns, MAPPING.format(more=more), zone)
    if fault == "none" and "int32" not in kinds:
        assert read.flights.column("flight").to_pylist() == ["XX1", "XX,2"]


def test_the_separators_of_a_mappings_files_are_not_those_of_a_table():
    columns = recording(900, 1.0)
    mapping = MAPPING.format(more="")
    theirs = MAPPING.format(more='separator: \';\', decimal: \',\', units_row: true, comment: \'#\',')
    expected = assert_same(pa.table(columns), columns, mapping)
    assert len(expected.flights.column("flight")) == 2
    for frame in (pl.DataFrame(columns), pd.DataFrame(columns)):
        found = cruisefit.segment(frame, mapping=theirs, name="recording.csv")
        assert found.state().equals(expected.state())


def test_a_long_table_is_read_in_stretches():
    columns = recording(150_000, 1.0)
    read = assert_same(pa.table(columns), columns, MAPPING.format(more=""))
    assert read.flights.column("samples").to_pylist() == [100_000, 50_000]
    columns["mach"][149_990] = "x"
    columns["mach"] = [text(value) for value in columns["mach"]]
    read = assert_same(pa.table(columns), columns, MAPPING.format(more=""))
    assert [(one.line, one.found) for one in read.refused] == [(149_992, '"x"')]
