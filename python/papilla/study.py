"""Studies: a design, what of it may change, and what is wanted."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
import numpy.typing as npt

from papilla import _native, values as v
from papilla.design import Design, _without_version
from papilla.errors import wrong
from papilla.progress import Progress, shown
from papilla.response import as_array
from papilla.values import FloatArray, Path

if TYPE_CHECKING:
    import pandas

__all__ = ["Decision", "FoundDesign", "Judgement", "Objective", "Point", "Prospect", "Recommendation", "Run", "Study",
           "Variable"]


@dataclass(frozen=True)
class Variable:
    """A number that a search may change."""

    path: str
    """The key: "texture.depth"."""
    unit: str
    """For people; the numbers below are SI."""
    low: float
    high: float
    choices: tuple[float, ...]
    """Not empty: one of these."""
    names: tuple[str, ...] = ()
    """Of the choices, where they are words and no numbers: the kinds of "texture.type"."""

    def shown(self, value: float) -> Union[float, str]:
        """The value as a person gives it: the name of a choice that has one, else the number."""
        return dict(zip(self.choices, self.names)).get(value, value)

    def number(self, value: Any) -> float:
        """The number of a name, of a text with a unit, or of a number. Raises InputError that names the key."""
        if not self.names or not isinstance(value, str):
            return v.si(value, self.unit, self.path)
        if value not in self.names:
            raise wrong(self.path, f"expected one of {', '.join(self.names)}, got {value!r}")
        return self.choices[self.names.index(value)]


@dataclass(frozen=True)
class Objective:
    name: str
    """"mean(modulation)" """
    maximise: bool
    unit: str
    """Of its values, SI; "" of a share."""


@dataclass(frozen=True, eq=False, repr=False)
class Judgement(v.WithArrays):
    """A design as a study sees it."""

    ok: bool
    reason: str
    """Not ok: why, for people."""
    values: FloatArray
    """One per objective; larger is better where it is maximised."""
    errors: FloatArray
    """One standard error of each: the scatter, not what the level of searches is off by."""
    violations: FloatArray
    """One per constraint that needs an evaluation; above 0: broken, relative to its limit."""


class Point(Mapping[str, Any]):
    """Values of a study's variables by their path, numbers in SI; of "texture.type" its name."""

    def __init__(self, study: Study, values: Sequence[float]) -> None:
        self._study = study
        self._values = [float(value) for value in values]

    def __getitem__(self, path: str) -> Any:
        for variable, value in zip(self._study.variables, self._values):
            if variable.path == path:
                return variable.shown(value)
        raise KeyError(path)

    def __iter__(self) -> Iterator[str]:
        return (variable.path for variable in self._study.variables)

    def __len__(self) -> int:
        return len(self._values)

    @property
    def values_si(self) -> FloatArray:
        """In the order of the study's variables, shape (variables,); a name stands as the number of its choice."""
        return as_array(self._values)

    @property
    def design(self) -> Design:
        """The design that these values make."""
        return self._study.design(self.values_si)

    def __repr__(self) -> str:
        shown = (f"{x.path}={x.shown(value) if x.names else _native.quantity_text(float(f'{value:.4g}'), x.unit)}"
                 for x, value in zip(self._study.variables, self._values))
        return f"Point({', '.join(shown)})"


@dataclass(frozen=True)
class FoundDesign:
    """A design of the end of a search."""

    point: Point
    searched: Judgement
    """As the search judged it; without values: it came later (a safer design, the same texture flat)."""
    confirmed: Judgement
    """At the study's accuracy, on skins that the search has not seen."""
    folder: str
    """Of design.toml; empty: only its values are kept."""
    on_front: bool
    """Whether it keeps every limit and no other is sure to beat it: it is out only where another is better in every
    objective (and in the worst modulation, where designs are judged at the study's own amplitude) by the confirmed numbers
    and, where the fingers name a belief, at every member of it. So a study of one objective may have a front of several."""

    def load(self) -> Design:
        """The design as its folder has it, or of its values where it has none."""
        return Design.load(os.path.join(self.folder, "design.toml")) if self.folder else self.point.design


@dataclass(frozen=True)
class Prospect:
    """A design of the front over the members of belief."""

    p_best: float
    regret: float
    """Expected, against the best design at each member, in the unit of ``Decision.worth``."""
    p_best_by: dict[str, float]
    """By the name of each objective."""
    p_every_limit: float
    p_limits: dict[str, float]
    """By the name of each limit."""


@dataclass(frozen=True)
class Decision:
    """Which design of the front to build, where the study's fingers name a belief."""

    best: str
    """Folder below the run's: "front/03"."""
    worth: str
    """What the designs are compared in, for people."""
    prospects: dict[str, Prospect]
    """By folder."""
    hypotheses: dict[str, str]
    """The folder that is best under each hypothesis of the belief, by its name."""
    overturned: list[str]
    """What would change the choice, for people; empty: nothing does."""
    members: int


@dataclass(frozen=True)
class Recommendation:
    """What a run says to build: its best design, or a surface without a texture, or nothing."""

    advice: str
    """"texture"; "finish" (a flat surface with another finish or drive), "leave flat"; "unknown": the best design, as the
    flat surface has no answer to compare it with; "nothing": no design keeps every limit."""
    said: str
    """For people: the sentence below "What to build" in summary.md."""
    textured: bool
    """Whether what is to be built has a texture."""
    folder: str
    """Of what is to be built: design.toml as it was searched, build.toml with lengths on the grid of the fab; empty:
    nothing is."""

    def load(self) -> Design:
        """The design to build, its lengths on the grid of the fab. Raises LookupError where nothing is to be built."""
        if not self.folder:
            raise LookupError(self.said)
        return Design.load(os.path.join(self.folder, "build.toml"))


class Run:
    """A search that came to its end, or was interrupted and can go on."""

    def __init__(self, study: Study, folder: str) -> None:
        self.study = study
        self.folder = folder
        told = self._told()
        with v.as_written(os.path.join(folder, "run.json")):
            self.interrupted: bool = told["interrupted"]
            self.any_feasible: bool = told["feasible"]
            """Whether a design keeps every constraint."""
            self.evaluations: int = told["evaluations"]
            self.finalists: list[FoundDesign] = [
                FoundDesign(Point(study, row["values"]), _told_judgement(row["searched"]), _told_judgement(row["confirmed"]),
                            os.path.join(folder, row["folder"]) if row["folder"] else "",
                            row["folder"].startswith("front/")) for row in told["finalists"]]
            """By the first objective, best first."""
            self._best: int = range(len(self.finalists))[told["best"]] if self.finalists else 0

    @classmethod
    def open(cls, folder: Path) -> Run:
        """A run that ended, or was interrupted, from its folder: of ``Study.optimize``, ``papilla optimize`` or the studio.

        Nothing is evaluated nor written. Raises InputError for a folder that is none of a run.
        """
        name = v.path(folder, "folder")
        v.text_in(name, "run.json", _OF_A_RUN)
        return cls(Study.load(os.path.join(name, "resolved.toml")), name)

    @property
    def table(self) -> str:
        """For people, Markdown: the run's summary.md."""
        return v.text_in(self.folder, "summary.md", _OF_A_RUN)

    def to_dataframe(self) -> pandas.DataFrame:
        """A row for each finalist: its variables, each objective as confirmed and its ``..._error``, ``on_front``, ``ok``
        and ``folder``; their SI units are ``frame.attrs["units"]``. Needs pandas."""
        import pandas

        rows = []
        for found in self.finalists:
            row: dict[str, Any] = dict(found.point)
            for i, objective in enumerate(self.study.objectives):
                known = found.confirmed.ok
                row[objective.name] = found.confirmed.values[i] if known else float("nan")
                row[objective.name + "_error"] = found.confirmed.errors[i] if known else float("nan")
            rows.append({**row, "on_front": found.on_front, "ok": found.confirmed.ok, "folder": found.folder})
        frame = pandas.DataFrame(rows)
        frame.attrs["units"] = {
            **{variable.path: _native.si_unit(variable.unit) for variable in self.study.variables},
            **{objective.name + part: objective.unit for objective in self.study.objectives for part in ("", "_error")}}
        return frame

    @property
    def front(self) -> list[FoundDesign]:
        """The finalists that keep every limit and that no other is sure to beat (``FoundDesign.on_front``); how probable
        each is the best is in ``decision``."""
        return [found for found in self.finalists if found.on_front]

    @property
    def best(self) -> FoundDesign:
        """The finalist that the study's ``pick``, or belief, chooses; where none keeps every limit the one that breaks
        them least. Whether to build it is another question, which ``recommendation`` answers: it may be a surface
        without its texture, or nothing. Raises LookupError for a search without a finalist."""
        if not self.finalists:
            raise LookupError("the search found no design")
        return self.finalists[self._best]

    @property
    def recommendation(self) -> Recommendation:
        """What to build, as ``papilla optimize`` says it. Raises LookupError with the reason where there is none."""
        told = self._told()
        if "recommendation" not in told:
            raise LookupError("the run was interrupted: optimize(..., resume=True) goes on with it" if self.interrupted
                              else "the search found no design")
        nothing = told["advice"] == "nothing"
        return Recommendation(told["advice"], told["recommendation"], not nothing and told["textured"],
                              "" if nothing else os.path.join(self.folder, "best"))

    @property
    def decision(self) -> Decision:
        """By belief. Raises LookupError with the reason where there is none."""
        judged = not self.interrupted and bool(self.finalists)
        found = (self._told().get("decision") if judged else None) or {}
        if found.get("absent", "the run has no design to decide on"):
            raise LookupError(found.get("absent", "the run has no design to decide on"))
        return Decision(
            best=found["best"], worth=found["worth"],
            prospects={name: Prospect(row["p_best"], row["regret"], row["p_best_by"], row["p_every_limit"],
                                      row["p_limits"]) for name, row in found["designs"].items()},
            hypotheses={row["name"]: row["best"] for row in found["hypotheses"]},
            overturned=found["overturned"], members=found["members"])

    @property
    def plate_yield(self) -> Optional[dict[str, Any]]:
        """The yield of what is built: the ``share`` of plates within every limit, its standard error ``se``, how often
        each limit is ``broken``, what half of each of the ``tolerances`` gains, and the ``costliest``. None where
        nothing scatters."""
        return self._told().get("yield")

    @property
    def shared(self) -> Optional[dict[str, Any]]:
        """What all good designs share: the ``ranges`` of each number over the designs within 5 % of the front, SI, and
        a sentence, ``said``. None where there are fewer than five."""
        return self._told().get("shared")

    def _told(self) -> dict[str, Any]:
        """run.json, as it stands in the folder now."""
        told = v.document_in(self.folder, "run.json", _OF_A_RUN)
        if "finalists" not in told:
            raise wrong("folder", f"{self.folder} was written by an older version: run its resolved.toml again")
        return told

    def __repr__(self) -> str:
        end = "interrupted after" if self.interrupted else "of"
        return f"<papilla.Run {end} {self.evaluations} evaluations, {len(self.finalists)} finalists in {self.folder!r}>"


_OF_A_RUN = "the folder of a run that came to an end"
_Row = tuple[bool, str, list[float], list[float], list[float]]
"""Of a judgement: ok, reason, values, errors, violations."""
Values = Union[Mapping[str, Any], Sequence[Any], FloatArray]
Told = Optional[Union[float, Sequence[float], FloatArray]]


class Study:
    """A study: run to its end, or searched step by step with evaluations of one's own.

    ``Study({...})`` takes the keys of a study file. In the sections of the study (design_space, constraints, scatter,
    ...) numbers are written with units, as in the file. Raises InputError, also for a design without [design_space].
    """

    def __init__(self, values: Mapping[str, Any]) -> None:
        self._source: tuple[str, str, list[tuple[str, str]]] = (
            "", "schema_version = 1\n", v.settings(_without_version(values)))
        self._open()

    def _open(self) -> None:
        file, toml, changes = self._source
        self._inside = _native.Study.read(file, changes) if file else _native.Study.parse(toml, changes)
        self._search: _native.Search | None = None
        self._waiting: list[Point] = []  # of the searcher's batch, not asked for yet
        self._asked: list[Point] = []
        self._answers: list[_Row] = []  # to the batch, so far
        self._told: list[list[_Row]] = []
        self.variables: list[Variable] = [
            Variable(*row[:4], tuple(row[4]), tuple(row[5])) for row in self._inside.variables()]
        self.objectives: list[Objective] = [Objective(*row) for row in self._inside.objectives()]

    @classmethod
    def _of(cls, source: tuple[str, str, list[tuple[str, str]]]) -> Study:
        study = cls.__new__(cls)
        study._source = source
        study._open()
        return study

    @classmethod
    def _again(cls, source: tuple[str, str, list[tuple[str, str]]], told: list[list[_Row]], answers: list[_Row],
               asked: int) -> Study:
        study = cls._of(source)
        study._told = list(told)
        if answers or asked:
            study._waiting = study._next_batch()[len(answers):]
            study._answers = list(answers)
        if asked:
            study.ask(asked)
        return study

    @classmethod
    def load(cls, file: Path, values: Mapping[str, Any] | None = None) -> Study:
        """The study of a file, with values that replace its own. Raises InputError."""
        return cls._of((v.path(file, "file"), "", v.settings(values)))

    @classmethod
    def parse(cls, toml: str, values: Mapping[str, Any] | None = None) -> Study:
        """The study of the text of a file. Raises InputError."""
        return cls._of(("", v.text(toml, "toml"), v.settings(values)))

    @property
    def own(self) -> Point:
        """The values of the study's own design, inside its space or not."""
        return Point(self, self._inside.own_values())

    def point(self, values: Values) -> Point:
        """Values by path, or in the order of the variables, SI. Raises InputError."""
        return Point(self, self._numbers(values))

    def design(self, values: Values) -> Design:
        """The design that these values make. Raises InputError."""
        return Design._of(self._inside.design(self._numbers(values)))

    def judge(self, values: Values, *, threads: int = 0, force: bool = False) -> Judgement:
        """The model on every finger and scenario, as accurately as a search: a second or less.

        The numbers are for ranking designs, at the coarse level of searches. Friction and contact areas are corrected
        for what its pixels leave out of the skin (Eq. accuracy.17). ``errors`` hold the scatter between skins, not what
        else the level differs from ``evaluate`` by.

        values: by path (variables that are left out have the study's own values), or all in their order. A shape that breaks
        a limit is refused at once: ``ok`` is False. force: with model options that a finger of the study was not fitted with.
        Raises InputError, KeyboardInterrupt.
        """
        return _judgement(self._inside.judge(self._numbers(values), v.whole(threads, "threads", 0, 4096),
                                             v.flag(force, "force")))

    def ask(self, n: int = 0) -> list[Point]:
        """The next designs that the study's method wants to know; empty: nothing more to try, or as many designs were told
        as ``search.evaluations`` says (without that key as many as ``papilla optimize`` takes).

        n: at most so many; 0: all that the method wants at once. It learns from a batch when the whole of it is told, so
        the designs are the same for any n. They depend on the study (its method and seed) and on what was told, never on
        time. Raises InputError.
        """
        count = v.whole(n, "n", 0, 1000000)
        if self._asked:
            raise wrong("ask", f"tell() first what the {len(self._asked)} designs of the last ask() are worth")
        if not self._waiting:
            self._waiting = self._next_batch()
        count = count or len(self._waiting)
        self._asked, self._waiting = self._waiting[:count], self._waiting[count:]
        return list(self._asked)

    def _next_batch(self) -> list[Point]:
        return [Point(self, values) for values in self._searcher().ask()]

    def _searcher(self) -> _native.Search:
        """Which knows all that was told: a copy learns it again, and asks for the same from there on."""
        if self._search is None:
            self._search = _native.Search(self._inside)
            for rows in self._told:
                self._search.ask()
                self._search.tell(rows)
        return self._search

    def tell(self, points: Sequence[Point], values: Sequence[Told], errors: Sequence[Told] | None = None,
             violations: Sequence[Sequence[float]] | None = None) -> None:
        """What the designs of the last ``ask`` are worth, in their order.

        values: of each design a number, with several objectives a number for each; None: it could not be judged.
        errors: their standard errors; None: exact. violations: of each design one number per constraint that needs an
        evaluation (``constraints``), above 0: broken. Raises InputError naming the argument.
        """
        self._require_asked(points)
        values = v.items(values, "values")
        errors = None if errors is None else v.items(errors, "errors")
        if len(values) != len(points):
            raise wrong("values", f"expected one for each of {len(points)} designs, got {len(values)}")
        if errors is not None and len(errors) != len(points):
            raise wrong("errors", f"expected one for each of {len(points)} designs, got {len(errors)}")
        rows: list[_Row] = []
        for i, value in enumerate(values):
            if value is None:
                rows.append((False, "told so", [], [], []))
                continue
            told = self._per_objective(value, "values")
            error = [0.0] * len(told) if errors is None else self._per_objective(errors[i], "errors")
            if min(error) < 0:
                raise wrong("errors", "must not be negative")
            rows.append((True, "", told, error, self._broken(violations, i, len(points))))
        self._asked = []
        self._answers += rows
        if not self._waiting:
            self._searcher().tell(self._answers)
            self._told.append(self._answers)
            self._answers = []

    @property
    def constraints(self) -> int:
        """How many constraints need an evaluation: numbers of ``Judgement.violations``."""
        return self._inside.violations()

    def optimize(self, out: Path, *, resume: bool = False, finish: bool = False, pick: str = "",
                 force: bool = False, progress: Progress = None) -> Run:
        """Searches, confirms and checks, and writes the folder of results: ``papilla optimize``.

        How long and from where is the study's: ``Study.load(file, {"search.evaluations": 60, "search.time": "20 min",
        "search.seed": 2})``.
        out: the folder. resume: go on with an interrupted run there. finish: and ask for no more designs: those of
        the run are judged and confirmed. pick: which design of the front is the best. force: with model options that a
        finger of the study was not fitted with.
        progress: called with (stage, done, total, seconds left; below 0: not known). Ctrl-C ends it: what was
        evaluated is kept, and resume goes on. Works in processes of its own; no other evaluation may run meanwhile.
        Raises InputError, KeyboardInterrupt.
        """
        folder = v.path(out, "out")
        self._inside.run(folder, v.flag(resume, "resume"), v.flag(finish, "finish"), v.flag(force, "force"),
                         v.text(pick, "pick"), shown(progress, "optimize"))
        return Run(self, folder)

    def _numbers(self, values: Values) -> list[float]:
        if isinstance(values, Mapping):
            known = [variable.path for variable in self.variables]
            for path in values:
                if path not in known:
                    raise wrong(str(path), f"is no variable of the study; its variables: {', '.join(known)}")
            own = dict(zip(known, self._inside.own_values())) if len(values) < len(known) else {}
            return [x.number(values[x.path]) if x.path in values else own[x.path] for x in self.variables]
        numbers = v.items(values, "values")
        if len(numbers) != len(self.variables):
            raise wrong("values", f"expected one for each of {len(self.variables)} variables, got {len(numbers)}")
        return [x.number(value) for value, x in zip(numbers, self.variables)]

    def _require_asked(self, points: Sequence[Point]) -> None:
        if not self._asked:
            raise wrong("points", "nothing was asked for: ask() first")
        if [point._values for point in points] != [point._values for point in self._asked]:
            raise wrong("points", "expected the designs of the last ask(), in their order")

    def _per_objective(self, told: Told, key: str) -> list[float]:
        v.unmasked(told, key)
        numbers = np.atleast_1d(np.asarray(told, dtype=object))
        if numbers.shape != (len(self.objectives),):
            raise wrong(key, f"expected one number for each of {len(self.objectives)} objectives, got {told!r}")
        return [v.si(number, "", key) for number in numbers.tolist()]

    def _broken(self, violations: Sequence[Sequence[float]] | None, i: int, points: int) -> list[float]:
        count = self.constraints
        if violations is None:
            if count:
                raise wrong("violations", f"the study has {count} constraints that need an evaluation")
            return []
        violations = v.items(violations, "violations")
        if len(violations) != points:
            raise wrong("violations", f"expected one list for each of {points} designs, got {len(violations)}")
        if len(violations[i]) != count:
            raise wrong("violations", f"expected {count} numbers of each design, got {len(violations[i])}")
        return [v.si(number, "", "violations") for number in violations[i]]

    def __reduce__(self) -> tuple[Any, ...]:
        """The study, what it was told, and for how many designs it waits for an answer."""
        return Study._again, self._state()

    def _state(self) -> tuple[tuple[str, str, list[tuple[str, str]]], list[list[_Row]], list[_Row], int]:
        return self._source, self._told, self._answers, len(self._asked)

    def __deepcopy__(self, memo: dict[int, Any]) -> Study:
        return self._again(*self._state())

    def __copy__(self) -> Study:
        return self.__deepcopy__({})

    def __repr__(self) -> str:
        wanted = ", ".join(("max " if o.maximise else "min ") + o.name for o in self.objectives)
        return f"<papilla.Study of {len(self.variables)} variables, {wanted}>"


def _judgement(row: _Row) -> Judgement:
    ok, reason, values, errors, violations = row
    return Judgement(ok, reason, as_array(values), as_array(errors), as_array(violations))


def _told_judgement(row: dict[str, Any]) -> Judgement:
    def numbers(key: str) -> list[float]:
        return [float("nan") if number is None else number for number in row[key]]

    return Judgement(row["ok"], row["reason"], as_array(numbers("values")), as_array(numbers("errors")),
                     as_array(numbers("violations")))
