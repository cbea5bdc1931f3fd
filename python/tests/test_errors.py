"""Three hundred seeded wrong inputs: each is a Python exception that names the key, none a crash."""

from __future__ import annotations

import json
import os
import pathlib
import pickle
import random
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import papilla as pp
from conftest import ROOT

HOLES = {"texture": {"type": "hole_array", "period": "6 um", "diameter": "3 um", "depth": "350 nm"}}
STUDY = {**HOLES, "base": "m3_samples/common.toml", "design_space": {"texture.depth": ["100 nm", "500 nm"]},
         "objective": {"maximise": "mean(modulation)"}}
Case = tuple[str, Callable[[], Any]]


def wrong_map(r: random.Random) -> Any:
    n = r.choice([16, 32])
    z = np.zeros((n, n))
    z[r.randrange(n), r.randrange(n)] = r.choice([np.nan, np.inf, -np.inf])
    return r.choice([z, np.zeros(n), np.zeros((n, n, 2)), np.zeros((n, n), complex), np.zeros((n, n), bool),
                     np.zeros((n, n), "U3"), np.zeros((1, n)), np.zeros((0, n)), [["a"]], None, "z.npy",
                     np.zeros((n, n), "M8[s]"), np.zeros((n, n), object)])


def wrong_length(r: random.Random) -> Any:
    return r.choice(["6 V", "6", "", "six um", float("nan"), float("inf"), -1e-6, 0.0, None, True, [1e-6], (1, 2, 3),
                     "-3 um", b"6 um", 1j])


def wrong_value(r: random.Random) -> tuple[str, Any]:
    """A key and a value that it cannot have."""
    return r.choice([
        ("texture.depth", r.choice(["350 V", "deep", float("nan"), -1e-9, None, True, [1, 2], 1.0])),
        ("texture.period", r.choice(["1 kg", 0, 1e-30, "6 um 3", object()])),
        ("texture.lattice", r.choice(["round", 3, ["square"]])),
        ("surface.contact_angle", r.choice(["200 deg", "-1 deg", "50 N", 7.0])),
        ("drive.amplitude", r.choice(["200 Hz", -5, "1e99 V"])),
        ("drive.waveform", r.choice(["saw", 1.5])),
        ("environment.relative_humidity", r.choice(["50 %", [2.0], ["a"], [float("nan")]])),
        ("accuracy.grid", r.choice([3.5, -1, "many"])),
        ("texture.depht", "1 nm"), ("nothing.here", 1), ("base", "no_such.toml"), ("finger.base", "none.toml"),
        ("accuracy.level", r.choice(["best", 1])),
    ])


def cases(count: int) -> list[Case]:
    r = random.Random(1123)
    good = pp.Design(HOLES)
    study = pp.Study(STUDY)
    flat = np.zeros((32, 32))

    def design_value() -> Case:
        key, value = wrong_value(r)
        named = "base" if key.endswith("base") else key.split(".")[0]
        return named, r.choice([lambda: good.with_({key: value}), lambda: pp.Design({**HOLES, key: value})])

    def contact() -> Case:
        key = r.choice(["z", "size", "pressure", "modulus", "tolerance", "hardness"])
        given: dict[str, Any] = {"z": flat, "size": "6 um", "pressure": "1 kPa", "modulus": "1 MPa"}
        given[key] = {"z": wrong_map(r), "size": wrong_length(r), "pressure": r.choice(["1 m", -1.0, "1e30 Pa", None]),
                      "modulus": r.choice([0, "-1 Pa", "soft", float("inf")]), "tolerance": r.choice([0.0, -1.0, 5.0]),
                      "hardness": r.choice([-1.0, "hard"])}[key]
        return key, lambda: pp.contact(**given)

    def heights() -> Case:
        if r.random() < 0.5:
            z = wrong_map(r)
            return "heights", lambda: pp.Design.from_heights(z, "6 um")
        if r.random() < 0.3:
            return "heights", lambda: pp.Design.from_heights(np.zeros((32, 16)), "6 um")
        size = wrong_length(r)
        return "size", lambda: pp.Design.from_heights(flat, size)

    def water() -> Case:
        key, value = r.choice([("volume", -1.0), ("volume", "1 um"), ("theta_skin", "181 deg"), ("theta_substrate", -1),
                               ("surface_tension", 0), ("hysteresis", 3.0), ("drops_per_volume", -1.0),
                               ("first_step", "0 m"), ("seed", -1), ("seed", 1.5), ("threshold", 1), ("gap", -flat - 1e-9)])
        given: dict[str, Any] = {"gap": flat + 1e-8, "size": "6 um", "volume": "0.1 um3", key: value}
        return key, lambda: pp.droplets(**given)

    def field() -> Case:
        key, value = r.choice([("voltage", -1.0), ("voltage", "2 A"), ("thickness", "-1 nm"), ("permittivity", 0.5),
                               ("method", "fast"), ("dc", 1), ("surface", np.zeros((3, 3))), ("gap", wrong_map(r)),
                               ("skin_layer", float("nan")), ("edge_radius", -1e-9)])
        given: dict[str, Any] = {"gap": flat + 1e-8, "size": "6 um", "voltage": "100 V", key: value}
        return key, lambda: pp.field(**given)

    def options() -> Case:
        key, value = r.choice([("level", "best"), ("level", 3), ("target", 1.5), ("target", "5 m"), ("target", 1e-12), ("threads", -1),
                               ("threads", 1.5), ("voltage_for", [0]), ("progress", 3), ("look", "yes")])
        return key, lambda: good.evaluate(**{key: value})

    def studies() -> Case:
        return r.choice([
            ("values", lambda: study.judge([1e-7, 2e-7])), ("texture.depth", lambda: study.judge([1.0])),
            ("texture.depth", lambda: study.judge({"texture.depth": "3 V"})), ("texture.width", lambda: study.judge({"texture.width": 1})),
            ("points", lambda: study.tell([], [])), ("threads", lambda: study.judge([2e-7], threads=-2)),
            ("design_space", lambda: pp.Study({**STUDY, "design_space": {"texture.depth": [1e-7, 5e-7]}})),
            ("design_space", lambda: pp.Study(HOLES)), ("objective", lambda: pp.Study({**STUDY, "objective": {}})),
            ("texture.depth", lambda: study.judge([float("nan")])),
        ])

    def files() -> Case:
        name = r.choice(["no/such.toml", str(ROOT), str(ROOT / "designs/measured_surface/scan.gsf"), "/dev/null"])
        return name, r.choice([lambda: pp.Design.load(name), lambda: pp.Study.load(name), lambda: pp.persson(name),
                               lambda: pp.drive(name), lambda: pp.calibrate(name)])

    def others() -> Case:
        return r.choice([
            ("size", lambda: good.export("nowhere", size=-1)), ("pixels", lambda: good.heights(65536)),
            ("values", lambda: pp.sweep(good, {"texture.depth": [1e-7] * 1000, "drive.amplitude": [50] * 1000})),
            ("relative_humidity", lambda: good.with_({"environment.relative_humidity": list(np.linspace(0, 1, 100_000))})),
            ("folder", lambda: pp.Calibration.open("no/such")), ("sources.0", lambda: pp.Lab.open([3], "nowhere")),  # type: ignore[list-item]
            ("designs", lambda: pp.rank([good])), ("designs.1", lambda: pp.rank([good, 3])),  # type: ignore[list-item]
            ("metric", lambda: good.sensitivity("mean(nothing)")), ("step", lambda: good.sensitivity(step=2.0)),
            ("texture.with", lambda: good.sensitivity(keys=["texture.with"])), ("pixels", lambda: good.heights(3)),
            ("pixels", lambda: good.heights(1.5)),  # type: ignore[arg-type]
            ("second", lambda: pp.compare(good, None)),  # type: ignore[arg-type]
            ("polarity", lambda: good.export("nowhere", ["tiff"], polarity="up")), ("bmp", lambda: good.export("nowhere", ["bmp"])),
            ("index", lambda: pp.haze(flat, "6 um", index=9)), ("angles", lambda: pp.haze(flat, "6 um", angles=["80 deg"])),
            ("path", lambda: pp.verify(3)),  # type: ignore[arg-type]
            ("surface", lambda: pp.field(flat, "6 um", voltage=1, surface=pp.Heights(flat, 1e-3, 1e-3))),
            ("path", lambda: pp.verify("\udcff")), ("values", lambda: good.with_([("texture.depth", 3e-7)])),  # type: ignore[arg-type]
            ("relative_humidity", lambda: good.with_({"environment.relative_humidity": {0.3, 0.5}})),
            ("title", lambda: good.with_({"title": b"x"})),
            ("theta1", lambda: pp.bridge("1 um3", "1 nm", "190 deg", 1)), ("gap", lambda: pp.bridge("1 um3", 0, 1, 1)),
        ])

    makers = [design_value, contact, heights, water, field, options, studies, files, others]
    return [makers[i % len(makers)]() for i in range(count)]


@pytest.mark.parametrize("case", cases(300), ids=lambda case: str(case[0])[-24:])
def test_a_wrong_input_is_an_input_error_that_names_the_key(case: Case) -> None:
    key, call = case
    with pytest.raises(pp.InputError) as caught:
        call()
    problems = caught.value.problems
    assert problems and all(p.message for p in problems)
    assert any(key in p.key or key in p.file or key in p.message for p in problems), str(caught.value)
    assert not re.search(r"(^|[\s(])--[a-z]", str(caught.value))  # options of the command


def test_every_mistake_is_said_with_its_place(tmp_path: pathlib.Path) -> None:
    file = tmp_path / "wrong.toml"
    file.write_text('schema_version = 1\n[texture]\ntype = "hole_array"\nperiod = 3\ndepht = "1 nm"\n')
    with pytest.raises(pp.InputError) as caught:
        pp.Design.load(file)
    first, second = caught.value.problems
    assert (first.line, first.column, first.key) == (4, 10, "texture.period")
    assert first.text == f'{file}:4:10: texture.period: needs a unit, e.g. "3 um"'
    assert second.line == 5 and "depth" in second.message
    assert pickle.loads(pickle.dumps(caught.value)).problems == caught.value.problems


def test_what_no_simulation_settles_is_drawn_alone(tmp_path: pathlib.Path) -> None:
    wet = pp.Design({**HOLES, "base": "m3_samples/common.toml", "finger.water.drops_per_um3": 100_000})
    assert len(wet.export(tmp_path / "e", "npy", pixels=64).files) == 1
    dry = wet.with_({"finger.water.drops_per_um3": 100})
    for call in (wet.evaluate, lambda: pp.sweep(dry, {"finger.water.drops_per_um3": [100, 100_000]}),
                 lambda: pp.Study({**STUDY, "finger.water.drops_per_um3": 100_000})):
        with pytest.raises(pp.InputError, match="finger.water.drops_per_um3.*droplets on a patch"):
            call()


def test_a_half_space_has_no_layer() -> None:
    z = np.zeros((8, 8))
    for name, given in (("layer_thickness", "1 um"), ("layer_poisson", 0.4), ("bulk_modulus", "1 MPa"), ("bulk_poisson", 0.3)):
        with pytest.raises(pp.InputError, match=f"^{name}: is of layer_modulus"):
            pp.contact(z, "1 um", pressure="1 kPa", modulus="1 MPa", **{name: given})  # type: ignore[arg-type]


def test_damaged_files_are_refused(tmp_path: pathlib.Path) -> None:
    r = random.Random(7)
    whole = (ROOT / "designs/m3_samples/a3h350.toml").read_bytes()
    refused = 0
    for i in range(50):
        damaged = bytearray(whole)
        for _ in range(8):
            damaged[r.randrange(len(damaged))] = r.randrange(256)
        file = tmp_path / f"{i}.toml"
        file.write_bytes(bytes(damaged))
        try:
            pp.Design.load(file, {"base": str(ROOT / "designs/m3_samples/common.toml")})
        except pp.InputError:
            refused += 1
    assert refused > 30


def test_saving_follows_no_link_of_a_stranger(tmp_path: pathlib.Path) -> None:
    mine = tmp_path / "mine"
    mine.write_text("mine")
    folder = tmp_path / "folder"
    folder.mkdir()
    for name in ("d.toml", "d.toml.part", "d.heights.npy.part"):
        (folder / name).symlink_to(mine)
    pp.Design(HOLES).save(folder / "d.toml")
    pp.Design.from_heights(np.random.default_rng(1).random((8, 8)) * 1e-8, "1 um").save(folder / "d.toml")
    assert mine.read_text() == "mine" and not (folder / "d.toml").is_symlink()
    (folder / "d.toml").chmod(0o600)
    pp.Design(HOLES).save(folder / "d.toml")
    assert (folder / "d.toml").stat().st_mode & 0o777 == 0o600
    assert not [file for file in folder.iterdir() if file.name.startswith(".")]  # nothing half written
    long = folder / ("long" * 63 + "rest.toml")  # too long a name, whoever saves
    with pytest.raises(OSError):
        pp.Design(HOLES).save(long)
    assert not [file for file in folder.iterdir() if file.name.startswith(".")]


@pytest.mark.parametrize("name", ["fit.json", "fit.md", "finger.toml"])
def test_a_pipe_in_a_folder_holds_nothing_up(tmp_path: pathlib.Path, name: str) -> None:
    for other in ("fit.json", "fit.md", "finger.toml"):
        if other != name:
            (tmp_path / other).write_text("")
    os.mkfifo(tmp_path / name)
    with pytest.raises(pp.InputError, match=f"holds no {re.escape(name)}"):
        pp.Calibration.open(tmp_path)


RUN = {"interrupted": False, "feasible": True, "evaluations": 4, "best": 0, "finalists": [
    {"folder": "front/01", "values": [2e-7],
     **{stage: {"ok": True, "reason": "", "values": [1.0], "errors": [0.1], "violations": []} for stage in ("searched", "confirmed")}}]}


@pytest.mark.parametrize("damaged", [
    b"", b"3", b"[]", b"\xff", b"[" * 100000, json.dumps({**RUN, "finalists": [1]}).encode(), json.dumps({**RUN, "finalists": None}).encode(),
    json.dumps({**RUN, "best": 1}).encode(), json.dumps({**RUN, "best": "x"}).encode(), b'{"finalists": [], "best": ' + b"1" * 5000 + b"}"], ids=range(10))
def test_a_damaged_run_is_refused(tmp_path: pathlib.Path, damaged: bytes) -> None:
    pp.Design(HOLES).save(tmp_path / "resolved.toml")
    with open(tmp_path / "resolved.toml", "a", encoding="utf-8") as file:
        file.write('[objective]\nminimise = "mean(friction)"\n[design_space]\n"texture.depth" = ["200 nm", "500 nm"]\n')
    (tmp_path / "run.json").write_text(json.dumps(RUN))
    assert pp.Run.open(tmp_path).best.point["texture.depth"] == 2e-7
    (tmp_path / "run.json").write_bytes(damaged)
    with pytest.raises(pp.InputError, match="run.json"):
        pp.Run.open(tmp_path)


def test_numbers_without_axes_and_single_texts_are_taken(tmp_path: pathlib.Path) -> None:
    d = pp.Design({**HOLES, "texture.depth": np.array(350e-9)})
    assert d["texture.depth"] == 350e-9
    done = d.export(tmp_path / "e", "npy", size=np.array(6e-6), pixels=np.array(64))
    assert [pathlib.Path(f).name for f in done.files] == ["heightmap.npy"]
    assert pp.bridge(np.array(1e-20), "100 nm", "80 deg", "50 deg").exists
    with pytest.raises(pp.InputError, match="unknown format \"npy,gds\""):
        d.export(tmp_path / "f", "npy,gds")
    with pytest.raises(pp.InputError, match="texture.dep"):
        d.sensitivity(keys="texture.dep")


def test_numbers_beyond_64_bits_and_long_names_are_wrong_inputs() -> None:
    for call in (lambda: pp.bridge(10**400, 1e-7, 1.0, 1.0), lambda: pp.Design(HOLES).evaluate(target=10**400),
                 lambda: pp.Study(STUDY).judge([10**400]), lambda: pp.Study(STUDY).judge([None]),
                 lambda: pp.Design.load("a" * 5000), lambda: pp.calibrate("a" * 5000),
                 lambda: pp.Design(HOLES).export("a" * 5000), lambda: pp.verify("a" * 5000)):
        with pytest.raises(pp.InputError):
            call()
