"""The border between Python and Rust: errors with their place, threads, forks, signals, memory, pickles."""

from __future__ import annotations

import concurrent.futures
import datetime
import multiprocessing
import os
import pickle
import resource
import signal
import threading
import time
import warnings

import pandas as pd
import polars as pl
import pyarrow as pa
import pytest
from conftest import FIXTURES

import cruisefit

POINTS = {"mass_kg": [14000.0], "pressure_altitude_ft": [41000.0], "mach": [0.8]}
REPORT = sorted((FIXTURES / "ghazi-2020" / "reports").rglob("*.txt"))[0]


def test_an_error_has_its_place(initial, tmp_path):
    with pytest.raises(cruisefit.InputError) as caught:
        initial.predict(pa.table({**POINTS, "mach": [8.0]}))
    error = caught.value
    assert (error.line, error.column) == (1, "mach")
    assert (error.found, error.expected) == ('"8"', "0.1 to 0.99 Mach (Mach number)")
    assert isinstance(error, ValueError) and isinstance(error, cruisefit.CruisefitError)
    assert pickle.loads(pickle.dumps(error)).__dict__ == error.__dict__

    with pytest.raises(cruisefit.InputError, match="unknown column"):
        initial.predict(pa.table({**POINTS, "altitude": [1.0]}))
    guide = tmp_path / "guide.csv"
    guide.write_text("weight_lb,pressure_altitude_ft,true_airspeed_kt,fuel_flow_lb_h\n30000,43000,470,x\n")
    with pytest.raises(cruisefit.InputError) as caught:
        cruisefit.Model.initial(FIXTURES / "ghazi-2020" / "AIRCRAFT.ron", guide)
    assert (caught.value.file, caught.value.line, caught.value.column) == (str(guide), 2, "fuel_flow_lb_h")
    assert caught.value.found == '"x"'


def test_a_damaged_model_is_refused(initial):
    damaged = initial.to_text().replace("type_code", "type_kode", 1)
    with pytest.raises(cruisefit.InputError, match="checksum") as caught:
        cruisefit.Model.from_text(damaged, "T-001.ron")
    assert caught.value.file == "T-001.ron"


def test_a_refused_report_has_its_place():
    text = REPORT.read_text().splitlines()
    text[-1] = text[-1].replace(text[-1].split()[1], "abc", 1)
    with pytest.warns(cruisefit.DataWarning, match="refused: bad.txt:.*found \"abc\"") as warned:
        segments = cruisefit.segment([("bad.txt", "\n".join(text).encode()), REPORT])
    assert warned[0].filename == __file__
    (refused,) = segments.refused
    assert (refused.path, refused.line) == ("bad.txt", len(text))
    assert refused.found == '"abc"' and refused.expected is not None
    assert str(refused).startswith(f"bad.txt:{len(text)}:")
    assert len(segments) > 0


@pytest.mark.parametrize("junk", [b"", b"\0", b"\x1f\x8b\x08junk", b"CRUISE-REPORT 1\n" * 3, "ü".encode("latin-1")])
def test_junk_is_refused_not_raised(junk):
    with pytest.warns(cruisefit.DataWarning, match="nothing is left"):
        segments = cruisefit.segment(junk)
    assert len(segments) == 0 and len(segments.refused) == 1


def test_what_is_of_another_type_is_refused_with_what_makes_the_right_one(initial, segments):
    table = pa.table({"a": [1.0]})
    for of in (cruisefit.adapt, cruisefit.evaluate, cruisefit.diagnose):
        with pytest.raises(cruisefit.InputError, match="found Table, expected Segments: cruisefit.segment makes"):
            of(table, [initial])
        for wrong in ("MODEL.ron", [REPORT], 3):
            with pytest.raises(cruisefit.InputError, match="expected Model: Model.load reads"):
                of(segments, wrong)
    one, several = (cruisefit.evaluate(segments, models) for models in (initial, [initial]))
    assert one.summary_json() == several.summary_json()
    lazy = pytest.importorskip("polars").LazyFrame({"mass_kg": [1.0]})
    with pytest.raises(TypeError, match=r"found LazyFrame.*collect\(\) it first"):
        initial.predict(lazy)


def test_options_are_told_as_arguments_of_python(initial, segments):
    adapted = initial.adapt(segments)
    with pytest.warns(cruisefit.DataWarning, match="allow_learnt=True diagnoses it anyway"):
        diagnosis = adapted.model().diagnose(segments)
    assert all("allow_learnt=True" in one.reason for one in diagnosis.refused)
    # The document is that of the command line.
    assert "--allow-learnt" in diagnosis.to_json()


def test_wrong_arguments():
    with pytest.raises(FileNotFoundError):
        cruisefit.segment("nowhere.txt")
    with pytest.raises(cruisefit.InputError, match="criteria"):
        cruisefit.segment(REPORT, criteria="mine")
    with pytest.raises(TypeError):
        cruisefit.Segments.from_table(3, "C750")


def test_criteria_of_a_table_are_those_that_segment_knows(segments):
    refused = "criteria: found \"nonsense\", expected one of .*ghazi-2020-table-4"
    with pytest.raises(cruisefit.InputError, match=refused):
        cruisefit.Segments.from_table(segments.table(), "C750", criteria="nonsense")
    with pytest.raises(cruisefit.InputError, match=refused):
        cruisefit.Segments.from_state(segments.state(), criteria="nonsense")


@pytest.mark.parametrize("engines", [0, -1, 5, 9, 2**70])
def test_a_library_of_no_engines_or_too_many_is_refused(engines):
    assert len(cruisefit.effects(1)) < len(cruisefit.effects(4))
    with pytest.raises(cruisefit.InputError, match=f"engines: found {engines}, expected 1 to 4"):
        cruisefit.effects(engines)


@pytest.mark.parametrize("text", ["[]", "1", '"x"', "null", "{}", '{"groups": 3}'])
def test_what_is_no_trials_json_is_refused(tmp_path, text):
    file = tmp_path / "trials.json"
    file.write_text(text)
    with pytest.raises(cruisefit.InputError, match=r"trials\.json: invalid type"):
        cruisefit.plot_trials(file)


def test_a_path_may_have_parentheses(tmp_path):
    """What is on one line is content where no file has its name."""
    plan = "(seed: 1, aircraft: Preset(citation_x), tails: [(tail: \"T-1\", flights: Designed((flights: 1)))])"
    file = tmp_path / "p(1).ron"
    file.write_text(plan)
    flown = cruisefit.simulate(plan).reports
    assert cruisefit.simulate(str(file)).reports == flown == cruisefit.simulate(file).reports
    (tmp_path / "plan (of one)").write_text(plan)
    assert cruisefit.simulate(str(tmp_path / "plan (of one)")).reports == flown
    with pytest.raises(FileNotFoundError):
        cruisefit.simulate("p(2).ron")
    with pytest.raises(cruisefit.InputError):
        cruisefit.simulate(f"({'x' * 5000})")


def test_threads_of_python_at_once(initial):
    points = pa.table({name: values * 1000 for name, values in POINTS.items()})
    expected = initial.predict(points)
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        for predicted in pool.map(lambda _: initial.predict(points), range(16)):
            assert predicted.equals(expected)


def test_the_lock_is_released_while_it_works(initial):
    points = pa.table({name: values * 300_000 for name, values in POINTS.items()})
    turns, done = 0, threading.Event()

    def work():
        initial.predict(points, threads=1)
        done.set()

    thread = threading.Thread(target=work)
    thread.start()
    while not done.is_set():
        turns += 1
        time.sleep(0.001)
    thread.join()
    assert turns > 3


def _in_child(text):
    model = cruisefit.Model.from_text(text)
    return len(cruisefit.segment(REPORT)), pa.table(model.predict(POINTS)).num_rows


def test_a_fork_after_use(initial, segments):
    initial.predict(POINTS)
    context = multiprocessing.get_context("fork")
    with context.Pool(2) as pool:
        results = pool.map_async(_in_child, [initial.to_text()] * 4).get(timeout=60)
    assert results == [results[0]] * 4 and results[0][1] == 1


def test_ctrl_c_ends_a_call(initial):
    points = pa.table({name: pa.array(values * 8_000_000) for name, values in POINTS.items()})
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    # Shells start programs in the background with the signal ignored.
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            while True:  # however fast the machine is
                initial.predict(points, threads=1)
    finally:
        signal.signal(signal.SIGINT, handler)
    assert initial.predict(POINTS).num_rows == 1


def test_memory_is_flat_after_a_thousand_calls(initial):
    points = pa.table({name: values * 1000 for name, values in POINTS.items()})
    content = REPORT.read_bytes()

    def calls(number):
        for _ in range(number):
            initial.predict(points, threads=1)
            cruisefit.segment(content, threads=1)

    def held_kb():
        with open("/proc/self/statm") as statm:
            return int(statm.read().split()[1]) * resource.getpagesize() // 1024

    calls(200)
    before = held_kb()
    calls(1000)
    grown = held_kb() - before
    print(f"grown by {grown} kB in 1,000 calls")
    assert grown < 8_000


def test_a_monitoring_says_what_it_is_of(initial, segments):
    monitoring = initial.adapt(segments).monitor(quick=True)
    assert (len(segments.tails), len(segments.flights)) == (1, 10)
    assert repr(monitoring) == "<Monitoring: 1 tail, 10 flights, 0 changes>"


def fleet_of_two(initial):
    plan = """(seed: 7, aircraft: Preset(citation_x), tails: [
        (tail: "T-1", flights: Designed((flights: 3))), (tail: "T-2", flights: Designed((flights: 3)))])"""
    return initial.adapt(cruisefit.segment(cruisefit.simulate(plan).reports))


def test_factors_of_a_monitoring_are_those_of_the_command_line(initial):
    adapted = fleet_of_two(initial)
    for name in ("co2_kg_per_kg", "fuel_price_per_kg", "flights_per_year"):
        for value in (-5.0, 0.0, float("inf"), float("nan")):
            with pytest.raises(cruisefit.InputError, match="(a kg of fuel|flights a year): found .*, expected a finite number above 0"):
                adapted.monitor(**{name: value})
    for value in (float("inf"), float("nan")):
        with pytest.raises(cruisefit.InputError, match="basic factor.*expected a finite number of per cent"):
            adapted.monitor(basic_performance_factor_percent=value)
    assert adapted.monitor(basic_performance_factor_percent=-1.5, flights_per_year=100).to_dict()["tails"]


def test_what_is_not_monitored_is_said(initial, segments):
    """As the command line warns of it."""
    adapted = fleet_of_two(initial)
    events = b"date,tail,kind,note\n2019-01-01,T-1,wash,\n2019-01-01,NOBODY,wash,\n2019-02-01,NOBODY,wash,\n"
    with pytest.warns(cruisefit.DataWarning) as caught:
        adapted.monitor(events=events)
    assert [str(one.message) for one in caught] == ["tail NOBODY: has events, but no flight"]
    assert caught[0].filename == __file__
    with pytest.warns(cruisefit.DataWarning, match="tail NOBODY: has events, but no flight"):
        initial.diagnose(segments, events=events)
    with pytest.warns(cruisefit.DataWarning) as caught:
        nothing = adapted.monitor(since="2099-01-01")
    assert [str(one.message) for one in caught] == [
        f"tail {tail}: no segment is inside the table since 2099-01-01T00:00:00Z: there is nothing to monitor"
        for tail in ("T-1", "T-2")
    ]
    assert nothing.to_dict()["tails"] == []


@pytest.mark.parametrize("damage", ["changed", "missing"])
def test_a_damaged_tail_costs_itself_where_only_looked_at(initial, tmp_path, damage):
    """As at `cruisefit monitor`; what is continued is read whole, or the tail would begin anew."""
    adapted = fleet_of_two(initial)
    adapted.write(tmp_path / "folder")
    file = tmp_path / "folder" / "segments" / "T-2.csv"
    if damage == "changed":
        file.write_bytes(file.read_bytes() + b"\n")
    else:
        file.unlink()
    with pytest.raises((cruisefit.InputError, FileNotFoundError)):
        cruisefit.Adaptation.read(tmp_path / "folder")
    with pytest.warns(cruisefit.DataWarning, match="tail T-2 is left out: .*T-2.csv"):
        left = cruisefit.Adaptation.read(tmp_path / "folder", strict=False)
    (tail,) = left.monitor(quick=True).to_dict()["tails"]
    assert tail["tail"] == "T-1"


def test_parts_that_were_added_up_go_on(initial, segments):
    """Segments and flights are those that are learnt at once; the model is a sum, in another order."""
    files = sorted((FIXTURES / "ghazi-2020" / "reports").rglob("*.txt"))
    first, last = files[:8], files[8:]
    with pytest.warns(cruisefit.DataWarning, match="refused"):
        read = [cruisefit.segment([*first[::2], ("bad.txt", b"nonsense")]), cruisefit.segment(first[1::2])]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        parts = [initial.adapt(part, remainder=False) for part in read]
    whole = cruisefit.adaptation.added(parts, [part.summary_json() for part in parts])
    at_once = initial.adapt(cruisefit.segment(first), remainder=False)
    (tail,) = whole.tails
    assert whole.segments_csv(tail) == at_once.segments_csv(tail)
    assert whole.flights_csv(tail) == at_once.flights_csv(tail)
    assert whole.begun(tail) == at_once.begun(tail)
    assert whole.model().to_text() == cruisefit.merge([part.model() for part in parts]).to_text()
    assert whole.summary["reports"]["read"] == whole.summary["tails"][0]["flights_new"] == 8
    assert [one.path for one in whole.refused] == ["bad.txt"]
    night = cruisefit.adapt(cruisefit.segment([first[0], *last]), [initial], begun=whole, remainder=False)
    assert night.model().flights_learnt == len(files)
    assert night.summary["reports"]["already_known"] == 1
    with pytest.raises(cruisefit.InputError, match="in the ledger of an earlier model too"):
        cruisefit.adaptation.added([parts[0], parts[0]], [])
    other = initial.adapt(read[1])
    with pytest.raises(cruisefit.InputError, match="begun with other models or settings"):
        cruisefit.adaptation.added([parts[0], other], [])


def test_without_deviations_the_rest_of_a_prediction_is_the_same(initial, segments):
    model = initial.adapt(segments).model()
    points = pa.table(POINTS)
    whole, bare = (model.predict(points, deviations=on) for on in (True, False))
    name = "fuel_flow_std_kg_s"
    assert bare[name].null_count == bare.num_rows > whole[name].null_count
    assert whole.drop_columns([name]) == bare.drop_columns([name])


def test_a_prediction_has_the_columns_that_are_wanted(initial, segments):
    model = initial.adapt(segments).model()
    points = pa.table(POINTS)
    everything = model.predict(points)
    wanted = ["specific_range_m_kg", "fuel_flow_kg_s"]
    assert model.predict(points, columns=wanted) == everything.select([*points.column_names, *reversed(wanted)])
    assert model.predict(points, columns=[]) == points
    with pytest.raises(cruisefit.errors.InputError, match="fuel_flow_kg_s, fuel_flow_std_kg_s"):
        model.predict(points, columns=["fuel_flow"])


def test_pickles(initial, segments):
    assert pickle.loads(pickle.dumps(initial)).to_text() == initial.to_text()
    assert pickle.loads(pickle.dumps(segments)).to_csv() == segments.to_csv()
    with pytest.warns(cruisefit.DataWarning):
        poisoned = segments + cruisefit.segment([("bad.txt", b"nonsense")])
    again = pickle.loads(pickle.dumps(poisoned))
    assert again.refused == poisoned.refused and len(again.refused) == 1
    assert repr(again) == repr(poisoned)
    adapted = initial.adapt(segments)
    again = pickle.loads(pickle.dumps(adapted))
    assert {t: m.to_text() for t, m in again.models.items()} == {
        t: m.to_text() for t, m in adapted.models.items()
    }


def test_results_show_themselves(initial, segments):
    adapted = initial.adapt(segments)
    page = adapted._repr_html_()
    assert page.startswith("<iframe srcdoc=") and "&lt;svg" in page
    assert "segments" in repr(segments) and "Citation" in repr(initial)
    diagnosis = initial.diagnose(segments)
    assert "<iframe" in diagnosis._repr_html_()
    tail = diagnosis.diagnoses[0]
    assert diagnosis[tail.tail] is not None and tail.verdict.advice
    assert tail.causes == sorted(tail.causes, key=lambda cause: -cause.probability)
    assert [month.month for month in tail.months] == sorted(month.month for month in tail.months)
    assert sum(month.segments for month in tail.months) == tail.segments
    assert bool(tail.contributions) == tail.gap.detected
    for one in tail.contributions:
        assert one.rms_ci95[0] <= one.rms_ci95[1] and one.rms_percent >= 0 and 0 <= one.leads <= 1


def test_warnings_of_the_library_reach_the_caller(initial):
    content = REPORT.read_bytes()
    with pytest.warns(cruisefit.DataWarning, match="1 report is a copy of others") as caught:
        copies = cruisefit.segment([("a.txt", content), ("b.txt", content)])
    assert [warning.filename for warning in caught] == [__file__]
    assert len(copies.flights.column("flight")) == 1

    with warnings.catch_warnings(), pytest.raises(cruisefit.DataWarning, match="copy"):
        warnings.simplefilter("error", cruisefit.DataWarning)
        cruisefit.segment([("a.txt", content), ("b.txt", content)])


def test_warnings_do_not_depend_on_threads():
    content = REPORT.read_bytes()
    reports = [(f"{name}.txt", content) for name in "abcdef"]

    def said(threads):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            cruisefit.segment(reports, threads=threads)
        return [str(warning.message) for warning in caught]

    assert said(1) == said(4) != []


def test_what_is_no_report_is_named(initial, segments, tmp_path):
    """Types that a call does not take, in words, before anything is read."""
    rule = "(format: 1)"
    for wrong, words in (
        ([pd.DataFrame(), pd.DataFrame()], "found DataFrame, .*a table is read by itself"),
        (pl.LazyFrame({"a": [1]}), r"found LazyFrame, .*collect\(\) it first"),
        (open(__file__, "rb"), "found BufferedReader, expected a path"),
        (None, "found NoneType, expected a path"),
    ):
        with pytest.raises(TypeError, match=words):
            cruisefit.segment(wrong)
        if hasattr(wrong, "close"):
            wrong.close()
    text = REPORT.read_bytes()
    for kind in (bytes, bytearray, memoryview):
        assert len(cruisefit.segment(kind(text)).flights) == 1
        assert cruisefit.segment(("a.txt", kind(text))).flights.column("path").to_pylist() == ["a.txt"]
    assert len(cruisefit.segment((REPORT, str(REPORT.parent))).flights) == len(segments.flights)
    # A mapping may be on one line, of any length; a preset's name may be misspelt.
    with pytest.raises(cruisefit.InputError, match="aircraft"):
        cruisefit.segment(pd.DataFrame(), mapping=rule)
    with pytest.raises(cruisefit.InputError, match="preset: traffic-a320, "):
        cruisefit.segment(pd.DataFrame(), mapping="trafic-a320")
    (tmp_path / "M.ron").write_bytes(b"PAR1\xff\xfe")
    with pytest.raises(cruisefit.InputError, match="M.ron: found byte 0xff, expected text in UTF-8"):
        cruisefit.Model.load(tmp_path / "M.ron")
    # Warnings that differ in their numbers alone are one.
    with pytest.warns(cruisefit.DataWarning) as caught:
        cruisefit.errors.warn([f"file a.txt, line {line}: a gap" for line in (100, 9, 20, 30)] + ["another"])
    told = [str(one.message) for one in caught]
    assert told == ["file a.txt, line 9: a gap (and 3 more of this kind)", "another"]
    for call in (cruisefit.adapt, cruisefit.evaluate, cruisefit.diagnose):
        with pytest.raises(cruisefit.InputError, match="models: found none"):
            call(segments, [])
    with pytest.raises(cruisefit.InputError, match="found str, expected Adaptation"):
        cruisefit.adapt(segments, initial, begun="adapted")
    with pytest.raises(cruisefit.InputError, match="tsfc_engine_9"):
        cruisefit.diagnose(segments, initial, effects="tsfc_engine_9")


def test_numbers_and_dates_that_a_call_takes(initial, segments):
    for threads in (0, -1):
        for call in (
            lambda: initial.predict(POINTS, threads=threads),
            lambda: cruisefit.segment(REPORT, threads=threads),
            lambda: initial.adapt(segments, threads=threads),
            lambda: initial.diagnose(segments, threads=threads),
        ):
            with pytest.raises(cruisefit.InputError, match=f"threads: found {threads}, expected 1 or more"):
                call()
    for threshold in (-1.0, float("nan")):
        with pytest.raises(cruisefit.InputError, match="threshold_percent: found"):
            initial.adapt(segments, law="paper", threshold_percent=threshold)
    adapted = initial.adapt(segments)
    by_date, by_text = (adapted.monitor(since=since) for since in (datetime.date(2018, 6, 1), "2018-06-01"))
    assert by_date.to_json() == by_text.to_json()


def test_segments_by_other_criteria_are_not_added(segments):
    """A model would state criteria that were not used, and could not be continued with either."""
    other = cruisefit.segment(FIXTURES / "ghazi-2020" / "reports", criteria="airbus-report-02")
    with pytest.raises(cruisefit.InputError, match="'ghazi-2020-table-4' and by 'airbus-report-02'"):
        segments + other


def test_many_points_without_a_prediction_are_counted(initial):
    """The first is named; a list of them all would hold the interpreter's lock."""
    rows = 200_000
    points = pa.table({"mass_kg": [15000.0] * rows, "pressure_altitude_ft": [43000.0] * rows, "mach": [0.82, 0.2] * (rows // 2)})
    with pytest.warns(cruisefit.PredictionWarning, match="100000 points have no prediction; the first is row 2: "):
        initial.predict(points)
