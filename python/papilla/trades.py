"""Ranking designs, fitting the finger, and judging files for makers."""

from __future__ import annotations

import json
import os
import re
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from papilla import _native, values as v
from papilla.design import Design
from papilla.errors import wrong
from papilla.progress import Progress, shown
from papilla.values import Path

__all__ = ["Calibration", "Exported", "FileVerdict", "FittedParameter", "FolderVerdict", "Ranked", "Ranking", "calibrate",
           "rank", "verify"]


@dataclass(frozen=True)
class Ranked:
    """A design in a ranking."""

    index: int
    """Into the designs as given."""
    rank: int
    """1 + how many are ahead beyond doubt: by the score, or without one in some criterion and behind in none."""
    p_best_by: list[float]
    """Of each criterion: probability of the best value."""
    score: float
    """Where there is one; higher is better."""
    low: float
    """95 % interval of the score."""
    high: float
    p_best: float
    """Probability of the highest score."""


class Ranking:
    """Designs, best first, for each state of the finger."""

    def __init__(self, row: dict[str, Any]) -> None:
        self._row = row
        self.states: list[list[Ranked]] = [[Ranked(*r) for r in state] for state in row["states"]]
        self.table: str = row["table"]

    @property
    def order(self) -> list[Ranked]:
        """Of the first state."""
        return self.states[0]

    def to_dict(self) -> dict[str, Any]:
        """What ``papilla rank --json`` prints."""
        document: dict[str, Any] = json.loads(self._row["json"])
        return document

    def __repr__(self) -> str:
        return f"<papilla.Ranking, best first: {[r.index for r in self.order]}>"

    def _repr_markdown_(self) -> str:
        return self.table


def rank(designs: Sequence[Design], by: str = "", *, weights: Sequence[float] = (), states: str = "",
         names: Sequence[str] = (), max_skins: int = 96, threads: int = 0, parameters: bool = False,
         any_conditions: bool = False, force: bool = False, progress: Progress = None) -> Ranking:
    """Which design is better, and how sure that is: ``papilla rank``.

    by: criteria, "friction:low,variation(modulation):low"; empty: modulation, of undriven designs friction and
    adhesion. weights: of the criteria, for one score. states: "clean,natural,wet"; empty: the one that all
    fingers are in. names: of the designs in messages; empty: their
    titles, numbered where two are alike. max_skins: per design and state, 6 at least. any_conditions: also designs under
    other conditions. force: with model options that a finger was not fitted with. progress: called with a text.

    Raises InputError, KeyboardInterrupt. Source: docs/theory/ranking.md.
    """
    designs = v.items(designs, "designs")
    names = v.items(names, "names")
    for i, design in enumerate(designs):
        if not isinstance(design, Design):
            raise wrong(f"designs.{i}", f"expected a Design, got {type(design).__name__}")
    if len(designs) < 2:
        raise wrong("designs", "name two at least")
    if names and len(names) != len(designs):
        raise wrong("names", f"expected one for each of {len(designs)} designs, got {len(names)}")
    return Ranking(_native.rank(
        [d._inside for d in designs], v.text(by, "by"), [v.positive(w, "", "weights") for w in v.items(weights, "weights")],
        v.text(states, "states"), v.whole(max_skins, "max_skins", 6, 100000), v.whole(threads, "threads", 0, 4096),
        v.flag(parameters, "parameters"), v.flag(any_conditions, "any_conditions"),
        v.flag(force, "force"), [v.text(n, "names") for n in names], shown(progress, "rank")))


@dataclass(frozen=True)
class FittedParameter:
    """A number of the finger, fitted."""

    path: str
    value: float
    """SI"""
    error: float
    """One standard error."""
    low: float
    """95 % interval."""
    high: float
    data_share: float
    """Of what is known of it: 1 the data alone, 0 the prior alone."""


_OF_A_FIT = "the folder of a finished fit"


class Calibration:
    """A finger fitted to measurements."""

    def __init__(self, row: dict[str, Any]) -> None:
        self._row = row
        self.converged: bool = row["converged"]
        self.explains_data: bool = row["explains_data"]
        """False: the fitted finger is not to be used."""
        self.warning: str = row["warning"]
        self.parameters: list[FittedParameter] = [FittedParameter(*p) for p in row["parameters"]]
        """In the order of the file."""
        self.chi2_before: float = row["chi2_before"]
        self.chi2: float = row["chi2"]
        self.degrees_of_freedom: int = row["degrees_of_freedom"]
        self.finger: str = row["finger"]
        """The fitted finger as TOML."""
        self.table: str = row["table"]

    @classmethod
    def open(cls, folder: Path) -> Calibration:
        """A fit that was made before, from its folder: of ``calibrate(..., out=folder)`` or ``papilla calibrate``.

        Raises InputError for a folder that is none.
        """
        place = os.path.abspath(v.path(folder, "folder"))
        texts = {name: v.text_in(place, name, _OF_A_FIT) for name in ("fit.json", "fit.md", "finger.toml")}
        finger = texts["finger.toml"]
        with v.as_written(os.path.join(place, "finger.toml")):
            beside = tomllib.loads(finger).get("belief", "")
            if beside:  # where it can be read from anywhere
                absolute = json.dumps(os.path.join(place, beside), ensure_ascii=False)
                finger = re.sub(r'(?m)^(belief\s*=\s*)"[^"]*"', lambda found: found[1] + absolute, finger, count=1)
        with v.as_written(os.path.join(place, "fit.json")):
            told = json.loads(texts["fit.json"])
            rows = [(p["path"], p["value"], p["se"], p["low"], p["high"], p["data_share"]) for p in told["parameters"]]
            # Folders of older versions do not tell it: theirs is trusted where nothing is warned of.
            return cls({"explains_data": not told["warning"], **told, "parameters": rows, "finger": finger,
                        "table": texts["fit.md"], "json": texts["fit.json"]})

    def apply(self, design: Design) -> Design:
        """The design under the fitted finger, at the design's own load, state and touch time: all else of its own finger
        is replaced. Raises InputError."""
        if not isinstance(design, Design):
            raise wrong("design", f"expected a Design, got {type(design).__name__}")
        fitted = {key: value for key, value in tomllib.loads(self.finger).items() if key != "schema_version"}
        conditions = ("load", "state", "touch_time")
        return design.with_({"finger": {key: value for key, value in fitted.get("finger", fitted).items() if key not in conditions}})

    def to_dict(self) -> dict[str, Any]:
        """What ``papilla calibrate --json`` prints."""
        document: dict[str, Any] = json.loads(self._row["json"])
        return document

    def __repr__(self) -> str:
        return f"<papilla.Calibration, chi2 {self.chi2_before:.4g} -> {self.chi2:.4g}>"


def calibrate(file: Path, out: Path = "", *, threads: int = 0, progress: Progress = None) -> Calibration:
    """Fits the finger to measured friction or to published numbers: ``papilla calibrate``.

    file: CALIBRATION.toml (docs/how_to/calibrate.md). out: a folder for finger, fit and page; empty: none. progress:
    called with a text. Raises InputError, KeyboardInterrupt. Source: docs/theory/calibration.md.
    """
    return Calibration(_native.calibrate(v.path(file, "file"), v.path(out, "out"), v.whole(threads, "threads", 0, 4096),
                                         shown(progress, "calibrate")))


@dataclass(frozen=True)
class Exported:
    """Files that an export wrote."""

    files: tuple[str, ...]
    warnings: tuple[str, ...]
    """What the files hold otherwise than asked for."""


@dataclass(frozen=True)
class FileVerdict:
    """An exported file against the design that it was made from."""

    path: str
    sound: bool
    faults: list[str]
    """For people: what is wrong and by how much."""


@dataclass(frozen=True)
class FolderVerdict:
    """The files of a folder, and how their heights feel."""

    folder: str
    sound: bool
    files: list[FileVerdict]
    felt: dict[str, Any] | None
    """min_hole, min_wall [m], design, file (merit of each), loss, faults; None: not simulated."""


def verify(path: Path, *, geometry: bool = False, tolerance: float = 0.05) -> list[FolderVerdict]:
    """Every exported file of a folder, of a run of a study, or one file of it: ``papilla verify``.

    geometry: what the files hold alone, without simulating them. tolerance: largest loss of merit of the heights.
    Raises InputError.
    """
    share = v.si(tolerance, "", "tolerance")
    if not 0 < share < 1:
        raise wrong("tolerance", f"expected a share from 0 to 1, got {share}")
    return [FolderVerdict(folder, sound, [FileVerdict(*f) for f in files], felt)
            for folder, sound, files, felt in _native.verify(v.path(path, "path"), v.flag(geometry, "geometry"), share)]
