"""One design at many values of its keys."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Union

from papilla import values as v
from papilla.design import Design
from papilla.errors import InputError, wrong
from papilla.progress import Progress, shown
from papilla.response import Response

if TYPE_CHECKING:
    import pandas
    import xarray

__all__ = ["Sweep", "sweep"]

_MOST_POINTS = 100_000  # days of evaluations, and all their responses in memory

Values = Union[Mapping[str, Sequence[Any]], Sequence[Mapping[str, Any]]]


class Sweep:
    """Responses of one design at many values of its keys, on the same skins: what is common to them cancels in their
    differences. Made by ``papilla.sweep``."""

    points: list[dict[str, Any]]
    """Of each response the values that were set, as they were given."""
    designs: list[Design]
    responses: list[Response]

    def __init__(self, axes: dict[str, list[Any]], points: list[dict[str, Any]], designs: list[Design],
                 responses: list[Response]) -> None:
        self._axes = axes
        self.points, self.designs, self.responses = points, designs, responses

    def __len__(self) -> int:
        return len(self.responses)

    def to_dataframe(self) -> pandas.DataFrame:
        """A row for each point and humidity: the values that were set, then the columns of ``Response.to_dataframe``.
        Needs pandas."""
        import pandas

        frames = []
        for point, response in zip(self.points, self.responses):
            frame = response.to_dataframe()
            for i, (key, value) in enumerate(point.items()):
                frame.insert(i, key, [value] * len(frame))
            frames.append(frame)
        whole = pandas.concat(frames, ignore_index=True)
        # A point without a voltage has fewer columns than one with it.
        whole.attrs["units"] = {name: unit for frame in frames for name, unit in frame.attrs["units"].items()}
        return whole

    def summary(self) -> pandas.DataFrame:
        """A row for each point: the values that were set, and numbers over humidity with their standard errors
        (``mean_modulation``, ``mean_modulation_error``, ...). Needs pandas."""
        import pandas

        rows = []
        for point, response in zip(self.points, self.responses):
            row = dict(point)
            for name, number in response.to_dict()["summary"].items():
                known = number or {"value": None, "se": None}  # null: a humidity has no number for it
                row[name], row[name + "_error"] = known["value"], known["se"]
            rows.append(row)
        return pandas.DataFrame(rows)

    def to_xarray(self) -> xarray.Dataset:
        """Over each key of a grid and humidity, as of ``Response.to_xarray``; NaN where a point has no such quantity, as
        those of a voltage without one. Needs xarray; LookupError for a list of points."""
        import xarray

        if not self._axes:
            raise LookupError("the sweep is a list of points, no grid: to_dataframe() has them")
        sets = iter(_of_one_kind([response.to_xarray() for response in self.responses]))

        def along(keys: list[str]) -> xarray.Dataset:
            if not keys:
                return next(sets)
            axis = xarray.DataArray(self._axes[keys[0]], dims=keys[0], name=keys[0])
            return xarray.concat([along(keys[1:]) for _ in self._axes[keys[0]]], axis, combine_attrs="override")

        return along(list(self._axes))

    def __repr__(self) -> str:
        over = " x ".join(f"{key} ({len(values)})" for key, values in self._axes.items()) or "points"
        return f"<papilla.Sweep of {len(self)} evaluations over {over}>"


def sweep(design: Design, values: Values, *, level: str = "", threads: int = 0, model: bool = True, force: bool = False,
          progress: Progress = None) -> Sweep:
    """A design evaluated at many values of its keys.

    values: {"texture.depth": ["100 nm", "200 nm"], "drive.amplitude": [50, 100, 150]}, every combination of them, the
    last key fastest; or a list of {key: value}. level, threads, model, force: as of ``Design.evaluate``. progress: called
    with (done, total).

    Every design is checked before the first is evaluated. Cost: one evaluation a point. Raises InputError with every
    mistake, KeyboardInterrupt.
    """
    if not isinstance(design, Design):
        raise wrong("design", f"expected a Design, got {type(design).__name__}")
    axes, points = _points(values)
    designs, problems = [], []
    for point in points:
        try:
            designs.append(design.with_(point))
            designs[-1]._inside.require_simulated()
        except InputError as error:
            problems += [problem for problem in error.problems if problem not in problems]
    if problems:
        raise InputError(problems)
    report = shown(progress, "sweep")
    responses = []
    for i, made in enumerate(designs):
        responses.append(made.evaluate(level, threads=threads, model=model, force=force))
        if report:
            report(i + 1, len(designs))
    return Sweep(axes, points, designs, responses)


def _of_one_kind(sets: list[xarray.Dataset]) -> list[xarray.Dataset]:
    """Each with the quantities of all: NaN where it had none."""
    import xarray

    every = {name: data.attrs for one in sets for name, data in one.data_vars.items()}
    return [one.assign({name: xarray.full_like(one["friction_off"], math.nan).assign_attrs(attributes)
                        for name, attributes in every.items() if name not in one}) for one in sets]


def _points(values: Values) -> tuple[dict[str, list[Any]], list[dict[str, Any]]]:
    if isinstance(values, Mapping):
        axes = {key: v.items(given, key) for key, given in values.items()}
        empty = [key for key, given in axes.items() if not given]
        if not axes or empty:
            raise wrong(empty[0] if empty else "values", "expected one value at least")
        _limit(math.prod(len(given) for given in axes.values()))
        return axes, [dict(zip(axes, chosen)) for chosen in itertools.product(*axes.values())]
    points = v.items(values, "values")
    if not points:
        raise wrong("values", "expected one point at least")
    _limit(len(points))
    for i, point in enumerate(points):
        if not isinstance(point, Mapping):
            raise wrong(f"values.{i}", f"expected a dict of keys, got {type(point).__name__}")
    return {}, [dict(point) for point in points]


def _limit(points: int) -> None:
    if points > _MOST_POINTS:
        raise wrong("values", f"{points} points: expected {_MOST_POINTS} at most")
