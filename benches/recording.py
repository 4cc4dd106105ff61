"""A recording of ten million rows: this program forming its segments, next to polars and DuckDB forming the same one-minute means.

    PYTHON_WITH_POLARS_AND_DUCKDB benches/recording.py make FOLDER [--flights 500]
    PYTHON_WITH_POLARS_AND_DUCKDB benches/recording.py run FOLDER [--runs 3] [--binary target/release/cruisefit]

`make` writes `recording.csv` (1 GB), `recording.parquet` (Snappy, row groups of 2^20 rows) and `recording.ron`: flights of 20 000 s at one
row a second, climb, two levels and descent, thirteen columns, drawn with seed 1. `run` alternates the programs; the peers stream and
form the mean of every column for each flight and minute in cruise (above 25 000 ft), which is the least of what this program does.
Printed are the best wall time, the processor time of that run and the largest resident memory of each.
"""
import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import time

NUMBERS = ["alt_ft", "mach", "tas_kt", "gs_kt", "sat_degc", "roll_deg", "n2_1", "n2_2", "ff1_kg_h", "ff2_kg_h", "gw_kg"]
MAPPING = """(
    format: 1,
    aircraft: Text("A320"),
    tail: Column("tail"),
    flight: Column("flight"),
    time: Timestamp(column: "utc", utc_offset: "Z"),
    quantities: {
        "ALT": Recorded(column: "alt_ft", unit: "ft"),
        "MACH": Recorded(column: "mach", unit: "-"),
        "VTAS": Recorded(column: "tas_kt", unit: "kt"),
        "GSPD": Recorded(column: "gs_kt", unit: "kt"),
        "SAT": Recorded(column: "sat_degc", unit: "degC"),
        "ROLL": Recorded(column: "roll_deg", unit: "deg"),
        "N2(1)": Recorded(column: "n2_1", unit: "%"),
        "N2(2)": Recorded(column: "n2_2", unit: "%"),
        "WF(1)": Recorded(column: "ff1_kg_h", unit: "kg/h"),
        "WF(2)": Recorded(column: "ff2_kg_h", unit: "kg/h"),
    },
    mass: GrossMass(column: "gw_kg", unit: "kg", largest_rise_kg: 50),
    cruise: (minimum_pressure_altitude_ft: 25000, band_ft: 200, minimum_duration_s: 900, trim_s: 60),
)
"""


def flight(number, rows=20_000):
    import datetime

    import numpy as np
    import polars as pl

    draw = np.random.default_rng([1, number])
    second = np.arange(rows, dtype=float)
    levels = [34_000 + 1000 * (number % 3), 36_000 + 1000 * (number % 3)]
    altitude = np.interp(second, [0, 1500, 9500, 9700, 18_000, rows], [1500, levels[0], levels[0], levels[1], levels[1], 1500])
    share = np.clip((altitude - 1500) / 32_500, 0, 1)
    mach = 0.35 + 0.43 * share + 0.0006 * np.sin(second / 300)
    sat = np.maximum(15 - 1.9812e-3 * altitude, -56.5) + 0.3 * np.sin(second / 2500)
    tas = mach * 38.967854 * np.sqrt(sat + 273.15)
    mass = 70_000 - 2400 * second / 3600 - number % 7 * 500
    flow = (1200 - 6e-3 * (70_000 - mass)) * np.where(np.gradient(altitude) > 1, 2.0, np.where(np.gradient(altitude) < -1, 0.4, 1.0))
    start = datetime.datetime(2024, 1, 1) + datetime.timedelta(hours=8 * number)

    def noisy(values, deviation, digits):
        return np.round(values + draw.normal(0, deviation, rows), digits)

    return pl.DataFrame({
        "utc": pl.Series([start]).new_from_index(0, rows)
        + pl.Series((second * 1e6).astype("int64")).cast(pl.Duration("us")),
        "tail": pl.Series([f"F-T{number % 20:03d}"]).new_from_index(0, rows),
        "flight": pl.Series([f"XX{number:04d}"]).new_from_index(0, rows),
        "alt_ft": noisy(altitude, 4, 0),
        "mach": noisy(mach, 2e-4, 4),
        "tas_kt": noisy(tas, 0.1, 1),
        "gs_kt": noisy(tas + 20 * np.sin(second / 6000), 0.1, 1),
        "sat_degc": noisy(sat, 0.05, 1),
        "roll_deg": noisy(0 * second, 0.1, 1),
        "n2_1": noisy(90 + 0 * second, 0.05, 1),
        "n2_2": noisy(90.2 + 0 * second, 0.05, 1),
        "ff1_kg_h": noisy(flow, 4, 1),
        "ff2_kg_h": noisy(flow, 4, 1),
        "gw_kg": np.round(mass, 1),
    })


def make(folder, flights):
    import pyarrow
    import pyarrow.parquet

    folder.mkdir(parents=True, exist_ok=True)
    (folder / "recording.ron").write_text(MAPPING)
    writer, waiting = None, []
    with open(folder / "recording.csv", "wb") as text:
        for number in range(flights):
            rows = flight(number)
            rows.write_csv(text, include_header=number == 0, datetime_format="%Y-%m-%dT%H:%M:%SZ")
            table = rows.to_arrow()
            writer = writer or pyarrow.parquet.ParquetWriter(folder / "recording.parquet", table.schema, compression="snappy")
            waiting.append(table)
            if len(waiting) == 50 or number == flights - 1:
                writer.write_table(pyarrow.concat_tables(waiting), row_group_size=1 << 20)
                waiting = []
    writer.close()


def peer_polars(path):
    import polars as pl

    frame = pl.scan_parquet(path) if path.suffix == ".parquet" else pl.scan_csv(path, try_parse_dates=True)
    minute = pl.col("utc").dt.truncate("1m").alias("minute")
    query = frame.filter(pl.col("alt_ft") > 25_000).group_by("tail", "flight", minute).agg([pl.col(name).mean() for name in NUMBERS])
    return len(query.collect(engine="streaming"))


def peer_duckdb(path):
    import duckdb

    means = ", ".join(f"avg({name})" for name in NUMBERS)
    query = f"select tail, flight, date_trunc('minute', utc) as minute, {means} from '{path}' where alt_ft > 25000 group by all"
    return duckdb.sql(f"select count(columns(*)) from ({query})").fetchall()[0][0]


def measure(command):
    began = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    told = process.stderr.read()
    _, status, used = os.wait4(process.pid, 0)
    if status:
        print(f"{command[0]}: {told.decode().strip().splitlines()[-1]}", file=sys.stderr)
        return None
    return time.monotonic() - began, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def run(folder, runs, binary):
    for file in ["recording.csv", "recording.parquet"]:
        path = folder / file
        with path.open("rb") as beginning:  # into the page cache
            while beginning.read(1 << 24):
                pass
        ours = [binary, "segment", "--mapping", folder / "recording.ron", path, "-o", folder / "segments.csv"]
        peers = {name: [sys.executable, __file__, "peer", name, path] for name in ["polars", "duckdb"]}
        programs = {"cruisefit": ours, **peers}
        found = {name: [] for name in programs}
        for _ in range(runs):
            for name, command in programs.items():
                found[name].append(measure(command))
        for name, measured in found.items():
            measured = [one for one in measured if one]
            if not measured:
                continue
            wall_s, processor_s, _ = min(measured)
            memory_mib = max(one[2] for one in measured)
            print(f"{file:18} {name:10} {wall_s:7.2f} s wall {processor_s:7.2f} s processor {memory_mib:7.0f} MiB")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("what", choices=["make", "run", "peer"])
    parser.add_argument("folder")
    parser.add_argument("path", nargs="?", type=pathlib.Path)
    parser.add_argument("--flights", type=int, default=500)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--binary", default=pathlib.Path(__file__).resolve().parent.parent / "target/release/cruisefit")
    asked = parser.parse_args()
    if asked.what == "make":
        make(pathlib.Path(asked.folder), asked.flights)
    elif asked.what == "run":
        run(pathlib.Path(asked.folder), asked.runs, asked.binary)
    else:
        print(json.dumps({"polars": peer_polars, "duckdb": peer_duckdb}[asked.folder](asked.path)))


if __name__ == "__main__":
    main()
