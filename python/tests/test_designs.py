"""Designs from files, dicts and arrays; what they give back."""

from __future__ import annotations

import copy
import gc
import json
import pathlib
import pickle

import numpy as np
import pytest

import kinds
import papilla as pp
from conftest import QUICK, ROOT, command_json


def drawn(n: int = 96) -> np.ndarray:
    x = np.arange(n) / n
    return 80e-9 * (np.cos(2 * np.pi * 3 * x)[None, :] + np.sin(2 * np.pi * 2 * x)[:, None]) - 1e-7 / 3


def test_texts_carry_units_and_numbers_are_si() -> None:
    d = pp.Design.load(ROOT / "designs/m3_samples/a3h350.toml")
    by_text = d.with_(**{"texture.depth": "262 nm", "surface.contact_angle": "80 deg"})
    by_number = d.with_({"texture": {"depth": 262e-9}, "surface.contact_angle": 80 * np.pi / 180})
    assert by_text["texture.depth"] == by_number["texture.depth"] == 262e-9
    assert by_text["surface.contact_angle"] == by_number["surface.contact_angle"]
    assert d["texture.depth"] == 350e-9, "the first is as before"
    assert d.with_({"environment.relative_humidity": np.array([0.2, 0.4])})["environment.relative_humidity.1"] == 0.4


def test_a_shipped_design_is_found_from_anywhere(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert pp.Design.load("m3_samples/a3h350.toml") == pp.Design.load(ROOT / "designs/m3_samples/a3h350.toml")
    assert pp.persson("physics/wrist_on_glass.toml").rms > 1e-6


def test_a_dict_is_the_file() -> None:
    file = pp.Design.load(ROOT / "designs/m3_samples/a3h350.toml")
    mine = pp.Design({"schema_version": 1, "base": "m3_samples/common.toml",
                      "title": "Published sample: holes of 3 um, 350 nm deep, period 6 um",
                      "texture": {"type": "hole_array", "lattice": "square", "period": 6e-6, "diameter": 3e-6,
                                  "depth": "350 nm", "wall_angle": "90 deg", "edge_radius": 0}})
    assert mine == file
    assert mine != file.with_({"texture.depth": "351 nm"})


def test_lists_of_sections_are_lists_of_dicts() -> None:
    d = pp.Design({"texture": {"type": "flat"}, "surface": {"dielectric": [
        {"material": "Al2O3", "thickness": 2e-7, "permittivity": 9}, {"material": "SiO2", "thickness": "50 nm"}]}})
    assert d["surface.dielectric.0.thickness"] == 2e-7
    assert d["surface.dielectric.1.thickness"] == 50e-9


@pytest.mark.parametrize("values", kinds.designs(11), ids=lambda values: values["title"])
def test_designs_survive_toml_pickle_and_copy(values: dict, tmp_path: pathlib.Path) -> None:
    d = pp.Design(values)
    d.save(tmp_path / "d.toml")
    for other in (pp.Design.parse(d.to_toml()), pp.Design.load(tmp_path / "d.toml"), pickle.loads(pickle.dumps(d)),
                  copy.copy(d), copy.deepcopy(d)):
        assert other == d
        assert other.to_dict() == d.to_dict()


@pytest.mark.parametrize("n", [8, 96, 100, 150])
def test_an_array_comes_back_to_the_last_bit(n: int) -> None:
    z = drawn(n)
    d = pp.Design.from_heights(z, "6.3 um")
    h = d.heights(n)
    assert np.array_equal(h.z, z - z.max())
    assert h.z.dtype == np.float64 and h.dx * n == pytest.approx(6.3e-6, rel=1e-15)
    again = pickle.loads(pickle.dumps(d))
    assert np.array_equal(again.heights(n).z, z - z.max()) and again == d
    assert d.with_({"finger.state": "natural"}) != d, "more than numbers makes a design"


@pytest.mark.parametrize("process", ["conformal", "directional", "planar"])
def test_an_offset_of_an_array_changes_nothing(process: str) -> None:
    x = (np.arange(64) + 0.5) / 64
    z = -200e-9 * (np.hypot(x[:, None] - 0.5, x[None, :] - 0.5) < 0.25)
    surface = {"process": process, "dielectric": [{"material": "SiO2", "thickness": "600 nm"}]}
    values = {"base": "m3_samples/flat.toml", "surface": surface, "accuracy": {"level": "draft", "grid": 64},
              "environment.relative_humidity": ["35 %"], "model.coupling": "one_pass"}  # an equilibrium amplifies rounding
    found = [pp.Design.from_heights(z + shift, "6 um", values).evaluate(force=True).modulation.value[0]
             for shift in (0, 100e-9, -1e-6, 3e-6)]
    assert found == pytest.approx([found[0]] * 4, rel=1e-9)
    holes = pp.Design({**values, "texture": {"type": "hole_array", "period": "6 um", "diameter": "3 um",
                                             "depth": "200 nm"}}).evaluate(force=True).modulation.value[0]
    assert found[0] == pytest.approx(holes, rel=0.05)


def test_heights_in_another_unit_and_masked_ones_are_refused() -> None:
    z = drawn(64)
    for far in (1e3, 1e9):
        with pytest.raises(pp.InputError, match="heights: heights over .* another unit"):
            pp.Design.from_heights(z * far, "6 um")
    for call in (lambda: pp.contact(z * 1e9, "6 um", pressure="20 kPa", modulus="1 MPa"),
                 lambda: pp.haze(z * 1e9, "6 um")):
        with pytest.raises(pp.InputError, match="another unit"):
            call()
    masked = np.ma.masked_less(z, z.mean())
    with pytest.raises(pp.InputError, match="are masked"):
        pp.Design.from_heights(masked, "6 um")
    assert pp.Design.from_heights(np.ma.masked_less(z, z.min()), "6 um")  # none is masked
    for rows, said in (([*masked], "of 64 values are masked"), ([z[0], z[1, :9]], "got rows of several lengths")):
        with pytest.raises(pp.InputError, match=f"heights: .*{said}"):
            pp.Design.from_heights(rows, "6 um")
    assert pp.Design.from_heights([list(row) for row in z], "6 um") == pp.Design.from_heights(z, "6 um")


def test_masked_numbers_are_refused() -> None:
    none, two = np.ma.masked, np.ma.masked_array([0.1, 0.2], [0, 1])
    for call, key in ((lambda: pp.contact(drawn(16), "6 um", pressure=none, modulus=1e6), "pressure"),
                      (lambda: pp.field(drawn(16) + 1e-6, "6 um", voltage=none), "voltage"),
                      (lambda: pp.haze(drawn(16), "6 um", angles=two), "angles"),
                      (lambda: pp.haze(drawn(16), two), "size"),
                      (lambda: pp.Design({"base": "m3_samples/flat.toml", "drive.amplitude": none}), "drive.amplitude"),
                      (lambda: pp.Design({"base": "m3_samples/flat.toml", "environment.relative_humidity": two}),
                       "environment.relative_humidity")):
        with pytest.raises(pp.InputError, match=f"{key}: 1 of . values are masked and have no number"):
            call()


def test_heights_go_where_an_array_does() -> None:
    heights = pp.Design.load("m3_samples/a3h350.toml").heights(32)
    assert np.shares_memory(np.asarray(heights), heights.z) and np.asarray(heights, dtype=np.float32).dtype == np.float32
    assert not np.shares_memory(np.array(heights, copy=True), heights.z)
    if int(np.__version__.split(".")[0]) >= 2:  # numpy 1 copies where it has to
        assert np.shares_memory(np.array(heights, copy=False), heights.z)
        with pytest.raises(ValueError, match="copy"):
            np.array(heights, dtype=np.float32, copy=False)
    made = pp.Design.from_heights(heights, heights.size, {"base": "m3_samples/flat.toml"})
    assert np.array_equal(made.heights(32).z, heights.z - heights.z.max())
    gap = np.full(heights.z.shape, 1e-6) - heights.z
    on_walls = pp.field(gap, heights.size, voltage=100, surface=heights, method="local")
    assert on_walls == pp.field(gap, heights.size, voltage=100, surface=heights.z, method="local")


def test_a_design_is_saved_under_the_name_of_a_file_alone(tmp_path: pathlib.Path) -> None:
    design, folder = pp.Design.load("m3_samples/flat.toml"), tmp_path / "dd"
    folder.mkdir()
    for name, said in ((folder, "is a folder: expected the name of a file"), (f"{tmp_path}/new/", "is a folder"),
                       (tmp_path / "no/such.toml", "the folder .*no is not there: make it first"), ("", "got an empty text")):
        with pytest.raises(pp.InputError, match=f"file: .*{said}"):
            design.save(name)
    with pytest.raises(pp.InputError, match="expected the name of a file"):
        pp.Design.load("")
    assert list(tmp_path.rglob("*")) == [folder]


def test_float32_and_transposed_arrays_count_by_their_values() -> None:
    z = np.asfortranarray(drawn().astype(np.float32))
    assert np.array_equal(pp.Design.from_heights(z, 6e-6).heights(96).z, z.astype(float) - z.max())
    z[0, 0] = 1  # the design has its own
    assert pp.Design.from_heights(drawn(), 6e-6).heights(96).z.max() < 1e-6


def test_a_drawn_design_is_saved_with_its_array(tmp_path: pathlib.Path) -> None:
    z = drawn()
    d = pp.Design.from_heights(z, "6 um", {"base": "m3_samples/flat.toml", "accuracy.level": "draft"})
    file = pathlib.Path(next(line for line in d.to_toml().splitlines() if line.startswith("file")).split('"')[1])
    assert file.exists()
    other = d.with_({"drive.amplitude": "100 V"})
    d.save(tmp_path / "drawn.toml")
    del d
    gc.collect()
    assert file.exists(), "another design names it"
    del other
    gc.collect()
    assert not file.exists()
    assert np.array_equal(pp.Design.load(tmp_path / "drawn.toml").heights(96).z, z - z.max())


@pytest.mark.parametrize("repeats", [True, False])
def test_a_drawn_design_reads_back_to_itself(repeats: bool, tmp_path: pathlib.Path) -> None:
    z = drawn(63)
    d = pp.Design.from_heights(z, "6 um", {"base": "m3_samples/flat.toml"}, repeats=repeats)
    d.save(tmp_path / "drawn.toml")
    d.save(tmp_path / "copy.toml")  # with heights of its own
    alike = [d, pp.Design.parse(d.to_toml()), pp.Design.load(tmp_path / "drawn.toml"), pp.Design.load(tmp_path / "copy.toml")]
    assert all(one == other and hash(one) == hash(other) for one in alike for other in alike)
    z[30, 30] += 1e-8
    another = pp.Design.from_heights(z, "6 um", {"base": "m3_samples/flat.toml"}, repeats=repeats)
    assert another != d and another != pp.Design.load(tmp_path / "drawn.toml")


def test_saving_a_drawn_design_keeps_every_other_file(tmp_path: pathlib.Path) -> None:
    z = drawn()
    np.save(tmp_path / "surface.npy", z * 1e9)  # as an instrument gave it, in nm
    raw = (tmp_path / "surface.npy").read_bytes()
    values = {"base": "m3_samples/flat.toml"}
    design = pp.Design.from_heights(np.load(tmp_path / "surface.npy") * 1e-9, "6 um", values)
    other = pp.Design.from_heights(2 * z, "6 um", values)
    design.save(tmp_path / "surface.toml")
    design.save(tmp_path / "surface.toml")  # the same heights: no second file
    first = (tmp_path / "surface.heights.npy").read_bytes()
    other.save(tmp_path / "surface.toml")
    assert (tmp_path / "surface.npy").read_bytes() == raw
    assert (tmp_path / "surface.heights.npy").read_bytes() == first
    assert {f.name for f in tmp_path.iterdir()} == {"surface.npy", "surface.toml", "surface.heights.npy",
                                                    "surface.heights-2.npy"}
    assert np.array_equal(pp.Design.load(tmp_path / "surface.toml").heights(96).z, 2 * z - (2 * z).max())


def test_a_map_that_repeats_is_pressed_on_a_patch_as_long_as_others() -> None:
    values = {"base": "m3_samples/flat.toml", **QUICK}
    flat = pp.Design(values).evaluate().friction_off.value[0]
    for size, n in (("1 um", 8), ("6 um", 16)):
        mine = pp.Design.from_heights(np.zeros((n, n)), size, values).evaluate().friction_off.value[0]
        assert mine == pytest.approx(flat, rel=0.01), size
    with pytest.raises(pp.InputError, match="^size: the patch that a map of this width leaves beside its seam: 0.83 um is shorter"):
        pp.Design.from_heights(np.zeros((8, 8)), "1 um", values, repeats=False)
    with pytest.raises(pp.InputError, match="^size: the width of the map: 6000000 um is outside"):
        pp.Design.from_heights(np.zeros((8, 8)), 6, values)


def test_a_drawn_hole_array_is_evaluated_as_the_kind_is() -> None:
    holes = pp.Design.load(ROOT / "designs/m3_samples/a3h350.toml", QUICK)
    patch = holes.heights(64)
    assert patch.size[0] == pytest.approx(patch.size[1])
    base = {"base": "m3_samples/common.toml", **QUICK}
    mine = pp.Design.from_heights(patch.z, patch.size[0], base).evaluate()
    theirs = holes.evaluate()
    assert mine.friction_off.value[0] == pytest.approx(theirs.friction_off.value[0], rel=0.03)
    assert mine.modulation.value[0] == pytest.approx(theirs.modulation.value[0], rel=0.06)


def test_heights_are_the_memory_of_the_library() -> None:
    h = pp.Design({"texture": {"type": "hole_array", "period": "6 um", "diameter": "3 um", "depth": "350 nm"}}).heights(64)
    assert h.z.shape[1] == 64 and h.z.min() == pytest.approx(-350e-9) and h.z.max() == 0
    assert h.z.ctypes.data == h.z.ctypes.data, "no copy at each access"
    z = h.z
    del h
    gc.collect()
    assert z.max() == 0, "the view keeps what it looks at"


def test_pictures_are_well_formed() -> None:
    from xml.etree import ElementTree

    d = pp.Design({"title": "a <b>", "texture": {"type": "grating", "period": "4 um", "width": "2 um", "depth": "90 nm"}})
    page = d._repr_html_()
    assert "a &lt;b&gt;" in page and "90 nm" in page
    svg = page[page.index("<svg"):page.index("</svg>") + 6]
    assert ElementTree.fromstring(svg).tag.endswith("svg")


def test_look_and_haze_agree_on_one_period() -> None:
    d = pp.Design({"texture": {"type": "waves", "period": "6 um", "depth": "120 nm", "directions": "one"}})
    assert d.look().regime == "phase screen"
    assert pp.haze(d.heights(256)).haze == pytest.approx(d.look().haze, rel=0.02)


def test_numbers_say_unit_range_and_meaning() -> None:
    numbers = {n.path: n for n in pp.Design({"texture": {"type": "flat"}}).numbers}
    angle = numbers["surface.contact_angle"]
    assert angle.unit == "deg" and angle.low == 0 and angle.high == pytest.approx(np.pi) and "angle" in angle.meaning


def test_a_fitted_finger_replaces_that_of_a_design() -> None:
    lines = (ROOT / "designs/fingers/reference.toml").read_text().splitlines(keepends=True)
    finger = "".join(line for line in lines if not line.startswith("belief"))  # another fit has none, or its own
    fit = pp.Calibration({"converged": True, "explains_data": True, "warning": "", "parameters": [], "chi2_before": 2.0,
                          "chi2": 1.0, "degrees_of_freedom": 1, "finger": finger.replace('"207 nm"', '"300 nm"'),
                          "table": "", "json": "{}"})
    d = pp.Design.load("m3_samples/a3h350.toml", {"finger.load": "0.5 N"})
    fitted = fit.apply(d)
    assert fitted["finger.skin.rms"] == 300e-9
    assert fitted["finger.load"] == 0.5  # a condition of the design, not of who was fitted
    assert fitted["texture.depth"] == d["texture.depth"]
    with pytest.raises(pp.InputError, match="expected a Design"):
        fit.apply("a3h350.toml")  # type: ignore[arg-type]


def test_a_fit_is_opened_with_what_it_told(tmp_path: pathlib.Path) -> None:
    told = {"converged": False, "explains_data": True, "warning": "not converged after 4 iterations", "chi2_before": 2.0,
            "chi2": 1.0, "degrees_of_freedom": 1, "parameters": []}
    (tmp_path / "fit.md").write_text("# Fit\n")
    (tmp_path / "finger.toml").write_text("")
    for known, explains in ((told, True), ({**told, "explains_data": False}, False),
                            ({key: value for key, value in told.items() if key != "explains_data"}, False)):
        (tmp_path / "fit.json").write_text(json.dumps(known))
        assert pp.Calibration.open(tmp_path).explains_data is explains


def test_another_kind_has_nothing_of_the_one_before() -> None:
    holes = pp.Design({"base": "m3_samples/common.toml",
                       "texture": {"type": "hole_array", "period": "6 um", "diameter": "3 um", "depth": "350 nm"}})
    flat = holes.with_({"texture.type": "flat"})
    assert not [key for key in flat.to_dict() if key.startswith("texture.")]
    loaded = pp.Design.load("m3_samples/a3h350.toml").with_({"texture.depth": "262 nm"}).with_({"texture.type": "flat"})
    assert not [key for key in loaded.to_dict() if key.startswith("texture.")]
    map_then_flat = pp.Design.from_heights(drawn(16), "12 um", {"base": "m3_samples/common.toml"}).with_({"texture.type": "flat"})
    assert map_then_flat == pp.Design.parse(map_then_flat.to_toml()) == pickle.loads(pickle.dumps(map_then_flat))


def test_a_title_with_a_hash_is_told_from_another() -> None:
    d = pp.Design.load("m3_samples/flat.toml")
    three = d.with_({"title": "Sample #3"})
    assert three != d.with_({"title": "Sample #4"}) and three == pp.Design.parse(three.to_toml())
    assert d.with_({"title": "a  # b"}) != d.with_({"title": "a  # c"})
    assert d.with_({"title": "a  # b"}) == pp.Design.load("m3_samples/flat.toml", {"title": "a  # b"})
    assert d.with_({"title": 'a "#" 3'}) != d.with_({"title": 'a "#" 4'})


def test_designs_are_keys_of_dicts() -> None:
    d = pp.Design.load("m3_samples/a3h350.toml")
    again = pickle.loads(pickle.dumps(d))
    assert {d: "first"}[again] == "first" and hash(d) != hash(d.with_({"texture.depth": "351 nm"}))
    z = drawn()
    one, other = pp.Design.from_heights(z, "6 um"), pp.Design.from_heights(z, "6 um")
    assert one == other and hash(one) == hash(other)


def test_heights_survive_pickle_and_copy() -> None:
    h = pp.Design.load("m3_samples/a3h350.toml").heights(64)
    for other in (pickle.loads(pickle.dumps(h)), copy.copy(h), copy.deepcopy(h)):
        assert np.array_equal(other.z, h.z) and (other.dx, other.dy) == (h.dx, h.dy) and other.size == h.size
    assert pp.contact(pickle.loads(pickle.dumps(h)), pressure="20 kPa", modulus="1 MPa").converged


def test_representations_are_short() -> None:
    h = pp.Design.load("m3_samples/a3h350.toml").heights(64)
    shown = repr(pp.contact(h, pressure="20 kPa", modulus="1 MPa"))
    assert "pressure=<64 x 64 float64>" in shown and len(shown) < 400


def test_a_level_and_a_target_are_not_given_together() -> None:
    with pytest.raises(pp.InputError, match="target: give a level or a target, not both"):
        pp.Design.load("m3_samples/a3h350.toml").evaluate("draft", target=0.05)


def test_a_scan_is_what_the_command_shows(tmp_path: pathlib.Path) -> None:
    file = ROOT / "designs/measured_surface/scan.gsf"
    scan = pp.read_scan(file, tip="20 nm")
    assert scan.to_dict() == command_json("surface", str(file), "--tip", "20 nm")
    assert scan.changes.startswith(str(file)) and scan.roughness["Sq"] == scan.to_dict()["areal"]["Sq"]
    assert np.array_equal(pickle.loads(pickle.dumps(scan)).heights.z, scan.heights.z)
    assert scan.design({"base": "m3_samples/common.toml"}).heights(64).z.shape == (64, 64)
    assert pp.read_scan("measured_surface/scan.gsf").roughness == scan.roughness, "looked for where the command looks"
    with pytest.raises(pp.InputError, match="nowhere.gsf"):
        pp.read_scan(tmp_path / "nowhere.gsf")
    with pytest.raises(pp.InputError, match="cannot read nowhere.gsf"):
        pp.read_scan("nowhere.gsf")
    with pytest.raises(pp.InputError, match="tip"):
        pp.read_scan(file, tip=-1e-9)


def test_a_wave_has_its_roughness_and_its_line_in_the_spectrum() -> None:
    n, waves, height = 256, 16, 80e-9
    z = np.broadcast_to(height * np.sin(2 * np.pi * waves * (np.arange(n) + 0.5) / n), (n, n))
    told = pp.roughness(z + 5e-9, "32 um")
    assert told["Sq"] == pytest.approx(height / np.sqrt(2), rel=1e-9) and told["Sz"] == pytest.approx(2 * height, rel=0.02)
    assert told["Ssk"] == pytest.approx(0, abs=1e-9) and told["Sku"] == pytest.approx(1.5, rel=1e-9)
    s = pp.spectrum(z, "32 um")
    assert s.wavelength[np.argmax(s.density)] == pytest.approx(2e-6, rel=0.13), "a tenth of a decade wide"
    assert s.longest == pytest.approx(8e-6) and not s.by_tip and s.known[np.argmax(s.density)] and not s.known[0]
    assert pp.spectrum(z, "32 um", tip="100 um").by_tip
    with pytest.raises(pp.InputError, match="heights: .*no surface is so steep"):
        pp.roughness(z * 1e9, "32 um")


def test_a_title_says_what_was_changed_of_its_design() -> None:
    d = pp.Design.load("m3_samples/a3h600.toml")
    shallow = d.with_({"texture.depth": "300 nm"})
    assert shallow.title == d.title + "; texture.depth 300 nm"
    again = shallow.with_({"texture.depth": 2.5e-7, "drive.amplitude": "100 V", "accuracy.level": "draft"})
    assert again.title == d.title + "; texture.depth 250 nm; drive.amplitude 100 V"
    assert d.with_({"finger": {"load": "0.3 N", "state": "wet", "macro": {"load_share": 0.01, "shear_strength": "7 MPa"}}}).title == d.title + "; finger changed"
    assert d.with_({"texture.depth": "300 nm", "title": "mine"}).title == "mine"
    assert d.with_().title == d.with_({"accuracy.grid": 64}).title == d.title
    for wrong in (True, [1e-7, 2e-7], "deep"):
        with pytest.raises(pp.InputError, match="texture.depth"):
            d.with_({"texture.depth": wrong})
    assert pp.Design({"texture.type": "flat"}).with_({"drive.amplitude": "100 V"}).title == ""
    assert pp.Design.parse(shallow.to_toml()).title == shallow.title
