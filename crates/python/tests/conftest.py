"""What the tests share: the repository's fixtures and the command line, which is the oracle of "same bytes"."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

import cruisefit

ROOT = Path(__file__).resolve().parents[3]
FIXTURES = ROOT / "fixtures"


def command_line() -> Path | None:
    """The program: `CRUISEFIT` in the environment, otherwise the release build of the repository."""
    path = Path(os.environ.get("CRUISEFIT", ROOT / "target" / "release" / "cruisefit"))
    return path if path.exists() else None


@pytest.fixture(scope="session")
def run():
    """Runs the command line and returns its standard output."""
    program = command_line()
    if program is None:
        pytest.skip("no command line: cargo build --release, or CRUISEFIT=path")

    def run(*arguments: object) -> str:
        done = subprocess.run(
            [str(program), *map(str, arguments), "--no-progress"],
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode in (0, 1), done.stderr
        return done.stdout

    return run


@pytest.fixture(scope="session", params=["ghazi-2020", "global5000"])
def fixture(request) -> Path:
    """A folder with AIRCRAFT.ron, guide.csv, static.csv and reports."""
    return FIXTURES / request.param


@pytest.fixture(scope="session")
def initial() -> cruisefit.Model:
    folder = FIXTURES / "ghazi-2020"
    return cruisefit.Model.initial(folder / "AIRCRAFT.ron", folder / "guide.csv")


@pytest.fixture(scope="session")
def segments() -> cruisefit.Segments:
    return cruisefit.segment(FIXTURES / "ghazi-2020" / "reports")


@pytest.fixture(scope="session")
def demonstration(run, tmp_path_factory) -> Path:
    """The folder of `cruisefit demo`: a learnt model with a remainder, and a later period."""
    folder = tmp_path_factory.mktemp("demo")
    run("demo", "-o", folder)
    return folder
