"""Numbers with standard errors by origin, as arrays that propagate them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt
from numpy.lib.mixins import NDArrayOperatorsMixin

from papilla.values import FloatArray, fixed, masked

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
_CLOSENESS = {np.isclose, np.allclose}
_OF_VALUES = {np.shape, np.ndim, np.size, np.array_equal} | _CLOSENESS
_ORDERS = {np.less, np.less_equal, np.greater, np.greater_equal}
# And what they say of two units.
_EQUALITIES = {np.equal: False, np.not_equal: True}
_QUESTIONS = {np.isfinite, np.isnan}
_ADDITIONS = {np.add, np.subtract}
_SUMS = _ADDITIONS | {np.negative, np.positive, np.absolute}
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
    names of the very same object are the same number: ``q - q`` has no error. The items of one quantity share their
    skins, method, field and finger too: the error of ``sum(q) / len(q)`` is far too small, and the mean of an evaluation
    with its own error is ``r.to_dict()["summary"]["mean_modulation"]``. Quantities of two units have no sum and no
    order, and are not equal.
    Other functions of numpy (``np.mean``,
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
        return np.array(self.value, dtype=dtype, copy=copy is not False)

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        if method != "__call__" or options or ufunc not in {*_SLOPES, *_ORDERS, *_EQUALITIES, *_QUESTIONS}:
            raise _losing(ufunc, method, options)
        _require_unmasked(inputs)
        plain = [np.asarray(_value_of(x)) for x in inputs]
        if ufunc in _ORDERS | _ADDITIONS:
            _require_one_unit(ufunc, inputs)
        if ufunc in _EQUALITIES and len(_units(inputs)) > 1:
            return np.full(np.broadcast_shapes(*(x.shape for x in plain)), _EQUALITIES[ufunc])[()]
        if ufunc not in _SLOPES:
            return ufunc(*plain)
        for x, given in zip(plain, inputs):
            if x.dtype.kind not in "fiub":
                raise TypeError(f"a Quantity goes with real numbers and arrays of them, got {_said(given)}")
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
        given = (*inputs, *options.values())
        _require_unmasked(given)
        if function in _CLOSENESS:
            _require_one_unit(function, given)
        if function is np.array_equal and len(_units(given)) > 1:
            return False
        return function(*map(_value_of, inputs), **{name: _value_of(x) for name, x in options.items()})

    # x += 1 binds x to a new quantity, as of every number.
    __iadd__ = NDArrayOperatorsMixin.__add__
    __isub__ = NDArrayOperatorsMixin.__sub__
    __imul__ = NDArrayOperatorsMixin.__mul__
    __itruediv__ = NDArrayOperatorsMixin.__truediv__
    __ipow__ = NDArrayOperatorsMixin.__pow__

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


def _losing(function: Any, method: str = "__call__", options: Mapping[str, Any] = MappingProxyType({})) -> TypeError:
    name = f"numpy.{function.__name__}" + ("" if method == "__call__" else "." + method)
    if method == "__call__" and options:
        name += f" with {', '.join(options)}"
    return TypeError(f"{name} would lose the errors of a Quantity: take its .value")


def _require_unmasked(inputs: tuple[Any, ...]) -> None:
    """A quantity has no mask, and what is below one is no number."""
    for x in inputs:
        if (hidden := masked(x)):
            raise TypeError(f"{hidden} of {np.size(x)} values are masked, and a Quantity has no mask: fill them, "
                            "x.filled(...), or choose the others, q[~x.mask]")


def _units(inputs: tuple[Any, ...]) -> list[str]:
    """Those that are known, each once. A plain number has the unit of the quantity beside it."""
    return list(dict.fromkeys(x.unit for x in inputs if isinstance(x, Quantity) and x.unit))


def _require_one_unit(function: Callable[..., Any], inputs: tuple[Any, ...]) -> None:
    """Of sums, orders and what is close."""
    units = _units(inputs)
    if len(units) > 1:
        raise TypeError(f"numpy.{function.__name__} of quantities in {units[0]} and in {units[1]}: they have no common unit")


def _said(given: Any) -> str:
    return f"an array of dtype {given.dtype}" if isinstance(given, np.ndarray) else type(given).__name__


def _value_of(x: Any) -> Any:
    return x.value if isinstance(x, Quantity) else x


def _terms(inputs: tuple[Any, ...], slopes: list[tuple[Quantity, Any]]) -> list[tuple[Quantity, Any]]:
    """A quantity that stands twice is one number: its slopes add up."""
    if len(slopes) == 2 and inputs[0] is inputs[1]:
        return [(slopes[0][0], slopes[0][1] + slopes[1][1])]
    return slopes


def _unit(ufunc: np.ufunc, inputs: tuple[Any, ...]) -> str:
    """That of sums of one unit and of multiples; of other results, and of sums with one of no known unit, it is not kept."""
    units = [x.unit for x in inputs if isinstance(x, Quantity)]
    multiple = len(units) == 1 and (ufunc is np.multiply or (ufunc is np.true_divide and isinstance(inputs[0], Quantity)))
    return units[0] if multiple or (ufunc in _SUMS and len(set(units)) == 1) else ""
