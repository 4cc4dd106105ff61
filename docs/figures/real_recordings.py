"""Scoreboard on real recordings: error before and after learning, cross-validated inside the flight, and effects planted in them.

    python3 docs/figures/real_recordings.py BINARY RECORDINGS [--work FOLDER]

RECORDINGS holds the public recordings that docs/src/validation/real_recordings.md names, in folders `traffic_fuelflow_a320`,
`acropole_a320_qar` and `phlab_c550_openap`; one that is absent is said to be skipped. Each cruise is cut into blocks of ten minutes;
every other block is learnt, the rest is predicted, and the other way round. Prints the tables of that page.
"""
import argparse
import datetime
import json
import math
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
CRITERIA = "airbus-report-02"
# For planted effects, which need thirty segments of a flight of one or two hours.
LOOSE = HERE / "real/loose.ron"
PRESETS = HERE.parents[1] / "crates/report/presets"
BLOCK_S = 600
# Three samples of a minute, the least that is a segment.
SHORT_BLOCK_S = 182
RECORDINGS = [
    ("A320 FDR", "traffic_fuelflow_a320", "traffic-a320", "A320"),
    ("A320 QAR", "acropole_a320_qar", PRESETS / "acropole_a320.ron", "A320"),
    ("Citation II", "phlab_c550_openap", PRESETS / "phlab_c550.ron", None),
]
# What is planted in the blocks that were not learnt: its name, and a factor (of WF, mass) or a shift (of MACH).
PLANTED = [
    ("nothing", {}),
    ("fuel-flow meter +3 %", {"WF": 1.03}),
    ("gross mass stated 3 % low", {"MASS": 0.97}),
    ("Mach number reads 0.005 high", {"MACH": 0.005}),
]


class Program:
    def __init__(self, binary):
        self.binary = binary

    def __call__(self, *arguments, status=(0,)):
        ran = subprocess.run([self.binary, "--no-progress", *map(str, arguments)], capture_output=True, text=True)
        if ran.returncode not in status:
            sys.exit(f"{' '.join(map(str, arguments))}: status {ran.returncode}\n{ran.stdout}{ran.stderr}")
        return ran


def mapping_for(path, mapping, folder):
    """The mapping; that of a recording whose name ends in an hour gets the hour into its START."""
    hour = path.name.split(".")[0].split("_")[-1]
    if not hour.isdigit() or isinstance(mapping, str):
        return mapping
    written = folder / f"{path.name}.ron"
    written.write_text(mapping.read_text().replace("T00:00:00Z", f"T{hour}:00:00Z"))
    return written


def blocks(report, folder, block_s=BLOCK_S):
    """A report cut into blocks of ten minutes, each a flight of its own; the last one, if shorter, belongs to none."""
    lines = report.read_text().splitlines()
    names = next(index for index, line in enumerate(lines) if line.startswith("TIME "))
    header = [line for line in lines[:names] if not line.startswith(("START", "FLIGHT"))]
    start = next(line.split()[1] for line in lines if line.startswith("START"))
    begin = datetime.datetime.fromisoformat(start.replace("Z", "+00:00"))
    by_block = {}
    for line in lines[names + 2:]:
        time, rest = line.split(" ", 1)
        by_block.setdefault(int(float(time) // block_s), []).append((float(time), rest))
    folder.mkdir(parents=True)
    written = []
    for block, rows in by_block.items():
        if rows[-1][0] - rows[0][0] < 0.9 * block_s:
            continue
        at = (begin + datetime.timedelta(seconds=rows[0][0])).strftime("%Y-%m-%dT%H:%M:%SZ")
        path = folder / f"{block:02}.txt"
        head = [header[0], *header[1:3], f"FLIGHT {block:02}", f"START {at}", *header[3:]]
        path.write_text("\n".join([*head, *lines[names:names + 2], *(f"{time - rows[0][0]:g} {rest}" for time, rest in rows)]) + "\n")
        written.append(path)
    return written


def planted(paths, folder, change):
    """The same blocks, a year later, with an error of a sensor, a meter or a load sheet in their columns."""
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for path in paths:
        lines = path.read_text().splitlines()
        names = next(index for index, line in enumerate(lines) if line.startswith("TIME "))
        columns = lines[names].split()
        for index, line in enumerate(lines):
            words = line.split()
            if index < names and words[0] == "START":
                words[1] = str(int(words[1][:4]) + 1) + words[1][4:]
            if index < names and words[0] in ("ZFW", "FOB") and "MASS" in change:
                words[1] = repr(float(words[1]) * change["MASS"])
            if index > names + 1:
                for place, column in enumerate(columns):
                    if column == "WF" and "WF" in change:
                        words[place] = repr(float(words[place]) * change["WF"])
                    if column == "FU" and "MASS" in change:
                        words[place] = repr(float(words[place]) * change["MASS"])
                    if column == "MACH" and "MACH" in change:
                        words[place] = repr(float(words[place]) + change["MACH"])
            lines[index] = " ".join(words)
        written.append(folder / path.name)
        written[-1].write_text("\n".join(lines) + "\n")
    return written


def errors(program, model, reports, folder, criteria=CRITERIA):
    """Errors of the segments of reports, %."""
    table = folder / "residuals.csv"
    table.unlink(missing_ok=True)
    program("evaluate", *reports, "--model", model, "--criteria", criteria, "-o", table)
    rows = [line.split(",") for line in table.read_text().splitlines() if not line.startswith("#")]
    place = rows[0].index("error_percent")
    return [float(row[place]) for row in rows[1:] if row[place]]


def in_words(values):
    if not values:
        return "–"
    spread = statistics.stdev(values) if len(values) > 1 else math.nan
    return f"{statistics.fmean(values):+.2f} ± {spread:.2f}"


def learn(program, model, reports, law, folder, criteria=CRITERIA):
    shutil.rmtree(folder, ignore_errors=True)
    program("adapt", *reports, "--model", model, "--criteria", criteria, "--law", law, "-o", folder)
    return next((folder / "models").glob("*.ron"))


def findings(program, path, mapping, folder):
    told = folder / "check.json"
    program("check", path, "--mapping", mapping, "--json", told)
    return [(one["code"], one["size"], one["unit"]) for one in json.loads(told.read_text())["findings"]]


def score(program, name, path, mapping, type_code, work):
    folder = work / path.name
    folder.mkdir(parents=True)
    mapping = mapping_for(path, mapping, folder)
    found = "; ".join(f"{code} {size:+.1f} {unit}" for code, size, unit in findings(program, path, mapping, folder)) or "none"
    label = name if type_code else f"{name}, {path.name.split('.')[0]}"
    segments = folder / "segments.csv"
    program("segment", path, "--mapping", mapping, "--criteria", CRITERIA, "-o", segments)
    count = max(0, sum(1 for line in segments.read_text().splitlines() if not line.startswith("#")) - 1)
    if type_code is None:
        print(f"| {label} | none: no public model of the type | {count} | – | – | – | – | {found} |")
        return
    program("guide", "--type", type_code, "-o", folder / "type")
    model = folder / "MODEL.ron"
    program("init", "--aircraft", folder / "type/AIRCRAFT.ron", "--guide", folder / "type/guide.csv", "-o", model)
    program("convert", path, "--mapping", mapping, "-o", folder / "reports")
    report = next((folder / "reports").glob("*.txt"))
    whole = errors(program, model, [report], folder)
    cut = blocks(report, folder / "blocks")
    halves = cut[0::2], cut[1::2]
    after = {}
    for law in ["bayes", "paper"]:
        after[law] = []
        for learnt, unseen in [halves, halves[::-1]]:
            after[law] += errors(program, learn(program, model, learnt, law, folder / law), unseen, folder)
    floor = statistics.stdev(whole) if len(whole) > 1 else math.nan
    cells = [label, f"guide --type {type_code}", str(len(whole)), in_words(whole), in_words(after["bayes"]), in_words(after["paper"]),
             f"{floor:.2f}", found]
    print(f"| {' | '.join(cells)} |")
    return label, model, halves, folder


def effects_found(program, scored):
    """Planted in the blocks that were not learnt; then, for want of segments, in short blocks of all that was learnt."""
    label, model, (learnt, unseen), folder = scored
    short = blocks(next((folder / "reports").glob("*.txt")), folder / "short", SHORT_BLOCK_S)
    for blocks_named, learnt, later, criteria in [
        ("other blocks", learnt, unseen, CRITERIA),
        ("other short blocks", short[0::2], short[1::2], LOOSE),
        ("all short blocks", short, short, LOOSE),
    ]:
        taught = learn(program, model, learnt, "bayes", folder / "taught", criteria)
        for name, change in PLANTED:
            paths = planted(later, folder / "planted", change)
            error = in_words(errors(program, taught, paths, folder, criteria))
            print(f"| {label} | {blocks_named} | {name} | {error} | {verdict(program, taught, paths, folder, criteria)} |")


def verdict(program, model, reports, folder, criteria):
    """The first sentence of the diagnosis."""
    shutil.rmtree(folder / "diagnosis", ignore_errors=True)
    ran = program("diagnose", *reports, "--model", model, "--criteria", criteria, "-o", folder / "diagnosis", status=(0, 1))
    text = " ".join(" ".join(ran.stdout.split("\n")[1:]).split()).split(" Note: ")[0]
    return text.replace("|", "/")[:400]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("binary", type=pathlib.Path)
    parser.add_argument("recordings", type=pathlib.Path)
    parser.add_argument("--work", type=pathlib.Path)
    asked = parser.parse_args()
    program = Program(asked.binary.resolve())
    with tempfile.TemporaryDirectory() as temporary:
        work = asked.work or pathlib.Path(temporary)
        print("| recording | initial model | segments | before | after, bayes | after, paper | scatter | findings of `check` |")
        print("|---|---|---|---|---|---|---|---|")
        scored = []
        for name, folder, mapping, type_code in RECORDINGS:
            paths = sorted((asked.recordings / folder).glob("*.csv.gz"))
            if not paths:
                print(f"skipped: {folder} is not in {asked.recordings}", file=sys.stderr)
            scored += [score(program, name, path, mapping, type_code, work) for path in paths]
        print("\n| recording | planted in | planted | error | what `diagnose` says |\n|---|---|---|---|---|")
        for one in filter(None, scored):
            effects_found(program, one)


if __name__ == "__main__":
    main()
