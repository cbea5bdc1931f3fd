"""Textures ranked, and what is measured to tell the first two apart: a ranking, a lab, a round of touches told to it.

Run: python3 rank_and_measure.py [FOLDER]   (of the lab and its table; else one that is removed at the end)
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import papilla as pp

CONDITIONS = {"accuracy": {"level": "draft", "grid": 48}, "environment.relative_humidity": ["35 %"]}
DESIGNS = {name: pp.Design.load(f"m3_samples/{name}.toml", CONDITIONS) for name in ("a3h350", "a3h600", "a4h350")}


def measured(batch: pp.Batch) -> str:
    """A table of the batch in which every touch is a little below what belief expects: in its place stands what a tribometer gave."""
    rows = ["experiment,repeat,F_off_N,F_on_N"]
    for e in batch:
        for repeat in range(1, e.repeats + 1):
            share = 0.94 + 0.02 * (repeat % 2)
            rows.append(f"{e.id},{repeat},{share * e.friction_off[0]:.5f},{share * e.friction_on[0]:.5f}")
    return "\n".join(rows) + "\n"


def measure(folder: Path) -> None:
    ranking = pp.rank(list(DESIGNS.values()), "modulation", names=list(DESIGNS), max_skins=8)
    order = [list(DESIGNS)[ranked.index] for ranked in ranking.order]
    print("ranked:", ", ".join(order))
    first = order[:2]
    lab = pp.Lab.open([DESIGNS[name] for name in first], folder / "lab", names=first, belief="fingers/belief.toml",
                      humidity="35 %", count=4)
    assert lab.batch is not None
    for e in lab.batch:
        print(f"{e.id}: {e.design} at {e.load} N and {e.voltage} V, {e.repeats} touches")
    table = folder / "measured.csv"
    table.write_text(measured(lab.batch))
    told = lab.tell(table)
    before, now = lab.state()["decisions"][-2:]
    print(f"{told.readings} readings told: the best is {before['best']} with probability {before['p_best']:.2f}, "
          f"then {now['best']} with {now['p_best']:.2f}")
    print("stop" if lab.next(count=4).stop else "go on")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        measure(Path(sys.argv[1]))
    else:
        with tempfile.TemporaryDirectory() as beside:
            measure(Path(beside))
