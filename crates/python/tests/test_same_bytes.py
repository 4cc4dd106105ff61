"""Every result is that of the command line, to the bit."""

from __future__ import annotations

import json
from typing import get_args

import pyarrow.csv
import pytest

import cruisefit
from cruisefit._pages import DiagnosisChart, TailChart


@pytest.fixture(scope="module")
def models(run, fixture, tmp_path_factory):
    folder = tmp_path_factory.mktemp("models")
    run("init", "--aircraft", fixture / "AIRCRAFT.ron", "--guide", fixture / "guide.csv",
        "-o", folder / "initial.ron")
    return folder


def test_initial(fixture, models):
    model = cruisefit.Model.initial(fixture / "AIRCRAFT.ron", fixture / "guide.csv")
    assert model.to_text() == (models / "initial.ron").read_text()
    loaded = cruisefit.Model.load(models / "initial.ron")
    loaded.save(models / "again.ron")
    assert (models / "again.ron").read_bytes() == (models / "initial.ron").read_bytes()


def test_segments(run, fixture, tmp_path):
    run("segment", fixture / "reports", "-o", tmp_path / "segments.csv")
    segments = cruisefit.segment(fixture / "reports")
    assert segments.to_csv() == (tmp_path / "segments.csv").read_bytes()
    # Bytes in place of paths, one thread in place of many, and there and back through a table.
    files = sorted((fixture / "reports").rglob("*.txt"))
    assert files
    from_bytes = cruisefit.segment([(str(f), f.read_bytes()) for f in files], threads=1)
    assert from_bytes.to_csv() == segments.to_csv()
    assert cruisefit.Segments.from_state(segments.state()).to_csv() == segments.to_csv()


ARGUMENTS = {
    "g": "1.txt .2.txt .hidden/3.txt deep/4.RPT deep/er/5.txt linked/6.txt night/7.txt",
    "g/**/*.txt": "1.txt .2.txt .hidden/3.txt deep/er/5.txt linked/6.txt night/7.txt night/segments/8.txt",
    "g/*.txt": "1.txt .2.txt",
    "g/*": "1.txt .2.txt .hidden/3.txt deep/4.RPT deep/er/5.txt linked/6.txt night/7.txt",
    "g/*/er": "deep/er/5.txt",
    "g/deep/loop": "deep/4.RPT deep/er/5.txt",
    "g/night/segments": "night/segments/8.txt",
}


@pytest.mark.parametrize("argument", sorted(ARGUMENTS))
def test_an_argument_stands_for_the_same_files(run, tmp_path, argument):
    """Folders, patterns, hidden files, links, and a folder that `adapt` wrote, whose tables are no reports."""
    from conftest import FIXTURES

    reports = sorted((FIXTURES / "ghazi-2020" / "reports").rglob("*.txt"))
    names = sorted({name for names in ARGUMENTS.values() for name in names.split()})
    folder = tmp_path / "g"
    for name, report in zip(names, reports):
        file = folder / name if not name.startswith("linked") else tmp_path / "elsewhere" / "6.txt"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(report.read_bytes())
    (folder / "deep" / "readme.md").write_text("none")
    (folder / "night" / "STATE.ron").write_text("none")
    (folder / "linked").symlink_to(tmp_path / "elsewhere")
    if "*" not in argument:
        (folder / "deep" / "loop").symlink_to(".")
    segments = cruisefit.segment(tmp_path / argument)
    paths = segments.flights.column("path").to_pylist()
    expected = {f"g/{name}" for name in ARGUMENTS[argument].split()}
    assert {path.removeprefix(f"{tmp_path}/").replace("/loop/", "/") for path in paths} == expected
    run("segment", tmp_path / argument, "-o", tmp_path / "segments.csv")
    assert segments.to_csv() == (tmp_path / "segments.csv").read_bytes()
    assert cruisefit.segment([tmp_path / argument, str(tmp_path / argument)]).to_csv() == segments.to_csv()


def test_a_pattern_that_is_none_is_refused(tmp_path):
    with pytest.raises(cruisefit.InputError, match="Pattern syntax error"):
        cruisefit.segment(tmp_path / "a[")
    with pytest.raises(FileNotFoundError, match="matches no file"):
        cruisefit.segment(tmp_path / "**" / "*.txt")


@pytest.mark.parametrize("law", ["bayes", "paper"])
def test_adapt(run, fixture, models, tmp_path, law):
    out = tmp_path / "out"
    run("adapt", fixture / "reports", "--model", models / "initial.ron", "--law", law, "-o", out)
    model = cruisefit.Model.load(models / "initial.ron")
    adapted = model.adapt(cruisefit.segment(fixture / "reports"), law=law)
    adapted.write(tmp_path / "here")
    assert_same_folder(tmp_path / "here", out)
    # With what the trim criteria cost, which is known of the flights of this call alone.
    assert adapted.page() == (out / "report.html").read_text()
    assert "trim criteria" in adapted.page()
    again = cruisefit.Adaptation.read(tmp_path / "here")
    assert again.model().to_text() == adapted.model().to_text()
    with pytest.raises(FileExistsError):
        adapted.write(tmp_path / "here")


def assert_same_folder(ours, theirs):
    """STATE.ron, models, segments, flights, summary and page: every file but the lock."""
    files = [
        {p.relative_to(folder) for p in folder.rglob("*") if p.is_file() and p.name[0] != "."}
        for folder in (ours, theirs)
    ]
    assert files[0] == files[1] and len(files[0]) >= 6
    for path in files[0]:
        assert (ours / path).read_bytes() == (theirs / path).read_bytes(), path


def test_a_folder_of_the_package_goes_on_at_the_command_line(run, fixture, models, tmp_path):
    files = sorted((fixture / "reports").rglob("*.txt"))
    first, second = files[: len(files) // 2], files[len(files) // 2 :]
    cruisefit.Model.load(models / "initial.ron").adapt(cruisefit.segment(first)).write(tmp_path / "ours")
    for out, nights in ((tmp_path / "ours", [second]), (tmp_path / "theirs", [first, second])):
        for night in nights:
            run("adapt", *night, "--model", models / "initial.ron", "-o", out)
    for name in ("summary.json", "STATE.ron"):
        ours, theirs = ((tmp_path / whose / name).read_text() for whose in ("ours", "theirs"))
        assert ours == theirs, name


def test_a_changed_file_of_a_folder_is_refused(initial, segments, tmp_path):
    initial.adapt(segments).write(tmp_path / "folder")
    table = next((tmp_path / "folder" / "segments").iterdir())
    table.write_bytes(table.read_bytes() + b"\n")
    with pytest.raises(cruisefit.InputError, match="SHA-256") as caught:
        cruisefit.Adaptation.read(tmp_path / "folder")
    assert caught.value.file == str(table)


def test_copies_and_contradictions(run, fixture, models, tmp_path):
    """A copy under another name, and a flight with another content: as the command line has them."""
    reports = tmp_path / "reports"
    reports.mkdir()
    files = sorted((fixture / "reports").rglob("*.txt"))[:4]
    for number, file in enumerate(files):
        (reports / f"{number}.txt").write_bytes(file.read_bytes())
    (reports / "copy.txt").write_bytes(files[0].read_bytes())
    (reports / "readme.md").write_text("")
    lines = files[1].read_text().splitlines(keepends=True)
    (reports / "other.txt").write_text("".join(lines[:-1]))
    run("adapt", reports, "--model", models / "initial.ron", "-o", tmp_path / "out")
    read = cruisefit.segment(reports)
    adapted = cruisefit.Model.load(models / "initial.ron").adapt(read)
    counted = adapted.summary["reports"]
    assert counted["already_known"] == 0 and counted["copies"] == 1 and counted["other_files"] == 1
    assert len(adapted.refused) == 1
    assert adapted.summary_json() == (tmp_path / "out" / "summary.json").read_bytes()
    run("segment", reports, "-o", tmp_path / "segments.csv")
    assert read.to_csv() == (tmp_path / "segments.csv").read_bytes()


def test_check(run, fixture, models, tmp_path):
    run("check", fixture / "reports", "--model", models / "initial.ron", "--json", tmp_path / "check.json")
    model = cruisefit.Model.load(models / "initial.ron")
    found = cruisefit.check(cruisefit.segment(fixture / "reports"), [model])
    assert found.to_json() == (tmp_path / "check.json").read_bytes()


def test_monitor(run, fixture, models, tmp_path):
    run("adapt", fixture / "reports", "--model", models / "initial.ron", "-o", tmp_path / "out")
    run("monitor", tmp_path / "out", "-o", tmp_path / "monitor", "--fuel-price", 0.8)
    adapted = cruisefit.Model.load(models / "initial.ron").adapt(cruisefit.segment(fixture / "reports"))
    found = adapted.monitor(fuel_price_per_kg=0.8)
    assert found.to_json() == (tmp_path / "monitor" / "monitor.json").read_bytes()
    assert found.page() == (tmp_path / "monitor" / "monitor.html").read_text()
    assert found.table("tails").num_rows == 1
    run("plot", tmp_path / "monitor" / "monitor.json", "-o", tmp_path / "months.svg")
    assert found.plot().svg == (tmp_path / "months.svg").read_text()
    with pytest.raises(cruisefit.InputError):
        adapted.monitor(alert=["height=3"])


def test_adapt_in_two_nights(run, fixture, models, tmp_path):
    files = sorted((fixture / "reports").rglob("*.txt"))
    first, second = files[: len(files) // 2], files[len(files) // 2 :]
    out = tmp_path / "out"
    for night in (first, second):
        run("adapt", *night, "--model", models / "initial.ron", "-o", out)
    model = cruisefit.Model.load(models / "initial.ron")
    begun = model.adapt(cruisefit.segment(first))
    begun.write(tmp_path / "begun")
    for known in (begun, cruisefit.Adaptation.read(tmp_path / "begun")):
        adapted = cruisefit.adapt(cruisefit.segment(second), [model], begun=known)
        assert adapted.summary_json() == (out / "summary.json").read_bytes()
        for path in (out / "models").iterdir():
            assert adapted.model(path.stem).to_text() == path.read_text()


@pytest.mark.parametrize("law", ["initial", "bayes"])
def test_predict(run, fixture, models, tmp_path, law):
    model = cruisefit.Model.load(models / "initial.ron")
    if law == "bayes":
        model = next(iter(model.adapt(cruisefit.segment(fixture / "reports")).models.values()))
    model.save(tmp_path / "model.ron")
    run("predict", "--model", tmp_path / "model.ron", fixture / "static.csv", "-o", tmp_path / "out.csv")
    expected = pyarrow.csv.read_csv(tmp_path / "out.csv")
    points = pyarrow.csv.read_csv(fixture / "static.csv")
    predicted = model.predict(points)
    assert predicted.column_names == expected.column_names
    for name in expected.column_names[points.num_columns :]:
        # The command line writes the shortest decimals that read back to the same bits.
        ours = [None if value is None else float(value) for value in predicted.column(name).to_pylist()]
        theirs = [None if value is None else float(value) for value in expected.column(name).to_pylist()]
        assert ours == theirs, name


def test_evaluate(run, fixture, models, tmp_path):
    run("evaluate", fixture / "reports", "--model", models / "initial.ron", "--json", tmp_path / "out.json")
    model = cruisefit.Model.load(models / "initial.ron")
    evaluation = model.evaluate(cruisefit.segment(fixture / "reports"))
    assert evaluation.summary_json() == (tmp_path / "out.json").read_bytes()


def test_diagnose(run, fixture, models, tmp_path):
    run("diagnose", fixture / "reports", "--model", models / "initial.ron", "-o", tmp_path)
    model = cruisefit.Model.load(models / "initial.ron")
    diagnosis = model.diagnose(cruisefit.segment(fixture / "reports"))
    assert diagnosis.to_json() == (tmp_path / "diagnosis.json").read_text()
    assert diagnosis.page() == (tmp_path / "diagnosis.html").read_text()
    run("plot", tmp_path, "-o", tmp_path / "both.svg")
    assert diagnosis.plot().svg == (tmp_path / "both.svg").read_text()
    run("plot", tmp_path, "--chart", "gap-map", "-o", tmp_path / "map.svg")
    tail = diagnosis.diagnoses[0].tail
    assert diagnosis.plot("gap-map", tails=tail).svg == (tmp_path / "map.svg").read_text()
    with pytest.raises(cruisefit.InputError) as refused:
        diagnosis.plot("map")
    assert refused.value.expected == "one of " + ", ".join(get_args(DiagnosisChart))


def test_merge(run, fixture, models, tmp_path):
    files = sorted((fixture / "reports").rglob("*.txt"))
    halves = [files[::2], files[1::2]]
    model = cruisefit.Model.load(models / "initial.ron")
    parts = [model.adapt(cruisefit.segment(half)).model() for half in halves]
    for number, part in enumerate(parts):
        part.save(tmp_path / f"{number}.ron")
    run("merge", tmp_path / "0.ron", tmp_path / "1.ron", "-o", tmp_path / "merged.ron")
    assert cruisefit.merge(parts).to_text() == (tmp_path / "merged.ron").read_text()


def test_the_demonstration(run, demonstration, tmp_path):
    """A model with a remainder, and a tail a year later with an effect that it has not learnt."""
    model_file = next((demonstration).rglob("models/*.ron"))
    later = next(path for path in demonstration.rglob("*") if path.is_dir() and "later" in path.name)
    run("diagnose", later, "--model", model_file, "-o", tmp_path)
    diagnosis = cruisefit.Model.load(model_file).diagnose(cruisefit.segment(later))
    assert diagnosis.to_json() == (tmp_path / "diagnosis.json").read_text()
    assert diagnosis.to_dict()["schema"] == "cruisefit.diagnosis/1"


def test_one_process_at_a_time_writes_a_folder(fixture, models, tmp_path):
    """Python and the command line keep each other out by the same lock."""
    import os
    import subprocess

    from conftest import command_line

    from cruisefit._folder import folder_lock

    initial = models / "initial.ron"
    adapted = cruisefit.Model.load(initial).adapt(cruisefit.segment(fixture / "reports"), law="paper")
    folder = tmp_path / "folder"
    folder.mkdir()
    with folder_lock(folder):
        with pytest.raises(BlockingIOError, match=f"process {os.getpid()} on "):
            adapted.write(folder)
        command = [command_line(), "adapt", fixture / "reports", "--model", initial, "--law", "paper", "-o", folder]
        refused = subprocess.run(command, capture_output=True, text=True, check=False)
        assert refused.returncode == 2 and f"process {os.getpid()} on " in refused.stderr
    assert list(folder.iterdir()) == []
    adapted.write(folder)
    assert not any(file.name.startswith(".") for file in folder.iterdir())
    taken_up = subprocess.run(command, capture_output=True, text=True, check=False)
    assert taken_up.returncode == 0, taken_up.stderr


def test_topics_are_explained_in_the_same_words(run):
    for topic in ("tsfc_engine_2", "FQ", "airbus-report-02", "outside_library"):
        assert cruisefit.explain(topic) == run("explain", topic)
    assert repr(cruisefit.explain()) == run("explain").replace("cruisefit explain TOPIC", "cruisefit.explain(TOPIC)", 1)
    with pytest.raises(cruisefit.InputError, match="did you mean tsfc_engine_2"):
        cruisefit.explain("tsfc_engine2")


def test_charts_and_public_models(run, fixture, models, tmp_path):
    model = cruisefit.Model.load(models / "initial.ron")
    run("plot", models / "initial.ron", "-o", tmp_path / "model.svg")
    model.plot().save(tmp_path / "here.svg")
    assert (tmp_path / "here.svg").read_bytes() == (tmp_path / "model.svg").read_bytes()
    adapted = model.adapt(cruisefit.segment(fixture / "reports"), law="paper")
    adapted.write(tmp_path / "folder")
    run("plot", tmp_path / "folder", "-o", tmp_path / "tail.svg")
    assert adapted.plot(adapted.tails[0])._repr_svg_() == (tmp_path / "tail.svg").read_text()

    run("plot", tmp_path / "folder", "--chart", "surface,relief", "-o", tmp_path / "two.svg")
    two = adapted.plot(adapted.tails[0], charts=["surface", "relief"])
    assert two.svg == (tmp_path / "two.svg").read_text()
    run("plot", models / "initial.ron", "--chart", "polar", "-o", tmp_path / "polar.png")
    model.plot("polar").save(tmp_path / "here.png")
    assert (tmp_path / "here.png").read_bytes() == (tmp_path / "polar.png").read_bytes()
    model.plot("polar").save(tmp_path / "here.pdf")
    assert (tmp_path / "here.pdf").read_bytes().startswith(b"%PDF-")
    with pytest.raises(cruisefit.InputError, match=r"ends in \.svg, \.png or \.pdf"):
        two.save(tmp_path / "two.jpg")
    with pytest.raises(cruisefit.InputError, match="nothing of what was asked for"):
        model.plot("histogram")
    with pytest.raises(cruisefit.InputError) as refused:
        model.plot("surfaces")
    # The names that types know are those of the library.
    assert refused.value.expected == "one of " + ", ".join(get_args(TailChart))

    group = {"denied": "exact", "background": "clean", "times": 1.0}
    group["scores"] = {"confusion": {"drag_factor": {"drag_factor": 3, "no_gap": 1}}}
    trials = tmp_path / "trials.json"
    trials.write_text(json.dumps({"schema": "cruisefit.trials/1", "groups": [group]}))
    run("plot", trials, "-o", tmp_path / "trials.svg")
    assert cruisefit.plot_trials(trials).svg == (tmp_path / "trials.svg").read_text()
    with pytest.raises(cruisefit.InputError, match=r"trials\.json"):
        cruisefit.plot_trials(models / "initial.ron")

    run("guide", "--type", "b738", "-o", tmp_path)
    run("init", "--aircraft", tmp_path / "AIRCRAFT.ron", "--guide", tmp_path / "guide.csv", "-o", tmp_path / "B738.ron")
    assert cruisefit.Model.of_type("b738").to_text() == (tmp_path / "B738.ron").read_text()
    assert ("A320", 68) in [(code, len(cruisefit.types())) for code, _, _ in cruisefit.types()]
    with pytest.raises(cruisefit.InputError, match="types"):
        cruisefit.Model.of_type("X999")


def test_a_first_mapping(run, tmp_path):
    from conftest import FIXTURES

    path = FIXTURES / "a320-traffic" / "fuelflow_a320.csv.gz"
    text = cruisefit.mapping(path)
    assert text == run("mapping", path) and "// ?" in text
    table = pyarrow.csv.read_csv(path)
    assert "// ?" in cruisefit.mapping(table)
