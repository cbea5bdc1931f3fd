"""What the tests share. PAPILLA_PROGRAM names the command, PYTHONPATH the module (ctest sets both)."""

from __future__ import annotations

import json
import os
import pathlib
import subprocess
from typing import Any

import pytest

import papilla as pp

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("PAPILLA_PROGRAM", str(ROOT / "build/ci/papilla"))
THOROUGH = "PAPILLA_THOROUGH" in os.environ  # all cases, not a sample: scripts/test --thorough

# A second of work: one humidity, few pixels.
QUICK = {"accuracy.level": "draft", "accuracy.grid": 64, "environment.relative_humidity": ["50 %"]}


def command(*arguments: str, cwd: os.PathLike[str] | None = None) -> str:
    """What the command prints."""
    done = subprocess.run([PROGRAM, "-q", *arguments], capture_output=True, text=True, cwd=cwd, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def command_json(*arguments: str, cwd: os.PathLike[str] | None = None) -> dict[str, Any]:
    document: dict[str, Any] = json.loads(command(*arguments, "--json", cwd=cwd))
    return document


@pytest.fixture
def quick() -> pp.Design:
    """Holes on the published glass, driven, one humidity."""
    return pp.Design.load(ROOT / "designs/m3_samples/a3h600.toml", QUICK)
