"""Which measurement settles a decision, and what measurements change."""

from __future__ import annotations

import json
import os
import re
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import date as calendar_date
from typing import Any, Union

from papilla import _native, values as v
from papilla.design import Design
from papilla.errors import InputError, Problem, wrong
from papilla.progress import Progress, shown
from papilla.study import Run
from papilla.values import Path, Quantified

Source = Union[Path, Design, Run]

__all__ = ["Batch", "Experiment", "Lab", "Told"]


@dataclass(frozen=True)
class Experiment:
    """An experiment to make."""

    id: str
    """What tables and records call it, "E07"."""
    design: str
    field: str
    """Its label on the wafer; "": none."""
    load: float
    """[N]"""
    humidity: float
    """From 0 to 1."""
    voltage: float
    """Peak [V]; 0: undriven."""
    frequency: float
    """Of the carrier [Hz]; 0: that of the design."""
    state: str
    repeats: int
    """Touches."""
    friction_off: list[float]
    """By belief [N]: median and 95 % interval."""
    friction_on: list[float]


class Batch:
    """Experiments to make next, why, and whether to stop."""

    def __init__(self, stop: bool, table: str, document: dict[str, Any]) -> None:
        plan = document["plan"]
        self.stop = stop
        """No more experiments are worth it."""
        self.table = table
        """What the command prints."""
        self.purpose: str = plan["for"]
        self.seconds: float = plan["seconds"]
        """Of work."""
        self.regret_now: float = plan["regret_now"]
        """Expected, of the choice; 0 without a decision."""
        self.regret_after: float = plan["regret_after"]
        self.p_change: float = plan["p_change"]
        """That another design is chosen after the batch."""
        self.keeps_limits: bool | None = document["standing"].get("keeps_limits")
        """Whether the best design keeps every limit as surely as is wanted, which ``stop`` does not say; None: no decision."""
        self.experiments: list[Experiment] = [
            Experiment(e["id"], e["design"], e["field"], e["conditions"]["load"], e["conditions"]["relative_humidity"],
                       e["conditions"]["voltage"], e["conditions"]["frequency"], e["conditions"]["state"], e["repeats"],
                       e["F_off"], e["F_on"]) for e in plan["experiments"]]
        """In the order in which they gain most."""
        self._document = document

    def __iter__(self) -> Iterator[Experiment]:
        return iter(self.experiments)

    def __len__(self) -> int:
        return len(self.experiments)

    def to_dict(self) -> dict[str, Any]:
        """What ``papilla next --json`` prints."""
        return self._document

    def __repr__(self) -> str:
        return f"<papilla.Batch of {len(self.experiments)} experiments{', stop' if self.stop else ''}>"

    def _repr_markdown_(self) -> str:
        return self.table


class Told:
    """What became of files that were told."""

    def __init__(self, refused: list[tuple[str, int, int, str, str]], table: str, document: dict[str, Any]) -> None:
        self.refused: list[Problem] = [Problem(*p) for p in refused]
        """Files of which nothing was kept, and why."""
        self.table = table
        """What the command prints."""
        self.readings: int = sum(len(f["told"]["readings"]) for f in document["files"])
        """New ones."""
        self.already: int = sum(f["already"] for f in document["files"])
        """Readings that were told before and are not counted again."""
        self.fitted: int = sum(f["fitted"] for f in document["files"])
        """Readings that the belief was fitted to, so left out."""
        self._document = document

    def to_dict(self) -> dict[str, Any]:
        """What ``papilla tell --json`` prints."""
        return self._document

    def __repr__(self) -> str:
        return f"<papilla.Told, {self.readings} readings, {len(self.refused)} refusals>"

    def _repr_markdown_(self) -> str:
        return self.table


class Lab:
    """A decision, the belief behind it, and what is measured for it, in one folder.

    lab = pp.Lab.open("results/glass", "labs/glass", humidity="15 %,75 %"); the first batch is lab.batch. Then
    lab.tell("plan_01.csv") and lab.next(), until batch.stop. A folder that is a lab already goes on: pp.Lab("labs/glass").
    """

    def __init__(self, folder: Path) -> None:
        self.folder = v.path(folder, "folder")
        state = self.state()
        plans = state["plans"]
        self.batch: Batch | None = None
        """The last one that was planned, here or before."""
        if plans:
            self.batch = Batch(plans[-1]["stop"], self.page,
                               {"schema": state["schema"], "plan": plans[-1], "standing": state["standing"]})

    @classmethod
    def open(cls, sources: Source | Sequence[Source], folder: Path, *, belief: Path = "", worth: str = "", load: str = "",
             humidity: str = "", voltage: str = "", frequency: str = "", states: str = "", purpose: str = "",
             count: int = 10, seconds: Quantified = 0, finger: str = "1", date: str = "", threads: int = 0,
             names: Sequence[str] = (), values: Mapping[str, Any] | None = None, progress: Progress = None) -> Lab:
        """A new lab with its first batch: ``papilla next``.

        sources: a folder of results or a Run, a wafer's manifest.csv, designs or their files, a calibration. load, humidity, voltage, frequency,
        states: what can be set, lists as "15 %,75 %"; empty: the designs' own. purpose: "decision", "hypotheses",
        "parameters". count: touches, at most. seconds: of work, at most, 0: no limit. date: of today, "2026-03-01";
        empty: today's. names: of the sources that are a Design, in their order; without
        them their titles name them. values: of lab.toml, before anything is planned:
        ``{"instrument.repeatability": "2 %", "costs.reading": "2 min"}``. Raises InputError, KeyboardInterrupt.
        """
        conditions = [v.text(t, n) for t, n in ((load, "load"), (humidity, "humidity"), (voltage, "voltage"),
                                                (frequency, "frequency"), (states, "states"))]
        with tempfile.TemporaryDirectory() as beside:
            found, stop, table, document = _native.next_experiments(
                _paths(sources, names, beside), v.path(folder, "folder"), v.text(purpose, "purpose"),
                v.whole(count, "count", 1, 1000), v.si(seconds, "s", "seconds"), v.path(belief, "belief"), v.text(worth, "worth"),
                conditions, v.settings(values), v.text(finger, "finger"), "", _date(date),
                v.whole(threads, "threads", 0, 4096), shown(progress, "next"))
        lab = cls(found)
        lab.batch = Batch(stop, table, json.loads(document))
        return lab

    def next(self, purpose: str = "", *, count: int = 10, seconds: Quantified = 0, finger: str = "1", day: str = "",
             date: str = "", threads: int = 0, progress: Progress = None) -> Batch:
        """The batch to measure next: ``papilla next LAB``. seconds: of work, at most, 0: no limit. day: of the
        measurements, as tables name it; empty: the date. date: as of ``open``. Raises InputError, KeyboardInterrupt."""
        _, stop, table, document = _native.next_experiments(
            [self.folder], "", v.text(purpose, "purpose"), v.whole(count, "count", 1, 1000), v.si(seconds, "s", "seconds"), "", "",
            [""] * 5, [], v.text(finger, "finger"), v.text(day, "day"), _date(date),
            v.whole(threads, "threads", 0, 4096), shown(progress, "next"))
        self.batch = Batch(stop, table, json.loads(document))
        return self.batch

    def tell(self, files: Path | Sequence[Path], *, experiment: str = "", field: str = "", design: str = "",
             finger: str = "", day: str = "", date: str = "", replace: bool = False, threads: int = 0,
             progress: Progress = None, refuse: bool = True) -> Told:
        """Tables of friction and records of a tribometer: ``papilla tell``.

        What is said here holds where the file does not say it. refuse: raises InputError where nothing of a file was
        kept; the others are kept all the same. Raises KeyboardInterrupt.
        """
        said = [v.text(t, n) for t, n in ((experiment, "experiment"), (field, "field"), (design, "design"),
                                          (finger, "finger"), (day, "day"))] + [_date(date)]
        refused, table, document = _native.tell_lab(self.folder, v.paths(files, "files"), said,
                                                    v.flag(replace, "replace"), v.whole(threads, "threads", 0, 4096),
                                                    shown(progress, "tell"))
        told = Told(refused, table, json.loads(document))
        if refuse and told.refused:
            raise InputError(told.refused)
        return told

    def state(self) -> dict[str, Any]:
        """Where the lab stands: lab.json. Raises InputError."""
        document: dict[str, Any] = json.loads(_native.lab_state(self.folder, 0)[1])
        return document

    @property
    def page(self) -> str:
        """The text of lab.md."""
        return _native.lab_state(self.folder, 0)[0]

    def __repr__(self) -> str:
        return f"<papilla.Lab {self.folder}>"

    def _repr_markdown_(self) -> str:
        return self.page


def _paths(sources: Source | Sequence[Source], names: Sequence[str], beside: str) -> list[str]:
    """Files and folders; a Design is written into the folder ``beside``, from where a lab takes its own copy."""
    several = [sources] if isinstance(sources, (str, os.PathLike, Design, Run)) else v.items(sources, "sources")
    named = [_file_name(v.text(n, "names")) for n in v.items(names, "names")]
    designs = sum(isinstance(source, Design) for source in several)
    if named and (len(named) != designs or len(set(named)) != designs or not all(named)):
        raise wrong("names", f"expected a name of its own for each of {designs} designs, got {list(names)}")
    out: list[str] = []
    for i, source in enumerate(several):
        if isinstance(source, Run):
            out.append(source.folder)
        elif isinstance(source, Design):
            if source._inside.drawn() is not None:
                raise wrong(f"sources.{i}", "the heights of this design are an array: save it and name its file")
            name = named.pop(0) if named else _file_name(source.title) or f"design_{i + 1}"
            place = os.path.join(beside, str(i))
            os.mkdir(place)
            out.append(os.path.join(place, name + ".toml"))
            source.save(out[-1])
        else:
            out.append(v.path(source, f"sources.{i}"))
    return out


def _date(date: str) -> str:
    """Of the journal, where a day has one text: "20260301" is "2026-03-01" too; empty: today."""
    if not v.text(date, "date"):
        return ""
    try:
        return calendar_date.fromisoformat(date).isoformat()
    except ValueError:
        raise wrong("date", f'expected year, month and day as "2026-03-01", got {date!r}') from None


def _file_name(title: str) -> str:
    """Its letters and digits: of a long one both ends, for what was changed stands at the end."""
    word = re.sub(r"[^\w-]+", "_", title).strip("_")
    return word if len(word) <= 60 else f"{word[:28]}__{word[-30:]}".strip("_")
