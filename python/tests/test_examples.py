"""The notebooks and the scripts of python/examples run, without a screen."""

from __future__ import annotations

import os
import pathlib
import subprocess
import sys
from typing import Any

import pytest

from conftest import ROOT, THOROUGH

sys.path.insert(0, str(ROOT / "python/docs"))
import run_notebooks  # noqa: E402

EXAMPLES = ROOT / "python/examples"
NOTEBOOKS = sorted(path.stem for path in EXAMPLES.glob("*.ipynb"))


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", NOTEBOOKS if THOROUGH else [name for name in NOTEBOOKS if name != "own_optimiser"])
def test_a_notebook_shows_what_it_does(name: str, tmp_path: pathlib.Path) -> None:
    import nbformat

    def kinds(notebook: Any) -> list[list[list[str]]]:
        return [[sorted(output.get("data", {output.output_type: ""})) for output in cell.get("outputs", [])] for cell in notebook.cells]

    committed = nbformat.read(EXAMPLES / f"{name}.ipynb", as_version=4)
    again = run_notebooks.run(EXAMPLES / f"{name}.ipynb", tmp_path)
    assert kinds(again) == kinds(committed), "run python/docs/run_notebooks.py"
    assert any("text/html" in output for cell in kinds(again) for output in cell), "a design shows itself"


def test_there_are_three_notebooks() -> None:
    assert len(NOTEBOOKS) == 3


def lines_of(script: str, *arguments: str) -> list[str]:
    done = subprocess.run([sys.executable, str(EXAMPLES / script), *arguments], capture_output=True, text=True, check=False,
                          env=dict(os.environ))
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


@pytest.mark.slow
def test_a_lab_measures_what_a_ranking_leaves_open(tmp_path: pathlib.Path) -> None:
    lines = lines_of("rank_and_measure.py", str(tmp_path))
    first = lines[0].removeprefix("ranked: ").split(", ")[:2]
    assert len(first) == 2 and all(line.split()[1] in first for line in lines[1:-2])
    assert " readings told: the best is " in lines[-2] and lines[-1] in ("stop", "go on")
    assert all(f"| {name} |" in (tmp_path / "lab" / "lab.md").read_text() for name in first)


@pytest.mark.slow
def test_optuna_drives_thirty_trials() -> None:
    lines = lines_of("optuna_search.py", "30")
    assert lines[0] == "front of 30 trials:" and len(lines) > 1 and "texture.depth=" in lines[1]
