"""Pages and charts: the bytes of files, made without the interpreter's lock."""

from __future__ import annotations

import sys
import threading
import time

import pytest

import cruisefit


@pytest.fixture(scope="module")
def adapted(initial, segments):
    return initial.adapt(segments)


def test_of_a_large_fleet_the_page_is_the_one_with_links(initial, tmp_path):
    """More tails than one page holds: a page each, which `write` makes."""
    tails = "".join(f'(tail: "T-{number}", flights: Designed((flights: 1))),' for number in range(215))
    plan = f"(seed: 1, aircraft: Preset(citation_x), tails: [{tails}])"
    fleet = initial.adapt(cruisefit.segment(cruisefit.simulate(plan).reports), remainder=False)
    # Some fly nothing steady.
    assert len(fleet.tails) > 200
    fleet.write(tmp_path / "fleet")
    assert fleet.page() == (tmp_path / "fleet" / "report.html").read_text()
    assert len(list((tmp_path / "fleet" / "pages").iterdir())) == len(fleet.tails)


CALLS = {
    "page": lambda of: of["adapted"].page(),
    "plot": lambda of: of["adapted"].plot(of["adapted"].tails[0]),
    # Of tables the native half: what is made of them, pyarrow makes without the lock.
    "segments": lambda of: of["adapted"]._native.segments(of["adapted"].tails[0]),
    "segments_csv": lambda of: of["adapted"].segments_csv(of["adapted"].tails[0]),
    "table of segments": lambda of: of["segments"]._flights.segments(),
    "state of segments": lambda of: of["segments"]._flights.state(),
    "monitoring's page": lambda of: of["monitoring"].page(),
    "monitoring's table": lambda of: of["monitoring"]._native.tables(),
    "diagnosis's page": lambda of: of["diagnosis"].page(),
    "diagnosis's plot": lambda of: of["diagnosis"].plot(),
    "model's plot": lambda of: of["adapted"].model().plot(),
    "model's table": lambda of: of["adapted"].model()._native.table(),
}


@pytest.fixture(scope="module")
def results(initial, segments, adapted):
    return {
        "adapted": adapted,
        "segments": segments,
        "monitoring": adapted.monitor(quick=True),
        "diagnosis": initial.diagnose(segments),
    }


@pytest.mark.parametrize("name", sorted(CALLS))
def test_another_thread_works_during_a_call(results, name):
    """A thread never gets the lock here but where a call gives it up: it is not taken from one that holds it."""
    turns, done = 0, threading.Event()

    def work():
        nonlocal turns
        while not done.is_set():
            turns += 1
            time.sleep(0)

    interval = sys.getswitchinterval()
    CALLS[name](results)
    sys.setswitchinterval(1e3)
    thread = threading.Thread(target=work)
    try:
        thread.start()
        for _ in range(20):
            before = turns
            CALLS[name](results)
            if turns > before:
                break
        assert turns > before
    finally:
        sys.setswitchinterval(interval)
        done.set()
        thread.join()
