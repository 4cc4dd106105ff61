"""Cruise reports of virtual aircraft, with any effects switched on."""

from __future__ import annotations

import json
import os
from typing import Any

from . import _native
from ._pages import is_content, read_text

__all__ = ["Simulation", "simulate"]


class Simulation:
    """Reports of virtual flights, and the truth behind them."""

    def __init__(self, native: _native.Simulated) -> None:
        self._native = native

    @property
    def reports(self) -> list[tuple[str, bytes]]:
        """Name (``TAIL/FLIGHT.txt``) and bytes of every report, as :func:`cruisefit.segment` takes them."""
        return [
            (f"{tail}/{flight}.txt", text.encode()) for tail, flight, text in self._native.reports
        ]

    @property
    def truth(self) -> dict[str, Any]:
        """``TRUTH.json``: the effects planted and the true state of every flight."""
        truth: dict[str, Any] = json.loads(self._native.truth)
        return truth

    def truth_json(self) -> str:
        """The text of ``TRUTH.json``."""
        return self._native.truth

    def events_csv(self) -> str:
        """The text of ``EVENTS.csv``: what was done to the tails of a fleet."""
        return self._native.events

    def __len__(self) -> int:
        return len(self._native.reports)

    def __repr__(self) -> str:
        return f"<Simulation: {len(self)} flights>"


def simulate(plan: str | os.PathLike[str], *, threads: int | None = None) -> Simulation:
    """Flies the flights of a plan.

    Args:
        plan: Path of a plan file (RON), or its text: aircraft, fleet, dates, effects, sensors, seed.
        threads: Threads to use; all processors without it.

    Raises:
        InputError: A plan that is none, or a flight that cannot be flown.
        FileNotFoundError: There is no such file.
    """
    text = plan if isinstance(plan, str) and is_content(plan) else read_text(plan)
    return Simulation(_native.simulate(text, threads))
