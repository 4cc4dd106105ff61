"""Recordings in files of every kind: what the command line makes of them, to the byte."""

from __future__ import annotations

import datetime
import decimal
import gzip
import io
import random

import polars as pl
import pyarrow as pa
import pyarrow.feather as feather
import pyarrow.parquet as pq
import pytest

import cruisefit
from conftest import FIXTURES
from test_recordings import BEGINNING, MAPPING, as_text, recording

LAYOUTS = FIXTURES / "layouts"
COLUMNAR = sorted(path.name for path in LAYOUTS.iterdir() if path.suffix in (".parquet", ".arrow", ".arrows"))
RULE = MAPPING.format(more="bad_rows: LeaveRowOut,")


def zstandard(content: bytes) -> bytes:
    """Two frames, as a program that appends writes them."""
    return b"".join(pa.compress(part, "zstd", asbytes=True) for part in (content[:1000], content[1000:]))


def arrow(table: pa.Table, new: object, **options: object) -> bytes:
    sink = pa.BufferOutputStream()
    with new(sink, table.schema, options=pa.ipc.IpcWriteOptions(**options)) as writer:
        writer.write_table(table, max_chunksize=400)
    return sink.getvalue().to_pybytes()


def feather_of(table: pa.Table) -> bytes:
    sink = pa.BufferOutputStream()
    feather.write_feather(table, sink)
    return sink.getvalue().to_pybytes()


def parquet(table: pa.Table, **options: object) -> bytes:
    sink = pa.BufferOutputStream()
    pq.write_table(table, sink, row_group_size=350, **options)
    return sink.getvalue().to_pybytes()


def polars_parquet(table: pa.Table) -> bytes:
    sink = io.BytesIO()
    pl.DataFrame(table).write_parquet(sink)
    return sink.getvalue()


FORMS = {
    "rows.csv": lambda table, text: text,
    "rows.csv.gz": lambda table, text: gzip.compress(text),
    "rows.csv.zst": lambda table, text: zstandard(text),
    "rows.parquet": lambda table, text: parquet(table),
    "int96.parquet": lambda table, text: parquet(table, use_deprecated_int96_timestamps=True),
    "plain.parquet": lambda table, text: parquet(table, use_dictionary=False, store_schema=False, version="1.0"),
    "polars.parquet": lambda table, text: polars_parquet(table),
    "rows.arrow": lambda table, text: arrow(table, pa.ipc.new_file),
    "rows.ipc": lambda table, text: arrow(table, pa.ipc.new_file, compression="zstd"),
    "rows.arrows": lambda table, text: arrow(table, pa.ipc.new_stream, compression="lz4"),
    "rows.feather": lambda table, text: feather_of(table),
}


@pytest.mark.parametrize("name", COLUMNAR)
def test_files_of_every_codec_are_read_as_by_the_command_line(run, name, tmp_path):
    """The first mapping, and the segments by it."""
    path = LAYOUTS / name
    rule = cruisefit.mapping(path)
    assert rule == run("mapping", path)
    assert cruisefit.mapping(path.read_bytes()) == rule
    (tmp_path / "M.ron").write_text(rule)
    told = run("segment", "--mapping", tmp_path / "M.ron", path)
    read = cruisefit.segment(path, mapping=rule)
    assert len(read) > 0 and read.to_csv().decode() == told


@pytest.mark.parametrize("form", sorted(FORMS))
def test_every_form_is_the_recording(run, form, tmp_path):
    """As its text, whatever else is in the file, and the same in memory; by one thread or several."""
    columns = recording(1500, 1.0)
    columns["mach"][700] = None
    table = pa.table(columns).append_column("other", pa.array([[1, 2]] * 1500))
    if form.endswith(("csv", "gz", "zst")):
        table = pa.table(columns)
    path = tmp_path / form
    path.write_bytes(FORMS[form](table, as_text(columns, "Z")))
    with pytest.warns(cruisefit.DataWarning):  # a row was left out
        read = cruisefit.segment(path, mapping=RULE, criteria="airbus-report-02")
    assert len(read) > 0 and read.flights.column("samples").to_pylist() == [999, 500]
    (tmp_path / "M.ron").write_text(RULE)
    told = run("segment", "--mapping", tmp_path / "M.ron", "--criteria", "airbus-report-02", path)
    assert read.to_csv().decode() == told
    by_text = cruisefit.segment((str(path), as_text(columns, "Z")), mapping=RULE, criteria="airbus-report-02")
    in_memory = cruisefit.segment((str(path), path.read_bytes()), mapping=RULE, criteria="airbus-report-02", threads=1)
    for other in (by_text, in_memory):
        assert other.state().equals(read.state())


def test_types_that_recorders_and_databases_write(run, tmp_path):
    """Days and times of day, categories, decimals, truth values, counts, texts that are not marked as such, NaN and null."""
    columns = recording(900, 1.0)
    instants = columns.pop("utc")
    mapping = RULE.replace(
        'Timestamp(column: "utc", utc_offset: "Z")',
        'Timestamp(column: "time", date: "day", format: "%Y-%m-%d %H:%M:%S%.f", utc_offset: "Z")',
    )
    columns["alt_ft"] = [35_000.0] * 900
    columns["gs_kt"][5] = float("nan")
    table = pa.table({
        **columns,
        "day": pa.array([instant.date() for instant in instants]),
        "time": pa.array([instant.time() for instant in instants], pa.time64("us")),
        "tail": pa.array(columns["tail"]).dictionary_encode(),
        "flight": pa.array([flight.encode() for flight in columns["flight"]]),
        "alt_ft": pa.array([35_000] * 900, pa.int64()),
        "mach": pa.array([decimal.Decimal("0.78")] * 900, pa.decimal128(4, 2)),
        "sat_degc": pa.array([-56.5] * 450 + [None] * 2 + [-56.5] * 448, pa.float32()),
    })
    path = tmp_path / "rows.parquet"
    # As Spark and DuckDB store decimals.
    pq.write_table(table, path, store_decimal_as_integer=True)
    with pytest.warns(cruisefit.DataWarning):
        read = cruisefit.segment(path, mapping=mapping, criteria="airbus-report-02")
    assert read.flights.column("samples").to_pylist() == [597, 300]
    (tmp_path / "M.ron").write_text(mapping)
    told = run("segment", "--mapping", tmp_path / "M.ron", "--criteria", "airbus-report-02", path)
    assert len(read) > 0 and read.to_csv().decode() == told
    # A type that cannot be read is refused where the mapping asks for it, and by its name.
    pq.write_table(table.set_column(table.schema.get_field_index("mach"), "mach", pa.array([[0.78]] * 900)), path)
    with pytest.warns(cruisefit.DataWarning, match="rows.parquet"):
        (refused,) = cruisefit.segment(path, mapping=mapping).refused
    assert "mach" in refused.reason


def test_no_recording_of_a_folder_is_skipped(run, tmp_path):
    """Each file of a mixed folder is read, or refused by its name; what is no recording is counted where nothing is left."""
    columns, parts = recording(1500, 1.0), tmp_path / "parts"
    (parts / "deep").mkdir(parents=True)
    later = recording(1500, 1.0)
    later["utc"] = [instant + datetime.timedelta(days=1) for instant in later["utc"]]
    later["tail"] = ["D-EFGH"] * 1500
    (parts / "a.parquet").write_bytes(parquet(pa.table(columns)))
    (parts / "deep" / "B.CSV.ZST").write_bytes(zstandard(as_text(later, "Z")))
    (parts / "c.arrow").write_bytes(parquet(pa.table(columns))[:-200])
    (parts / "d.parquet").write_bytes(random.Random(1).randbytes(300))
    (parts / "notes.md").write_text("no recording")
    (tmp_path / "M.ron").write_text(RULE)
    with pytest.warns(cruisefit.DataWarning, match="c.arrow"):
        read = cruisefit.segment(parts, mapping=tmp_path / "M.ron", criteria="airbus-report-02")
    assert read.tails == ["D-ABCD", "D-EFGH"] and len(read.flights) == 4
    assert sorted(one.path for one in read.refused) == [str(parts / "c.arrow"), str(parts / "d.parquet")]
    told = run("segment", "--mapping", tmp_path / "M.ron", "--criteria", "airbus-report-02", parts)
    assert read.to_csv().decode() == told
    one = cruisefit.segment(parts, mapping=RULE, criteria="airbus-report-02", threads=1)
    assert one.state().equals(read.state())
    for path in parts.rglob("*.*"):
        if path.suffix != ".md":
            path.unlink()
    with pytest.raises(cruisefit.InputError, match="found no cruise report in .*parts, .*skipped for their endings: 1"):
        cruisefit.segment(parts, mapping=RULE)


def test_without_pyarrow_the_file_and_the_package_are_named(monkeypatch, tmp_path):
    path = tmp_path / "rows.parquet"
    path.write_bytes(parquet(pa.table(recording(900, 1.0))))
    (tmp_path / "rows.csv").write_bytes(as_text(recording(900, 1.0), "Z"))
    monkeypatch.setattr(cruisefit.segments.require_pyarrow.__globals__["importlib"].util, "find_spec", lambda name: None)
    with pytest.raises(ModuleNotFoundError, match=r"rows\.parquet: .*pip install pyarrow"):
        cruisefit.segment(tmp_path, mapping=RULE)
    with pytest.raises(ModuleNotFoundError, match=r"rows\.parquet: "):
        cruisefit.mapping(path)
    with pytest.raises(ModuleNotFoundError, match="in memory: "):
        cruisefit.segment([("in memory", path.read_bytes())], mapping=RULE)
    # Text needs none.
    read = cruisefit.Segments.state.__globals__["_native"].Source("ghazi-2020-table-4", RULE)
    assert len(read.files([tmp_path / "rows.csv"], 0, None, 1)) == 2


def test_a_table_of_segments_in_parquet_needs_no_mapping(run, tmp_path, segments):
    run("segment", FIXTURES / "ghazi-2020" / "reports", "-o", tmp_path / "S.parquet")
    run("segment", FIXTURES / "ghazi-2020" / "reports", "-o", tmp_path / "S.csv")
    by_text, by_parquet = (cruisefit.segment(tmp_path / name) for name in ("S.csv", "S.parquet"))
    assert by_parquet.to_csv() == by_text.to_csv() == segments.to_csv()
    with pytest.warns(cruisefit.DataWarning, match="a recording needs mapping="):
        cruisefit.segment(("rows.parquet", parquet(pa.table(recording(900, 1.0)))))


def test_nan_in_a_table_is_missing_as_in_a_file(tmp_path):
    """Every 50th Mach number; an optional column throughout, and in most rows: nothing else changes."""
    columns = recording(1500, 1.0)
    mapping = MAPPING.format(more="").replace(
        '"WF":', '"CG": Recorded(column: "cg", unit: "%MAC", optional: true),\n        "WF":'
    )
    expected = cruisefit.segment(pa.table(columns), mapping=mapping, name="rows.parquet", criteria="airbus-report-02")
    sparse = [28.5 if row % 5 == 0 else float("nan") for row in range(1500)]
    for cg in ([float("nan")] * 1500, sparse):
        table = pa.table({**columns, "cg": cg})
        path = tmp_path / "rows.parquet"
        pq.write_table(table, path)
        by_file = cruisefit.segment(path, mapping=mapping, criteria="airbus-report-02")
        assert by_file.flights.column("samples").to_pylist() == expected.flights.column("samples").to_pylist()
        for frame in (table, pl.DataFrame(table), table.to_pandas()):
            read = cruisefit.segment(frame, mapping=mapping, name=str(path), criteria="airbus-report-02")
            assert read.state().equals(by_file.state()) and not read.refused
    columns["mach"] = [float("nan") if row % 50 == 0 else mach for row, mach in enumerate(columns["mach"])]
    columns["mach"][0] = float("inf")  # no number either, but it is there
    read = [
        cruisefit.segment(frame, mapping=RULE, name="rows.parquet", criteria="airbus-report-02")
        for frame in (pl.DataFrame(columns), ("rows.parquet", parquet(pa.table(columns))))
    ]
    assert read[0].state().equals(read[1].state())
    assert sum(read[0].flights.column("samples").to_pylist()) == 1500 - 30


def test_columns_that_the_mapping_does_not_name_may_be_of_any_type():
    columns = recording(900, 1.0)
    expected = cruisefit.segment(pa.table(columns), mapping=RULE)
    others = {
        "list": [[1]] * 900, "structure": [{"a": 1}] * 900, "duration": [datetime.timedelta(1)] * 900,
        "time": [BEGINNING.time()] * 900, "bytes": [b"1"] * 900,
    }
    table = pa.table({**others, **columns})
    for frame in (table, pl.DataFrame(table)):
        assert cruisefit.segment(frame, mapping=RULE).state().equals(expected.state())
        assert '"structure" ()' in cruisefit.mapping(frame)  # without an example
    # A row that is refused is still written as text.
    columns["mach"][3] = float("inf")
    with pytest.warns(cruisefit.DataWarning):
        (refused,) = cruisefit.segment(pa.table({**columns, **others}), mapping=MAPPING.format(more="")).refused
    assert refused.line == 5
    with pytest.raises(cruisefit.InputError, match="column mach: found type List"):
        cruisefit.segment(table.set_column(table.column_names.index("mach"), "mach", pa.array([[0.78]] * 900)), mapping=RULE)
