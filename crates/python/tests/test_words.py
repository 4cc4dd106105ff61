"""The words of a diagnosis are true of what it found."""

from __future__ import annotations

import warnings

import pytest
from conftest import ROOT

import cruisefit

EMBEDDED = ROOT / "crates" / "cli" / "embedded"


@pytest.fixture(scope="module")
def learnt(initial) -> cruisefit.Model:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return initial.adapt(cruisefit.segment(cruisefit.simulate(EMBEDDED / "DEMO-PLAN.ron").reports)).model()


def later(**changes: str) -> cruisefit.Segments:
    text = (EMBEDDED / "DEMO-LATER.ron").read_text()
    for old, new in changes.values():
        assert old in text
        text = text.replace(old, new, 1)
    return cruisefit.segment(cruisefit.simulate(text).reports)


def test_what_is_many_standard_deviations_away_is_not_called_like_the_cause(learnt):
    """A Mach number that reads high: static pressure is open as part of a pair, alone over three standard deviations away."""
    planted = ('id: "tsfc_engine_2", size: 3.0', 'id: "mach_bias", size: 0.008')
    (found,) = learnt.diagnose(later(planted=planted)).diagnoses
    far = {one["from"] for one in found.record["verdict"]["separations"] if one["distance_now"] > 3.0}
    effect_class = set(found.verdict.effect_class)
    assert far and far <= effect_class

    def named(beginning: str) -> set[str]:
        (line,) = [line for line in found.lines if line.startswith(beginning)]
        return {word.rstrip(".,;") for word in line.split()} & effect_class

    cause, alike, left_open = map(named, ("Cause: ", "These flights cannot tell it from: ", "Not ruled out, "))
    assert cause == set(found.verdict.effects) == {"mach_bias"}
    assert alike and not alike & far
    assert far <= left_open
    assert cause | alike | left_open == effect_class


def test_advice_names_an_effect_in_words(learnt):
    """With tank gauges the engine is told from its meter, and the advice is no bare name of a file's."""
    (two,) = learnt.diagnose(later()).diagnoses
    assert two.verdict.advice.startswith("One of these: the fuel-flow meter of engine 2 reads high (fuel_flow_gain_2); ")
    gauges = ("effects:", "columns: (fuel_quantity: On),\n    effects:")
    (one,) = learnt.diagnose(later(gauges=gauges)).diagnoses
    assert one.verdict.advice == (
        "Engine 2 burns more (tsfc_engine_2). "
        "It belongs to the engines: predictions change with it, the drag table does not."
    )


def test_of_too_little_data_no_gap_has_a_number(learnt):
    flights = cruisefit.simulate(EMBEDDED / "DEMO-LATER.ron").reports[:2]
    found = learnt.diagnose(cruisefit.segment(flights))
    gap = found.diagnoses[0].gap
    assert found.diagnoses[0].verdict.kind == "insufficient_data"
    numbers = (gap.mean_percent, gap.rms_percent, gap.rms_ci95, gap.noise_floor_rms_percent, gap.p_value)
    assert set(numbers) == {None} and not gap.detected
    # A dash in the table of tails, no zero.
    assert "+0.00" not in found.page()
