"""The module gives the numbers of the command, to the last bit."""

from __future__ import annotations

import json
import pathlib
from typing import Any

import numpy as np
import pytest

import kinds
import papilla as pp
from papilla import _native
from conftest import ROOT, command, command_json

CLOCKS = ("seconds", "processor_seconds")
# Names of the list of quantities, and those that differ in the command's JSON.
QUANTITIES = [name for name, *_ in _native.quantities()]
KEYS = {"friction_off": "F_off", "friction_on": "F_on"}


def agree(response: pp.Response, printed: dict[str, Any]) -> int:
    """Every array against the printed numbers; returns how many were compared."""
    assert response.humidity.tolist() == [p["relative_humidity"] for p in printed["points"]]
    compared = 0
    assert len(QUANTITIES) >= 12
    for name in QUANTITIES:
        rows = [p[KEYS.get(name, name)] for p in printed["points"]]
        if rows[0] is None:
            with pytest.raises(AttributeError, match="drive"):
                getattr(response, name)
            continue
        quantity: pp.Quantity = getattr(response, name)
        assert quantity.value.dtype == np.float64
        assert quantity.value.tolist() == [row["value"] for row in rows], name
        assert quantity.error.tolist() == [row["se"] for row in rows], name
        for part, column in quantity.parts.items():
            printed_parts = [row["parts"][part] for row in rows]
            assert [None if np.isnan(x) else x for x in column] == printed_parts, (name, part)
            compared += len(column)
    mine = response.to_dict()
    for clock in CLOCKS:
        mine.pop(clock)
        printed.pop(clock)
    for document in (mine, printed):
        document["belief"].pop("seconds", None)
    assert mine == printed
    return compared


def check(values: dict[str, Any], folder: pathlib.Path) -> int:
    design = pp.Design(values)
    file = folder / "design.toml"
    design.save(file)
    return agree(design.evaluate(), command_json("evaluate", str(file)))


@pytest.mark.parametrize("values", kinds.designs(11), ids=lambda values: values["title"])
def test_a_design_of_each_kind(values: dict[str, Any], tmp_path: pathlib.Path) -> None:
    assert check(values, tmp_path) > 60


@pytest.mark.slow
@pytest.mark.parametrize("values", kinds.designs(50)[11:], ids=lambda values: values["title"])
def test_fifty_designs(values: dict[str, Any], tmp_path: pathlib.Path) -> None:
    assert check(values, tmp_path) > 60


def test_a_shipped_file() -> None:
    file = str(ROOT / "designs/m3_samples/a3h350.toml")
    settings = ["--set", "accuracy.level=draft", "--set", "accuracy.grid=64"]
    mine = pp.Design.load(file, {"accuracy": {"level": "draft", "grid": 64}}).evaluate()
    assert agree(mine, command_json("evaluate", file, *settings)) > 300


def test_bridge_is_that_of_the_command() -> None:
    printed = command_json("solve", "bridge", "--volume", "0.02 um3", "--gap", "90 nm", "--theta1", "70 deg",
                           "--theta2", "40 deg")
    mine = pp.bridge("0.02 um3", "90 nm", "70 deg", "40 deg", "72.126 mN/m")
    assert (mine.force, mine.energy) == (printed["force"], printed["energy"])


def test_contact_droplets_and_field_are_those_of_the_command(tmp_path: pathlib.Path) -> None:
    r = np.random.default_rng(5)
    z = 20e-9 * r.standard_normal((64, 64))
    gap = np.abs(60e-9 * r.standard_normal((64, 64)))
    np.save(tmp_path / "z.npy", z)
    np.save(tmp_path / "gap.npy", gap)
    printed = command_json("solve", "contact", "--height", "z.npy", "--size", "4 um", "--as-is", "--pressure", "1 MPa",
                           "--modulus", "50 MPa", "--out-pressure", "p.npy", cwd=tmp_path)
    mine = pp.contact(z, "4 um", pressure="1 MPa", modulus="50 MPa")
    assert np.array_equal(mine.pressure, np.load(tmp_path / "p.npy"))
    assert mine.area_fraction == printed["area_fraction"]
    printed = command_json("solve", "droplets", "--gap", "gap.npy", "--size", "4 um", "--volume", "0.2 um3",
                           cwd=tmp_path)
    wet = pp.droplets(gap, "4 um", volume="0.2 um3")
    assert wet.capillary_force == printed["capillary_force"]
    assert wet.retention == printed["retention"]
    assert wet.x.tolist() == [d["x"] for d in printed["droplets"]]
    assert wet.place == [d["state"] for d in printed["droplets"]]
    for method in ("local", "spread", "full"):
        command("solve", "field", "--gap", "gap.npy", "--size", "4 um", "--voltage", "150 V", "--method", method,
                "--out-pressure", "pull.npy", cwd=tmp_path)
        mine_field = pp.field(gap, "4 um", voltage="150 V", method=method)
        assert np.array_equal(mine_field.pressure, np.load(tmp_path / "pull.npy")), method


@pytest.mark.parametrize("piece, file", [("persson", "wrist_on_glass.toml"), ("drive", "fingertip_drive.toml")])
def test_cases_are_those_of_the_command(piece: str, file: str) -> None:
    name = str(ROOT / "designs/physics" / file)
    printed = command_json("solve", piece, name)
    mine = getattr(pp, piece)(name).to_dict()
    mine.pop("seconds", None)
    printed.pop("seconds", None)
    assert mine == printed


def test_points_that_yield_are_those_of_the_command() -> None:
    values = {"skin.hardness": "100 kPa", "drive.amplitude": "200 V", "sweep.voltage": ["0 V", "200 V"]}
    mine = pp.persson(ROOT / "designs/physics/wrist_on_glass.toml", values)
    assert mine.yielded is True and mine.point["yielded"] is True
    assert mine.over_voltage["yielded"].tolist() == [False, True]
    for sweep in ("over_voltage", "over_load", "over_frequency"):
        printed = mine.to_dict()[sweep]
        for name in ("yielded", "collapsed", "breaks_down"):
            assert getattr(mine, sweep)[name].tolist() == [p[name] for p in printed]


def test_ranking_is_that_of_the_command() -> None:
    names = [f"designs/m3_samples/{n}.toml" for n in ("flat", "a3h350")]
    changes = {"accuracy.level": "draft", "accuracy.grid": 48, "environment.relative_humidity": ["50 %"]}
    designs = [pp.Design.load(ROOT / n, changes) for n in names]
    sets = [x for key, value in (("accuracy.level", "draft"), ("accuracy.grid", "48"),
                                 ("environment.relative_humidity", '["50 %"]')) for x in ("--set", f"{key}={value}")]
    printed = json.loads(command("rank", *names, *sets, "--json", cwd=ROOT))
    mine = pp.rank(designs, names=["flat", "a3h350"])
    best = printed["states"][0]["candidates"][0]
    assert mine.order[0].p_best == best["p_best"]
