"""What an evaluation answers: quantities over humidity, each with its error by origin."""

from __future__ import annotations

import html
import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from papilla import _native, values as v
from papilla.quantity import Quantity
from papilla.values import FloatArray

if TYPE_CHECKING:
    import matplotlib.axes
    import pandas
    import xarray

__all__ = ["Comparison", "Difference", "Differences", "Response", "Sensitivity"]


class Response:
    """Friction of a finger on a design over humidity, drive off and on, with errors.

    Made by ``Design.evaluate``. Arrays have one item per humidity. Source: docs/theory/friction.md. Its quantities are
    those of the library's own list, include/papilla/quantities.h.
    """

    humidity: FloatArray
    """Relative humidities, shares of 1. Read-only, as all arrays of a response."""
    sound: tuple[bool, ...]
    """Whether each point can be trusted."""
    status: tuple[str, ...]
    """Of each point, for people: "ok", or what went wrong. Quantities of a state that so does not exist (under a voltage
    that breaks the dielectric down, beyond full contact or pull-in) are NaN there."""
    driven: bool
    """Whether a voltage is applied."""
    trouble: str
    """For people; empty: every point is sound."""

    def __init__(self, columns: dict[str, Any]) -> None:
        self._columns = columns
        self._quantities = {name: Quantity(**row, unit=_UNITS[name]) for name, row in columns["quantities"].items()}
        self.humidity = v.fixed(columns["relative_humidity"])
        self.sound = tuple(columns["sound"])
        self.status = tuple(columns["status"])
        self.driven = columns["driven"]
        self.trouble = columns["trouble"]

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Quantity: ...  # friction_off, modulation, ...

    def to_dict(self) -> dict[str, Any]:
        """What ``papilla evaluate --json`` prints, number for number: points, summary, plan, fidelity."""
        document: dict[str, Any] = json.loads(self._columns["json"])
        return document

    def to_dataframe(self) -> pandas.DataFrame:
        """One row per humidity, a column per quantity and one each for its ``..._error``, ``..._numerical`` and
        ``..._model``; their SI units are ``frame.attrs["units"]``. Needs pandas."""
        import pandas

        columns: dict[str, Any] = {"humidity": self.humidity}
        for name, quantity in self._quantities.items():
            columns[name] = quantity.value
            columns[name + "_error"] = quantity.error
            columns[name + "_numerical"] = quantity.numerical
            columns[name + "_model"] = quantity.model
        columns["sound"] = list(self.sound)
        frame = pandas.DataFrame(columns)
        frame.attrs["units"] = {name + part: _UNITS[name] for name in self._quantities
                                for part in ("", "_error", "_numerical", "_model")}
        return frame

    def to_xarray(self) -> xarray.Dataset:
        """Over ``humidity``: each quantity and its ``..._error``, ``..._numerical`` and ``..._model``, with attributes
        ``units`` (SI) and ``long_name``; ``sound`` and ``status``. Needs xarray."""
        import xarray

        def row(name: str, values: FloatArray, suffix: str) -> tuple[str, FloatArray, dict[str, str]]:
            return "humidity", np.array(values), {"units": _UNITS[name] or "1", "long_name": _MEANINGS[name] + suffix}

        data: dict[str, Any] = {}
        for name, quantity in self._quantities.items():
            data[name] = row(name, quantity.value, "")
            data[name + "_error"] = row(name, quantity.error, ": standard error")
            data[name + "_numerical"] = row(name, quantity.numerical, ": standard error, numerical part")
            data[name + "_model"] = row(name, quantity.model, ": standard deviation over what is not known of the model")
        data["sound"] = ("humidity", np.array(self.sound))
        data["status"] = ("humidity", np.array(self.status))
        return xarray.Dataset(data, {"humidity": ("humidity", np.array(self.humidity), {"units": "1", "long_name": "relative humidity"})})

    def plot(self, ax: matplotlib.axes.Axes | None = None, quantity: str | None = None, *,
             label: str = "") -> matplotlib.axes.Axes:
        """A quantity over humidity; returns the axes. Needs matplotlib.

        The band is two numerical standard errors; where there is a belief, a lighter one is two standard deviations of
        its model part. quantity: "modulation" (of driven designs the default), "friction_off", ... label: what the
        legend calls the curve, where several share the axes; empty: the quantity.
        """
        import matplotlib.pyplot

        name = quantity or ("modulation" if self.driven else "friction_off")
        shown: Quantity = getattr(self, name)
        if ax is None:
            ax = matplotlib.pyplot.subplots()[1]
        x = 100 * self.humidity
        told = set(ax.get_legend_handles_labels()[1])  # what a band is, the legend says once
        line, = ax.plot(x, shown.value, marker="o", label=label or name.replace("_", " "))
        for part, name_of, alpha in ((shown.model, "± 2 model", 0.1), (shown.numerical, "± 2 numerical", 0.25)):
            if np.all(np.isfinite(part)):
                ax.fill_between(x, shown.value - 2 * part, shown.value + 2 * part, alpha=alpha,
                                color=line.get_color(), linewidth=0, label=None if name_of in told else name_of)
        ax.set_xlabel("relative humidity (%)")
        ax.set_ylabel(name.replace("_", " ") + (f" ({_UNITS[name]})" if _UNITS[name] else ""))
        ax.legend()
        return ax

    @property
    def table(self) -> str:
        """The table that ``papilla evaluate`` prints, Markdown."""
        text: str = self._columns["table"]
        return text

    def __repr__(self) -> str:
        name = "modulation" if self.driven else "friction_off"
        shown = repr(getattr(self, name)).removeprefix("Quantity(").removesuffix(")")
        return f"<papilla.Response at {len(self.humidity)} humidities, {name} {shown}>"

    def _repr_svg_(self) -> str:
        svg: str = self._columns["svg"]
        return svg

    def _repr_html_(self) -> str:
        warning = f"<p><b>{html.escape(self.trouble)}</b></p>" if self.trouble else ""
        return warning + self._repr_svg_()

    def __getstate__(self) -> dict[str, Any]:
        return self._columns

    def __setstate__(self, columns: dict[str, Any]) -> None:
        self.__init__(columns)  # type: ignore[misc]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Response):
            return NotImplemented
        return _without_clock(self) == _without_clock(other)

    __hash__ = None  # type: ignore[assignment]


def _quantity(name: str, unit: str, driven: bool, meaning: str) -> property:
    """The member of a response that holds a quantity of the library's list."""

    def found(self: Response) -> Quantity:
        if name not in self._quantities:
            raise AttributeError(f"{name}: the design has no drive; give drive.amplitude")
        return self._quantities[name]

    found.__doc__ = meaning[0].upper() + meaning[1:] + (f" [{unit}]" if unit else "") + "."
    if driven:
        found.__doc__ += " AttributeError for a design without a drive."
    return property(found)


_UNITS = {name: unit for name, unit, _, _ in _native.quantities()}
_MEANINGS = {name: meaning for name, _, _, meaning in _native.quantities()}
for _name, _unit, _driven, _meaning in _native.quantities():
    setattr(Response, _name, _quantity(_name, _unit, _driven, _meaning))


def _without_clock(response: Response) -> dict[str, Any]:
    document = response.to_dict()
    for clock in ("seconds", "processor_seconds"):
        document.pop(clock, None)
    document.get("belief", {}).pop("seconds", None)
    return document


@dataclass(frozen=True)
class Difference:
    """A number of the second design less that of the first, with the error of the difference itself."""

    value: float
    error: float
    """One standard error."""
    paired: bool
    """From the same skins, droplets and grids; else both errors in squares."""
    model: float = float("nan")
    """One standard deviation of the difference over the members of belief; NaN: not stated."""
    above: float = float("nan")
    """Probability by the members of belief that the second has more; NaN: not stated."""


@dataclass(frozen=True, eq=False, repr=False)
class Differences(v.WithArrays):
    """The same at each humidity; arrays of shape (humidities,)."""

    value: FloatArray
    error: FloatArray
    paired: tuple[bool, ...]
    model: FloatArray
    """One standard deviation over the members of belief; NaN: not stated."""
    above: FloatArray
    """Probability by those members that the second has more; NaN: not stated."""

    def __repr__(self) -> str:
        pairs = ", ".join(f"{v:+.4g} ± {e:.2g}" for v, e in zip(self.value, self.error))
        return f"Differences({pairs})"


class Comparison:
    """Two designs on the same skins: what the second has more than the first.

    Source: docs/theory/accuracy.md, Eq. accuracy.14.
    """

    first: Response
    second: Response
    friction_off: Differences
    """[N]"""
    mean_friction: Difference
    """Over humidity [N]."""

    def __init__(self, columns: dict[str, Any]) -> None:
        self._columns = columns
        self.first = Response(columns["first"])
        self.second = Response(columns["second"])
        self.friction_off = self._differences("friction_off")
        self.mean_friction = Difference(*columns["mean_friction"])

    def _differences(self, name: str) -> Differences:
        if name not in self._columns:
            raise AttributeError(f"{name}: one of the designs has no drive; give drive.amplitude")
        found = self._columns[name]
        return Differences(v.fixed(found["value"]), v.fixed(found["error"]), tuple(found["paired"]),
                           v.fixed(found["model"]), v.fixed(found["above"]))

    @property
    def modulation(self) -> Differences:
        """Of (F_on - F_off) / F_off. AttributeError where a design has no drive."""
        return self._differences("modulation")

    @property
    def friction_on(self) -> Differences:
        """[N]. AttributeError where a design has no drive."""
        return self._differences("friction_on")

    @property
    def mean_modulation(self) -> Difference:
        """Over humidity. AttributeError where a design has no drive."""
        if "mean_modulation" not in self._columns:
            raise AttributeError("mean_modulation: one of the designs has no drive")
        return Difference(*self._columns["mean_modulation"])

    def __getstate__(self) -> dict[str, Any]:
        return self._columns

    def __setstate__(self, columns: dict[str, Any]) -> None:
        self.__init__(columns)  # type: ignore[misc]

    def __repr__(self) -> str:
        name = "modulation" if "modulation" in self._columns else "friction_off"
        return f"<papilla.Comparison, {name} {getattr(self, name)!r}>"


@dataclass(frozen=True)
class Sensitivity:
    """What one number of a design does to a metric, by finite steps on common skins."""

    path: str
    unit: str
    """For people; the numbers are SI."""
    value: float
    down: float
    """The lower value that was evaluated; ``value`` itself where the design allows no step down."""
    up: float
    change: Difference
    """Of the metric from ``down`` to ``up``."""
    slope: float
    """change / (up - down), per SI unit."""
    slope_error: float
    """One standard error."""


def as_array(values: list[float]) -> FloatArray:
    return np.asarray(values, dtype=np.float64)
