"""Work that is long: progress, interrupts, threads, processes."""

from __future__ import annotations

import multiprocessing
import os
import pathlib
import pickle
import signal
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import papilla as pp
from conftest import ROOT


def interrupted_after(seconds: float, call) -> float:  # type: ignore[no-untyped-def]
    """Seconds from Ctrl-C to KeyboardInterrupt, which a shell turns off for what it runs in the background."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
    sent = []

    def send() -> None:
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(seconds, send)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        call()
    timer.join()
    return time.monotonic() - sent[0]


def ends_within(seconds: float, after: float, call) -> bool:  # type: ignore[no-untyped-def]
    """Whether the quickest of five does: other work on the machine only adds."""
    return any(interrupted_after(after, call) < seconds for _ in range(5))


def test_ctrl_c_ends_an_evaluation_within_a_fifth_of_a_second() -> None:
    d = pp.Design.load(ROOT / "designs/m3_samples/a3h600.toml", {"accuracy.level": "reference"})
    assert ends_within(0.2, 0.5, d.evaluate)
    assert ends_within(0.2, 0.3, lambda: d.sensitivity(level="reference"))
    assert ends_within(0.2, 0.3, lambda: pp.rank([d, d.with_({"texture.depth": "300 nm"})]))


def test_an_exception_of_the_progress_function_ends_the_work() -> None:
    d = pp.Design.load(ROOT / "designs/m3_samples/a3h600.toml", {"accuracy.level": "draft"})
    seen = []

    def progress(done: int) -> None:
        seen.append(done)
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        d.evaluate(progress=progress)
    assert seen == [1]


def test_progress_counts_the_patches(quick: pp.Design) -> None:
    counts: list[int] = []
    quick.evaluate(progress=counts.append)
    assert counts == list(range(1, len(counts) + 1)) and len(counts) > 5


def test_two_threads_give_what_one_gives(quick: pp.Design) -> None:
    other = quick.with_({"texture.depth": "200 nm"})
    with ThreadPoolExecutor(2) as pool:
        together = list(pool.map(lambda d: d.evaluate(threads=1), [quick, other] * 2))
    assert together[0] == together[2] == quick.evaluate()
    assert together[1] == together[3] == other.evaluate()
    assert together[0] != together[1]


def test_python_runs_while_the_library_works(quick: pp.Design) -> None:
    ticks = 0
    done = threading.Event()

    def tick() -> None:
        nonlocal ticks
        while not done.is_set():
            ticks += 1
            time.sleep(0.005)

    thread = threading.Thread(target=tick)
    thread.start()
    begin = time.monotonic()
    quick.with_({"accuracy.grid": 128}).evaluate(threads=1)
    seconds = time.monotonic() - begin
    done.set()
    thread.join()
    assert ticks > 20 * seconds


def _mean(design: pp.Design) -> float:
    return float(design.evaluate(threads=1).friction_off.value[0])


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_processes_evaluate_too(method: str, quick: pp.Design) -> None:
    here = _mean(quick)
    with multiprocessing.get_context(method).Pool(2) as pool:
        assert pool.map(_mean, [quick, quick]) == [here, here]


def test_a_response_survives_pickle_and_shows_itself(quick: pp.Design) -> None:
    r = quick.evaluate()
    again = pickle.loads(pickle.dumps(r))
    assert again == r and np.array_equal(again.modulation.parts["grid"], r.modulation.parts["grid"])
    assert r._repr_svg_().startswith("<svg") and "modulation" in repr(r)
    frame = r.to_dataframe()
    assert frame["modulation"].tolist() == r.modulation.value.tolist()
    assert len(frame) == 1


def test_a_plot_has_the_values(quick: pp.Design) -> None:
    import matplotlib

    matplotlib.use("Agg")
    r = quick.evaluate()
    ax = r.plot()
    assert ax.lines[0].get_ydata().tolist() == r.modulation.value.tolist()
    assert ax.lines[0].get_xdata().tolist() == [50]
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert labels[0] == "modulation" and "± 2 numerical" in labels
    assert ("± 2 model" in labels) == bool(np.all(np.isfinite(r.modulation.model)))
    assert r.plot(quantity="friction_off").get_ylabel() == "friction off (N)"
    r.plot(ax, label="again")
    more = [text.get_text() for text in ax.get_legend().get_texts()]
    assert sorted(more) == sorted(labels + ["again"])


def test_a_difference_is_surer_than_two_values(quick: pp.Design) -> None:
    near = quick.with_({"texture.depth": "570 nm"})
    c = pp.compare(quick, near)
    assert c.modulation.value[0] == c.second.modulation.value[0] - c.first.modulation.value[0]
    assert c.modulation.paired == (True,)
    alone = np.hypot(c.first.modulation.error, c.second.modulation.error)
    assert 0 < c.modulation.error[0] < 0.5 * alone[0]
    assert pp.compare(quick, quick).modulation.value[0] == 0
    assert pp.compare(quick, quick).modulation.error[0] == 0


def test_sensitivity_is_the_difference_of_two_evaluations(quick: pp.Design) -> None:
    [s] = quick.sensitivity(keys=["texture.depth"], step=0.1)
    assert (s.down, s.up) == (pytest.approx(0.9 * s.value), pytest.approx(1.1 * s.value))
    low, high = (quick.with_({"texture.depth": x}).evaluate().modulation.value[0] for x in (s.down, s.up))
    assert s.change.value == high - low
    assert s.slope == s.change.value / (s.up - s.down)
    assert 0 < s.change.error and s.slope_error == s.change.error / (s.up - s.down)


def test_exported_files_are_verified(quick: pp.Design, tmp_path: pathlib.Path) -> None:
    done = quick.export(tmp_path / "plate", ["npy", "gsf"], pixels=256)
    assert {pathlib.Path(f).suffix for f in done.files} >= {".npy", ".gsf"}
    [verdict] = pp.verify(tmp_path / "plate", geometry=True)
    assert verdict.sound and verdict.felt is None
    z = np.load(tmp_path / "plate/heightmap.npy")
    np.save(tmp_path / "plate/heightmap.npy", 1.01 * z)
    [verdict] = pp.verify(tmp_path / "plate", geometry=True)
    assert not verdict.sound and any("npy" in f.path and not f.sound for f in verdict.files)


@pytest.mark.slow
def test_a_thousand_evaluations_leave_memory_flat() -> None:
    def megabytes() -> float:
        with open("/proc/self/statm", encoding="ascii") as stream:
            return int(stream.read().split()[1]) * os.sysconf("SC_PAGESIZE") / 2**20

    z = np.random.default_rng(1).normal(scale=5e-9, size=(48, 48))
    tiny = pp.Design.from_heights(z, "6 um", {"accuracy": {"level": "draft", "grid": 16}, "environment.relative_humidity":
                                              [0.5]})
    for i in range(1000):
        tiny.with_({"surface.contact_angle": 0.5 + i * 1e-3}).evaluate()
        if i == 99:
            first = megabytes()
    assert megabytes() - first < 8
