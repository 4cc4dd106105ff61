"""The package is typed: mypy --strict over it, over its stub, and over a program of a user."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1]


def mypy(*arguments: str) -> str:
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--config-file", str(PACKAGE / "pyproject.toml"), *arguments],
        capture_output=True,
        text=True,
        check=False,
        cwd=PACKAGE / "python",
    )
    return done.stdout + done.stderr


def test_the_package():
    assert "Success" in (told := mypy("-p", "cruisefit")), told


def test_a_users_program(tmp_path):
    program = tmp_path / "program.py"
    program.write_text(
        "import cruisefit\n"
        "model = cruisefit.Model.load('m.ron')\n"
        "kind: str = model.diagnose(cruisefit.segment('r')).diagnoses[0].verdict.kind\n"
        "wrong: int = model.tail\n"
    )
    told = mypy(str(program))
    assert "program.py:4: error" in told and told.count("error:") == 1, told


def test_the_stub_names_what_the_module_has():
    from cruisefit import _native

    stub = (PACKAGE / "python" / "cruisefit" / "_native.pyi").read_text()
    for name in dir(_native):
        if not name.startswith("__") and name != "annotations":
            declared = (f"class {name}", f"def {name}", f"\n{name}: ")
            assert any(words in stub for words in declared), name
