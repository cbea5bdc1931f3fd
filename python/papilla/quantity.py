"""Numbers with standard errors by origin, as arrays that propagate them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt
from numpy.lib.mixins import NDArrayOperatorsMixin

from papilla.values import FloatArray, fixed

__all__ = ["Quantity"]

_Slope = Callable[..., Any]

# Partial derivatives by each argument, at the arguments.
_SLOPES: dict[np.ufunc, tuple[_Slope, ...]] = {
    np.add: (lambda a, b: np.ones_like(a), lambda a, b: np.ones_like(b)),
    np.subtract: (lambda a, b: np.ones_like(a), lambda a, b: -np.ones_like(b)),
    np.multiply: (lambda a, b: b, lambda a, b: a),
    np.true_divide: (lambda a, b: 1 / b, lambda a, b: -a / b**2),
    np.power: (lambda a, b: b * a ** (b - 1), lambda a, b: np.log(a) * a**b),
    np.negative: (lambda a: -np.ones_like(a),),
    np.positive: (np.ones_like,),
    np.absolute: (np.sign,),
    np.square: (lambda a: 2 * a,),
    np.sqrt: (lambda a: 0.5 / np.sqrt(a),),
    np.reciprocal: (lambda a: -1 / a**2,),
    np.exp: (np.exp,),
    np.log: (lambda a: 1 / a,),
    np.log10: (lambda a: 1 / (a * np.log(10)),),
}
# Functions whose answer has no error to lose.
_OF_VALUES = {np.shape, np.ndim, np.size, np.isclose, np.allclose, np.array_equal}
_COMPARISONS = {np.less, np.less_equal, np.greater, np.greater_equal, np.equal, np.not_equal, np.isfinite, np.isnan}
_SUMS = {np.add, np.subtract, np.negative, np.positive, np.absolute}
_PARTS = ("sampling", "grid", "solver", "humidity", "method", "field", "parameters", "model", "water")
_SHOWN = 6


@dataclass(frozen=True, eq=False, repr=False)
class Quantity(NDArrayOperatorsMixin):
    """A number at each humidity, SI, with one standard error. It is an array: ``np.asarray(q)`` are its values, ``q[0]``
    and ``q[q > 0.1]`` are quantities, and sums, products, powers, roots and logarithms carry the errors along.

    The error is the root of the sum of squares of its parts but ``model`` and ``water``, which are common to all designs:
    what the finger's belief leaves open, and half a band of the droplets. NaN in a part: it was not
    measured. Source: docs/theory/accuracy.md.

    Errors of different quantities are propagated to first order as if they were independent, part by part. Quantities of
    one evaluation, or of designs on the same skins, are not: for their differences ``papilla.compare`` is surer. Two
    names of the very same object are the same number: ``q - q`` has no error. Other functions of numpy (``np.mean``,
    ``np.sin``, ``np.concatenate``) would lose the errors and raise TypeError: take ``q.value``. The arrays are read-only:
    ``q.value.copy()`` is your own.
    """

    value: FloatArray
    """Shape (humidities,)."""
    error: FloatArray
    """Shape (humidities,): one standard error."""
    parts: Mapping[str, FloatArray] = field(default_factory=dict)
    """By origin, each of shape (humidities,): sampling, grid, solver, humidity, method, field, parameters, model, water."""
    numerical: FloatArray = None  # type: ignore[assignment]
    """Shape (humidities,): one standard error of skins, grids and methods, in squares."""
    model: FloatArray = None  # type: ignore[assignment]
    """Shape (humidities,): one standard deviation over what is not known of finger and model, the members of the
    finger's belief, else the part ``parameters``; NaN: not stated."""
    unit: str = ""
    """SI; empty: none, or not known of a product."""

    def __post_init__(self) -> None:
        def whole(name: str, given: Any) -> None:
            object.__setattr__(self, name, given)

        whole("value", fixed(self.value))

        def like_value(numbers: npt.ArrayLike) -> FloatArray:
            return fixed(np.broadcast_to(numbers, self.value.shape))

        whole("error", like_value(self.error))
        whole("numerical", self.error if self.numerical is None else like_value(self.numerical))
        unstated = like_value(np.nan)
        whole("model", unstated if self.model is None else like_value(self.model))
        whole("parts", MappingProxyType({name: like_value(self.parts[name]) if name in self.parts else unstated
                                         for name in _PARTS}))

    @property
    def shape(self) -> tuple[int, ...]:
        """Of the values: (humidities,), or () of one item."""
        return self.value.shape

    @property
    def ndim(self) -> int:
        """Of the values: 1, or 0 of one item."""
        return self.value.ndim

    def __array__(self, dtype: npt.DTypeLike = None, copy: bool | None = None) -> npt.NDArray[Any]:
        return np.array(self.value, dtype=dtype)

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        if method != "__call__" or options:
            return NotImplemented
        plain = [np.asarray(_value_of(x)) for x in inputs]
        if ufunc in _COMPARISONS:
            return ufunc(*plain)
        if any(x.dtype.kind not in "fiub" for x in plain):
            return NotImplemented
        if ufunc not in _SLOPES:
            raise _losing(ufunc)
        plain = [x.astype(np.float64) for x in plain]
        value = np.asarray(ufunc(*plain))
        terms = _terms(inputs, [(x, slope(*plain)) for x, slope in zip(inputs, _SLOPES[ufunc]) if isinstance(x, Quantity)])

        def spread(of: Callable[[Quantity], FloatArray]) -> FloatArray:
            squares = sum(np.square(slope * of(x)) for x, slope in terms)
            return np.broadcast_to(np.sqrt(squares), value.shape)

        return Quantity(value, spread(lambda q: q.error),
                        {name: spread(lambda q, name=name: q.parts[name]) for name in _PARTS},  # type: ignore[misc]
                        spread(lambda q: q.numerical), spread(lambda q: q.model), _unit(ufunc, inputs))

    def __array_function__(self, function: Callable[..., Any], types: Any, inputs: tuple[Any, ...],
                           options: dict[str, Any]) -> Any:
        if function not in _OF_VALUES:
            raise _losing(function)
        return function(*map(_value_of, inputs), **{name: _value_of(x) for name, x in options.items()})

    def __getitem__(self, chosen: Any) -> Quantity:
        return Quantity(self.value[chosen], self.error[chosen], {n: p[chosen] for n, p in self.parts.items()},
                        self.numerical[chosen], self.model[chosen], self.unit)

    def __iter__(self) -> Iterator[Quantity]:
        return (self[i] for i in range(len(self)))

    def __len__(self) -> int:
        return len(self.value)

    def __float__(self) -> float:
        return float(self.value)

    def __bool__(self) -> bool:
        return bool(self.value)

    def __format__(self, form: str) -> str:
        """Value ± error, each in the format: ``f"{r.modulation[0]:.3f}"``."""
        if not form:
            return str(self)
        shown = [f"{v:{form}} ± {e:{form}}" for v, e in zip(self.value.ravel(), self.error.ravel())]
        return shown[0] if not self.shape else f"[{', '.join(shown)}]"

    def __repr__(self) -> str:
        shown = [f"{v:.4g} ± {e:.2g}" for v, e in zip(self.value.ravel(), self.error.ravel())]
        if len(shown) > _SHOWN:
            shown[_SHOWN // 2:-1] = [f"... {len(shown) - _SHOWN // 2 - 1} more ..."]
        return f"Quantity({', '.join(shown)}{', ' + self.unit if self.unit else ''})"

    def __reduce__(self) -> tuple[Any, ...]:
        return Quantity, (self.value, self.error, dict(self.parts), self.numerical, self.model, self.unit)

    __hash__ = None  # type: ignore[assignment]


def _losing(function: Any) -> TypeError:
    return TypeError(f"numpy.{function.__name__} would lose the errors of a Quantity: take its .value")


def _value_of(x: Any) -> Any:
    return x.value if isinstance(x, Quantity) else x


def _terms(inputs: tuple[Any, ...], slopes: list[tuple[Quantity, Any]]) -> list[tuple[Quantity, Any]]:
    """A quantity that stands twice is one number: its slopes add up."""
    if len(slopes) == 2 and inputs[0] is inputs[1]:
        return [(slopes[0][0], slopes[0][1] + slopes[1][1])]
    return slopes


def _unit(ufunc: np.ufunc, inputs: tuple[Any, ...]) -> str:
    """That of sums of one unit and of multiples; of other results it is not kept."""
    units = [x.unit for x in inputs if isinstance(x, Quantity)]
    multiple = len(units) == 1 and (ufunc is np.multiply or (ufunc is np.true_divide and isinstance(inputs[0], Quantity)))
    return units[0] if multiple or (ufunc in _SUMS and len(set(units)) == 1) else ""
