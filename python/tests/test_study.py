"""Studies: asked and told, judged, and run to the end."""

from __future__ import annotations

import copy
import json
import os
import pathlib
import pickle
import signal
import threading

import numpy as np
import pytest

import papilla as pp
from conftest import THOROUGH

STUDY = {"base": "m3_samples/a3h350.toml", "environment.relative_humidity": ["50 %"],
         "accuracy": {"level": "draft", "grid": 32},
         "design_space": {"texture.depth": ["100 nm", "500 nm"], "surface.contact_angle": ["40 deg", "80 deg"]},
         "objective": {"maximise": "mean(modulation)"}, "search": {"evaluations": 30, "seed": 3}}


def test_ask_and_tell_find_a_planted_best() -> None:
    study = pp.Study(STUDY)
    best: tuple[float, pp.Point] | None = None
    for _ in range(60):
        points = study.ask()
        if not points:
            break
        values = [1 - ((p["texture.depth"] - 3e-7) / 1e-7) ** 2 - (p["surface.contact_angle"] - 1) ** 2 for p in points]
        study.tell(points, values, errors=[0.01] * len(points))
        best = max([*([best] if best else []), *zip(values, points)], key=lambda pair: pair[0])
    assert best is not None
    assert best[1]["texture.depth"] == pytest.approx(3e-7, abs=2e-8)
    assert best[1].design["texture.depth"] == best[1]["texture.depth"]


def test_asking_ends_after_the_evaluations_of_the_study() -> None:
    study = pp.Study({**STUDY, "search": {"evaluations": 12, "seed": 3}})
    told = 0
    while points := study.ask():
        study.tell(points, [p["texture.depth"] * 1e6 for p in points])
        told += len(points)
        assert told <= 12
    assert told == 12 and study.ask() == [] and copy.copy(study).ask() == []


def test_a_range_replaces_that_of_the_file(tmp_path: pathlib.Path) -> None:
    file = tmp_path / "study.toml"
    file.write_text('''schema_version = 1
base = "m3_samples/a3h350.toml"
[design_space]
"texture.period" = ["5 um", "12 um"]
[objective]
maximise = "mean(modulation)"
''', encoding="utf-8")
    change = {"design_space": {"texture.period": ["5 um", "8 um"]}}
    for study in (pp.Study.load(file, change), pp.Study({"base": str(file), **change})):
        assert [(x.path, x.low, x.high) for x in study.variables] == [("texture.period", 5e-6, 8e-6)]


def test_a_metric_with_arguments_is_limited() -> None:
    limited = {**STUDY, "constraints": {"worst(voltage_for(modulation = 0.5))": "150 V"}}
    assert len(pp.Study(limited).variables) == 2
    with pytest.raises(pp.InputError, match="voltage_for"):
        pp.Study({**STUDY, "constraints": {"worst(voltage_for(modulation = 0.5))": "150 N"}})
    for name in ("worst(modulation) = 1", "worst(modulation)=(1)", "a = 0.5"):
        with pytest.raises(pp.InputError, match="expected the name of a key"):
            pp.Study({**STUDY, "constraints": {name: 0.3}})


def test_two_searches_of_one_study_ask_alike() -> None:
    asked = []
    for study in (pp.Study(STUDY), pickle.loads(pickle.dumps(pp.Study(STUDY)))):
        points = study.ask()
        study.tell(points, [None if i == 0 else float(i) for i in range(len(points))])
        asked.append([list(p.values()) for p in points + study.ask()])
    assert asked[0] == asked[1]


def test_copies_keep_what_was_told() -> None:
    study = pp.Study(STUDY)
    for _ in range(2):
        points = study.ask()
        study.tell(points, [float(i) for i in range(len(points))])
    copies = [copy.deepcopy(study), copy.copy(study), pickle.loads(pickle.dumps(study))]
    wanted = [list(p.values()) for p in study.ask()]
    for other in copies:
        assert [list(p.values()) for p in other.ask()] == wanted
    waiting = pickle.loads(pickle.dumps(study))  # asked, not told yet
    with pytest.raises(pp.InputError, match="tell"):
        waiting.ask()
    points = list(study._asked)
    study.tell(points, [1.0] * len(points))
    waiting.tell(points, [1.0] * len(points))
    assert [list(p.values()) for p in waiting.ask()] == [list(p.values()) for p in study.ask()]


def test_what_is_told_is_checked() -> None:
    study = pp.Study(STUDY)
    points = study.ask()
    for key, call in [("values", lambda: study.tell(points, [1.0] * (len(points) + 1))),
                      ("values", lambda: study.tell(points, [float("nan")] * len(points))),
                      ("values", lambda: study.tell(points, [[1.0, 2.0]] * len(points))),
                      ("errors", lambda: study.tell(points, [1.0] * len(points), [-1.0] * len(points))),
                      ("points", lambda: study.tell(points[:-1] + [study.own], [1.0] * len(points))),
                      ("violations", lambda: study.tell(points, [1.0] * len(points), None, [[1.0]] * len(points))),
                      ("ask", study.ask)]:
        with pytest.raises(pp.InputError) as caught:
            call()
        assert caught.value.problems[0].key == key
    study.tell(points, np.ones(len(points)), np.full(len(points), 0.1))


def test_masked_values_are_not_told() -> None:
    study = pp.Study(STUDY)
    points = study.ask(1)
    told = np.ma.masked_array([0.5], True)
    with pytest.raises(pp.InputError, match="values: .* are masked"):
        study.tell(points, [told])
    own = study.own.values_si
    with pytest.raises(pp.InputError, match="1 of 2 values are masked"):
        study.point(np.ma.masked_array(own, np.arange(len(own)) == 0))


def test_judge_is_the_model() -> None:
    study = pp.Study({**STUDY, "constraints": {"min_wall": "2.9 um"}})
    good = study.judge({"texture.depth": "300 nm", "surface.contact_angle": "50 deg"})
    assert good.ok and good.values.shape == (1,) and 0.1 < good.values[0] < 3 and good.errors[0] > 0
    tight = pp.Study({**STUDY, "constraints": {"min_wall": "3.5 um"}})
    refused = tight.judge([3e-7, 1.0])
    assert not refused.ok and "wall" in refused.reason


def test_only_a_run_that_is_resumed_can_be_finished(tmp_path: pathlib.Path) -> None:
    with pytest.raises(pp.InputError, match="finish: goes on with a run that was interrupted"):
        pp.Study(STUDY).optimize(tmp_path / "new", finish=True)
    assert not (tmp_path / "new").exists()


def test_a_model_that_the_finger_was_not_fitted_with_is_refused(tmp_path: pathlib.Path) -> None:
    with pytest.raises(pp.InputError, match="was fitted with(.|\n)*set `force`"):
        pp.Study({**STUDY, "model": {"rim_pinning": True}}).optimize(tmp_path / "new")
    assert not (tmp_path / "new").exists()
    thin = pp.Study({**STUDY, "model": {"rim_pinning": True}, "constraints": {"min_wall": "3.5 um"}})
    with pytest.raises(pp.InputError, match="was fitted with(.|\n)*set `force`"):
        thin.judge([3e-7, 1.0])
    assert "wall" in thin.judge([3e-7, 1.0], force=True).reason
    flat = pp.Design({"base": "m3_samples/flat.toml", "model": {"rim_pinning": True}})
    with pytest.raises(pp.InputError, match="was fitted with(.|\n)*set `force`"):
        pp.rank([flat, flat.with_({"surface.contact_angle": "60 deg"})])


@pytest.mark.slow
def test_a_run_that_is_finished_asks_for_no_more_designs(tmp_path: pathlib.Path) -> None:
    study = pp.Study({**STUDY, "search": {"evaluations": 2000, "seed": 3}})

    sent: list[int] = []

    def interrupt(stage: str, done: int, total: int, left: float) -> None:
        if stage == "search" and done >= 5 and not sent:  # two may be done at once: 5 is not said then
            sent.append(done)
            threading.Timer(0, os.kill, (os.getpid(), signal.SIGINT)).start()

    with pytest.raises(KeyboardInterrupt):
        study.optimize(tmp_path / "run", progress=interrupt)
    run = study.optimize(tmp_path / "run", resume=True, finish=True)
    assert not run.interrupted and 5 <= run.evaluations < 2000 and run.best.confirmed.ok


@pytest.mark.slow
def test_a_search_runs_to_its_end_and_goes_on_after_ctrl_c(tmp_path: pathlib.Path) -> None:
    study = pp.Study({**STUDY, "search": {"evaluations": 15, "seed": 3}})
    study.own.design.evaluate()  # threads of OpenMP exist before the search forks
    seen: list[str] = []

    def interrupt(stage: str, done: int, total: int, left: float) -> None:
        if stage == "search" and done >= 5 and stage not in seen:
            seen.append(stage)
            threading.Timer(0, os.kill, (os.getpid(), signal.SIGINT)).start()

    with pytest.raises(KeyboardInterrupt):
        study.optimize(tmp_path / "run", progress=interrupt)
    assert "search" in seen
    run = study.optimize(tmp_path / "run", resume=True)
    assert not run.interrupted and run.finalists and run.best.confirmed.ok
    assert run.best in run.front or run.best.folder
    design = run.best.load()
    assert 1e-7 <= design["texture.depth"] <= 5e-7
    assert pp.verify(tmp_path / "run/best", geometry=True)[0].sound
    if THOROUGH:  # tests of the command ask for every byte
        whole = study.optimize(tmp_path / "whole")
        assert [f.point.values_si.tolist() for f in whole.finalists] == [f.point.values_si.tolist() for f in run.finalists]


KINDS = {**STUDY, "design_space": {**STUDY["design_space"], "texture.type": {"choice": ["hole_array", "pillar_array"]}},
         "search": {"method": "bayesian", "evaluations": 30, "seed": 3}}


def test_kinds_have_their_names() -> None:
    study = pp.Study(KINDS)
    kind = next(variable for variable in study.variables if variable.path == "texture.type")
    assert kind.names == ("hole_array", "pillar_array") and kind.number("pillar_array") == kind.choices[1]
    point = study.point({"texture.type": "pillar_array"})
    assert point["texture.type"] == "pillar_array" and "texture.type=pillar_array" in repr(point)
    assert point["texture.depth"] == study.own["texture.depth"], "what is left out is the study's own"
    assert 'type = "pillar_array"' in point.design.to_toml()
    assert {asked["texture.type"] for asked in study.ask()} <= {"hole_array", "pillar_array"}
    with pytest.raises(pp.InputError, match="expected one of hole_array, pillar_array, got 'waves'"):
        study.point({"texture.type": "waves"})


def test_the_own_design_is_the_files_beside_its_space() -> None:
    space = {"texture.depth": ["100 nm", "300 nm"], "texture.type": {"choice": ["grating", "pillar_array"]}}
    study = pp.Study({**STUDY, "design_space": space})
    own = study.own
    assert study.design({}) == own.design == study.design(dict(own)) and "texture.type=" in repr(own)
    assert own.design["texture.depth"] == pytest.approx(350e-9) and 'type = "hole_array"' in own.design.to_toml()


def test_designs_are_asked_for_a_few_at_a_time() -> None:
    whole, few = pp.Study(STUDY), pp.Study(STUDY)

    def worth(points: list[pp.Point]) -> list[float]:
        return [p["texture.depth"] * 1e6 for p in points]

    for _ in range(2):
        batch = whole.ask()
        whole.tell(batch, worth(batch))
        asked: list[pp.Point] = []
        while len(asked) < len(batch):
            points = few.ask(3)
            assert 1 <= len(points) <= 3
            few = pickle.loads(pickle.dumps(few))  # waits for the same answers
            few.tell(points, worth(points))
            few = copy.deepcopy(few)  # and asks for the rest of the batch
            asked += points
        assert [list(p.values()) for p in asked] == [list(p.values()) for p in batch]
    with pytest.raises(pp.InputError, match="n: "):
        few.ask(-1)


@pytest.mark.slow
def test_a_run_in_which_every_design_breaks_a_limit_has_no_front(tmp_path: pathlib.Path) -> None:
    study = pp.Study({**STUDY, "constraints": {"haze": "1e-6 %"}, "search": {"evaluations": 6, "seed": 3}})
    run = study.optimize(tmp_path / "run")
    assert not run.any_feasible and run.front == [] and run.finalists and run.best.folder
    assert not run.to_dataframe()["on_front"].any()


def test_the_numbers_of_a_run_have_their_si_units(tmp_path: pathlib.Path) -> None:
    study = pp.Study({**STUDY, "objective": {"maximise": "mean(modulation)", "minimise": "mean(friction)"}})
    assert [(o.name, o.unit) for o in study.objectives] == [("mean(modulation)", ""), ("mean(friction)", "N")]
    judged = {"ok": True, "reason": "", "values": [0.5, 0.1], "errors": [0.01, 0.002], "violations": []}
    (tmp_path / "run.json").write_text(json.dumps({
        "interrupted": False, "feasible": True, "evaluations": 1, "best": 0,
        "finalists": [{"values": [3e-7, 1.0], "searched": judged, "confirmed": judged, "folder": "front/01"}]}))
    frame = pp.Run(study, str(tmp_path)).to_dataframe()
    assert frame["texture.depth"][0] == 3e-7 and frame["surface.contact_angle"][0] == 1.0
    assert frame.attrs["units"] == {"texture.depth": "m", "surface.contact_angle": "rad", "mean(modulation)": "",
                                    "mean(modulation)_error": "", "mean(friction)": "N", "mean(friction)_error": "N"}


def test_what_to_build_may_be_another_than_the_best_design(tmp_path: pathlib.Path) -> None:
    study = pp.Study(STUDY)
    judged = {"ok": True, "reason": "", "values": [0.5], "errors": [0.01], "violations": []}
    told = {"interrupted": False, "feasible": True, "evaluations": 1, "best": 0,
            "finalists": [{"values": [3e-7, 1.0], "searched": judged, "confirmed": judged, "folder": "front/01"}]}

    def run_of(**more: object) -> pp.Run:
        (tmp_path / "run.json").write_text(json.dumps({**told, **more}))
        return pp.Run(study, str(tmp_path))

    (tmp_path / "best").mkdir()
    flat = pp.Design.load("m3_samples/flat.toml")
    flat.save(tmp_path / "best/build.toml")
    run = run_of(advice="leave flat", recommendation="Leave it flat.", textured=False)
    assert run.best.folder.endswith("front/01") and run.recommendation.folder == str(tmp_path / "best")
    assert run.recommendation.load() == flat and not run.recommendation.textured
    nothing = run_of(advice="nothing", recommendation="Build none of these.", textured=True).recommendation
    assert (nothing.advice, nothing.said, nothing.folder) == ("nothing", "Build none of these.", "")
    with pytest.raises(LookupError, match="Build none of these"):
        nothing.load()
    with pytest.raises(LookupError, match="resume=True"):
        run_of(interrupted=True).recommendation


@pytest.mark.slow
def test_a_run_is_opened_again_from_its_folder(tmp_path: pathlib.Path) -> None:
    run = pp.Study({**KINDS, "search": {"evaluations": 16, "seed": 3}}).optimize(tmp_path / "run")
    before = {path: path.stat().st_mtime_ns for path in (tmp_path / "run").rglob("*")}
    again = pp.Run.open(tmp_path / "run")
    assert {path: path.stat().st_mtime_ns for path in (tmp_path / "run").rglob("*")} == before, "nothing is written"
    assert again.evaluations == run.evaluations == 16 and again.any_feasible and not again.interrupted
    for mine, theirs in zip(again.finalists, run.finalists, strict=True):
        assert mine.folder == theirs.folder and dict(mine.point) == dict(theirs.point)
        assert np.array_equal(mine.confirmed.values, theirs.confirmed.values)
    assert again.best.load() == run.best.load() and again.table == run.table and again.finalists == run.finalists
    assert again.recommendation == run.recommendation and again.recommendation.load().title
    frame = again.to_dataframe()
    assert list(frame["mean(modulation)"]) == [f.confirmed.values[0] for f in run.finalists]
    assert set(frame["texture.type"]) <= {"hole_array", "pillar_array"}
    assert run.front and frame["on_front"].tolist() == [f in run.front for f in run.finalists]
    searched = next(f for f in run.finalists if len(f.searched.values))
    judged = run.study.judge(dict(searched.point))
    assert judged.values == pytest.approx(searched.searched.values), "a search judges its designs so"
    (tmp_path / "empty").mkdir()
    for folder in (tmp_path / "empty", tmp_path / "nowhere", 3):
        with pytest.raises(pp.InputError, match="folder"):
            pp.Run.open(folder)  # type: ignore[arg-type]
