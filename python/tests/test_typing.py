"""The stubs say what the module has, and the examples pass a type checker."""

from __future__ import annotations

import inspect
import os
import pathlib
import re
import subprocess
import sys

import pytest

import papilla as pp
from conftest import ROOT, THOROUGH
from papilla import _native

STUBS = (ROOT / "python/papilla/_native.pyi").read_text()

# Nine tenths of mypy's time are for the sources of these two, which a few lines of ours call: scripts/test --thorough reads them, and
# not all of optuna's functions say their types.
NOT_READ = """
[mypy-optuna.*,xarray.*]
ignore_missing_imports = True
follow_imports = skip
"""
READ = """
[mypy-optuna_search]
disallow_untyped_calls = False
"""


@pytest.mark.slow
def test_mypy_is_content_with_the_package_and_the_examples(tmp_path: pathlib.Path) -> None:
    python = ROOT / "python"
    config = tmp_path / "mypy.ini"
    config.write_text((python / "mypy.ini").read_text() + (READ if THOROUGH else NOT_READ))
    package, examples = ([str(path) for path in sorted(python.glob(files))] for files in ("papilla/*.py*", "examples/*.py"))
    assert package and examples
    done = subprocess.run([sys.executable, "-m", "mypy", "--config-file", str(config), "--cache-dir", str(tmp_path),
                           *package, *examples],
                          capture_output=True, text=True, check=False, cwd=tmp_path, env={**os.environ, "MYPYPATH": str(python)})
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_stubs_have_the_names_and_arguments_of_the_module() -> None:
    module = {name for name in vars(_native) if not name.startswith("_")} | {"__version__"}
    stubs = set(re.findall(r"^(?:def|class) (\w+)", STUBS, re.M)) | {"__version__"}
    assert stubs == module
    for name, arguments in re.findall(r"^def (\w+)\((.*?)\) ->", STUBS, re.M | re.S):
        said = re.findall(r"(\w+):", arguments)
        has = re.findall(r"(\w+): ", getattr(_native, name).__doc__.split("->")[0])
        assert said == has, name
    for name, body in re.findall(r"^class (\w+):\n((?:    .*\n?)+)", STUBS, re.M):
        said_members = set(re.findall(r"def (\w+)|^    (\w+):", body, re.M))
        members = {a or b for a, b in said_members} - {"__init__"}
        has_members = {m for m in vars(getattr(_native, name)) if not m.startswith("_")} - {"name", "value"}
        assert members == has_members, name


def test_the_page_of_the_api_is_that_of_the_docstrings() -> None:
    made = subprocess.run([sys.executable, str(ROOT / "python/docs/make_page.py")], capture_output=True, text=True,
                          check=True).stdout
    assert made == (ROOT / "docs/reference/python.md").read_text(), "python3 python/docs/make_page.py > docs/reference/python.md"


def test_every_public_name_is_explained() -> None:
    for name in pp.__all__:
        value = getattr(pp, name)
        if name == "__version__":
            continue
        assert inspect.getdoc(value), name
        if inspect.isclass(value):
            for member, function in vars(value).items():
                if not member.startswith("_") and (inspect.isfunction(function) or isinstance(function, property)):
                    described = function.fget if isinstance(function, property) else function
                    assert inspect.getdoc(described) or name in ("Study", "Design", "Heights"), f"{name}.{member}"
