"""The wheel as it is packed: `pip wheel .` itself builds the whole program again and is run by hand (CONTRIBUTING.md)."""

from __future__ import annotations

import base64
import hashlib
import importlib.metadata
import os
import pathlib
import sys
import zipfile

import pytest

from conftest import ROOT
from papilla import __main__ as command

sys.path.insert(0, str(ROOT / "python/wheel"))
import papilla_wheel  # noqa: E402


@pytest.fixture
def packed(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> zipfile.ZipFile:
    def install(tree: pathlib.Path, settings: dict[str, str]) -> None:
        assert settings == {"PAPILLA_NATIVE": "OFF"}
        (tree / "lib").mkdir(parents=True)
        (tree / "bin").mkdir()
        (tree / "__init__.py").write_text("")
        (tree / "bin/papilla").write_text("#!/bin/sh\n")
        (tree / "bin/papilla").chmod(0o755)
        (tree / "lib/libpapilla.so.0.1.0").write_bytes(b"library")
        (tree / "lib/libpapilla.so.0.1").symlink_to("libpapilla.so.0.1.0")
        (tree / "lib/libpapilla.so").symlink_to("libpapilla.so.0.1")

    monkeypatch.setattr(papilla_wheel, "_install", install)
    name = papilla_wheel.build_wheel(str(tmp_path), {"PAPILLA_NATIVE": "OFF"})
    return zipfile.ZipFile(tmp_path / name)


def test_a_wheel_lists_its_files_with_their_sums(packed: zipfile.ZipFile) -> None:
    info = next(name.split("/")[0] for name in packed.namelist() if "dist-info" in name)
    rows = [line.split(",") for line in packed.read(f"{info}/RECORD").decode().splitlines()]
    assert sorted(row[0] for row in rows) == sorted(packed.namelist()) and rows[-1] == [f"{info}/RECORD", "", ""]
    for name, digest, size in rows[:-1]:
        data = packed.read(name)
        assert int(size) == len(data)
        assert digest == "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()


def test_a_wheel_has_the_library_once_and_a_program_that_runs(packed: zipfile.ZipFile) -> None:
    names = packed.namelist()
    assert [name for name in names if "libpapilla" in name] == ["papilla/lib/libpapilla.so.0.1"]
    assert packed.read("papilla/lib/libpapilla.so.0.1") == b"library"
    assert packed.getinfo("papilla/bin/papilla").external_attr >> 16 & 0o111


def test_a_wheel_says_what_it_needs(packed: zipfile.ZipFile, tmp_path: pathlib.Path) -> None:
    packed.extractall(tmp_path / "site")
    found = next(iter(importlib.metadata.distributions(name="papilla", path=[str(tmp_path / "site")])))
    assert found.requires and found.requires[0] == "numpy" and found.metadata["Version"] in (ROOT / "CMakeLists.txt").read_text()
    assert [(e.name, e.value) for e in found.entry_points] == [("papilla", "papilla.__main__:main")]


def test_the_command_of_the_module_is_the_program_in_the_path(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(SystemExit, match="neither beside the module nor in the path"):
        command.program()
    (tmp_path / "papilla").write_text("#!/bin/sh\n")
    (tmp_path / "papilla").chmod(0o755)
    assert command.program() == os.fspath(tmp_path / "papilla")
