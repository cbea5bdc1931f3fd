"""A lab from Python: opened, told, planned again."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

import papilla as pp

HEAD = "design,repeat,load_N,humidity_percent,voltage_V,day,F_off_N,F_on_N\n"


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> pp.Lab:
    place = tmp_path_factory.mktemp("lab")
    members = "".join(f'[[member]]\nweight = 0.5\nhypothesis = "one"\nset = {{ "macro.shear_strength" = "{s} MPa" }}\n'
                      for s in (8, 10))
    (place / "belief.toml").write_text(
        'schema_version = 1\n[calibrated_for]\ncoupling = "equilibrium"\nair_limit = "ionisation"\n' + members)
    files = []
    for name, depth in (("deep", 600), ("shallow", 200)):
        design = pp.Design.load("m3_samples/a3h600.toml").with_(
            {"texture.depth": f"{depth} nm", "accuracy.level": "draft", "accuracy.grid": 48})
        design.save(place / f"{name}.toml")
        files.append(place / f"{name}.toml")
    return pp.Lab.open(files, place / "lab", belief=place / "belief.toml", humidity="35 %", count=3, date="2026-03-01")


def test_a_lab_plans_a_batch_with_expectations(lab: pp.Lab) -> None:
    assert lab.batch is not None
    assert lab.batch.purpose == "decision"
    assert lab.batch.keeps_limits is True  # designs of files have no limits
    for e in lab.batch.experiments:
        assert e.design in ("deep", "shallow")
        assert e.humidity == 0.35
        assert e.friction_on[1] <= e.friction_on[0] <= e.friction_on[2]


def test_a_table_counts_once_and_a_wrong_one_not_at_all(lab: pp.Lab, tmp_path: Path) -> None:
    table = tmp_path / "a.csv"
    table.write_text(HEAD + "deep,1,0.2,35,200,1,0.06,0.09\n")
    assert lab.tell(table, date="2026-03-02").readings == 1
    again = lab.tell(table, date="2026-03-02")
    assert (again.readings, again.already) == (0, 1)
    wrong = tmp_path / "b.csv"
    wrong.write_text(HEAD + "deep,2,0.2,35,200,1,60,90\n")
    with pytest.raises(pp.InputError, match="are these mN"):
        lab.tell(wrong)
    assert lab.state()["standing"]["readings"] == 1


def test_a_lab_that_is_opened_again_has_its_batch(lab: pp.Lab) -> None:
    again_open = pp.Lab(lab.folder)
    again = again_open.batch
    assert again is not None and lab.batch is not None
    assert list(again) == lab.batch.experiments and len(again) == len(lab.batch)
    assert (again.purpose, again.stop) == (lab.batch.purpose, lab.batch.stop)
    with pytest.raises(pp.InputError, match="seconds.*expected 0, no limit, or more"):
        again_open.next(seconds=-5)
    with pytest.raises(pp.InputError, match="^seconds: "):
        again_open.next(seconds="x")
    for call in (lambda: again_open.next(date="x"), lambda: again_open.tell("a.csv", date="2026-13-01")):
        with pytest.raises(pp.InputError, match="^date: expected year, month and day"):
            call()


def test_a_day_has_one_text_in_the_journal(lab: pp.Lab, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(lab.folder, tmp_path / "lab"))
    table = tmp_path / "a.csv"
    table.write_text("design,load_N,humidity_percent,voltage_V,F_off_N,F_on_N\ndeep,0.2,35,200,0.06,0.09\n")
    pp.Lab(folder).tell(table, date="20260305")
    journal = (folder / "lab.journal").read_text()
    assert "2026-03-05" in journal and "20260305" not in journal


def test_a_lab_takes_designs_and_starts_again_after_a_wrong_word(tmp_path: Path, lab: pp.Lab) -> None:
    design = pp.Design.load("m3_samples/a3h600.toml").with_({"accuracy.level": "draft", "accuracy.grid": 48, "title": "my holes"})
    options = {"belief": Path(lab.folder).parent / "belief.toml", "humidity": "35 %", "count": 1}
    with pytest.raises(pp.InputError, match="nothing is decided"):
        pp.Lab.open(design, tmp_path / "own", purpose="decision", **options)
    opened = pp.Lab.open([design], tmp_path / "own", values={"instrument": {"repeatability": 0.02}}, **options)
    assert "repeatability = \"2 %\"" in (tmp_path / "own" / "lab.toml").read_text()
    assert opened.batch is not None and opened.batch.experiments[0].design == "my_holes"
    assert opened.page.startswith("# Lab: my_holes\n")
    with pytest.raises(pp.InputError, match="is a lab already"):
        pp.Lab.open(design, tmp_path / "own", **options)
    variants = [design, design.with_({"texture.depth": "300 nm"})]
    for names in (["deep"], ["same", "same"], ["deep", "?"]):
        with pytest.raises(pp.InputError, match="a name of its own for each of 2 designs"):
            pp.Lab.open(variants, tmp_path / "named", names=names, **options)
    named = pp.Lab.open(variants, tmp_path / "named", names=["deep", "shallow one"], **options)
    assert "| shallow_one |" in named.page and "| deep |" in named.page
