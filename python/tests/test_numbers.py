"""Quantities are arrays whose errors follow the rules of propagation, and tables with units."""

from __future__ import annotations

import copy
import operator
import pickle
from collections.abc import Callable

import numpy as np
import pytest

import papilla as pp

A = pp.Quantity(np.array([2.0, 3.0, 0.5]), np.array([0.02, 0.01, 0.005]), {"sampling": np.array([0.02, 0.01, 0.005])},
                np.array([0.02, 0.01, 0.005]), np.array([0.1, 0.2, 0.3]), "N")
B = pp.Quantity(np.array([0.7, 1.5, 4.0]), np.array([0.004, 0.03, 0.02]), unit="N")

FUNCTIONS: list[Callable] = [
    lambda a, b: a + b, lambda a, b: a - b, lambda a, b: a * b, lambda a, b: a / b, lambda a, b: a**b,
    lambda a, b: 3 * a - b / 2 + 1, lambda a, b: (a - b) / a, lambda a, b: np.sqrt(a) * np.log(b),
    lambda a, b: np.exp(-a) + np.log10(b), lambda a, b: abs(-a) ** 2 + np.square(b), lambda a, b: np.reciprocal(a) * +b,
]


@pytest.mark.parametrize("function", FUNCTIONS)
def test_errors_are_those_of_a_million_draws(function: Callable) -> None:
    draws = np.random.default_rng(5)
    shown = function(A, B)
    if function is FUNCTIONS[6]:  # a stands twice, in two objects: independent by the rule, as the page says
        a = [A.value + A.error * draws.standard_normal((1_000_000, 3)) for _ in range(2)]
        b = B.value + B.error * draws.standard_normal((1_000_000, 3))
        sampled = (a[0] - b) / a[1]
    else:
        sampled = function(A.value + A.error * draws.standard_normal((1_000_000, 3)),
                           B.value + B.error * draws.standard_normal((1_000_000, 3)))
    assert np.allclose(shown.value, function(A.value, B.value))
    assert np.allclose(shown.error, sampled.std(axis=0), rtol=0.01)


def test_one_object_twice_is_one_number() -> None:
    assert np.all((A - A).error == 0) and np.all((A / A).error < 1e-15)
    assert np.allclose((A * A).error, np.square(A).error) and np.allclose((A + A).error, 2 * A.error)


def test_a_part_that_was_not_measured_stays_unknown() -> None:
    both = A + B
    assert np.allclose((2 * A).parts["sampling"], 2 * A.parts["sampling"]) and np.allclose((2 * A).model, [0.2, 0.4, 0.6])
    assert np.all(np.isnan(both.parts["sampling"])) and np.all(np.isnan(both.model)), "of B it is not known"
    assert np.all(np.isfinite(both.error))


def test_units_are_kept_by_sums_and_multiples_alone() -> None:
    assert (A + B).unit == (A - 1).unit == (2 * A).unit == (A / 2).unit == (-A).unit == "N"
    assert (A * B).unit == (A / B).unit == (1 / A).unit == np.sqrt(A).unit == ""


def test_quantities_of_two_units_have_no_sum_and_no_order() -> None:
    gap = pp.Quantity(np.array([1e-6, 2e-6, 3e-6]), np.array([1e-8] * 3), unit="m")
    for call in (lambda: A + gap, lambda: A - gap, lambda: A < gap, lambda: np.isclose(A, gap), lambda: np.allclose(A, b=gap)):
        with pytest.raises(TypeError, match="quantities in N and in m: they have no common unit"):
            call()
    assert (A * gap).unit == "" and (A / gap + gap).unit == ""  # of a product it is not known
    assert (A > 1).tolist() == [True, True, False] and (A + 1).unit == "N"


def test_quantities_of_two_units_are_not_equal() -> None:
    same = pp.Quantity(A.value, A.error, unit="m")
    assert (A == same).tolist() == [False] * 3 and (A != same).tolist() == [True] * 3 and (A == same[0]).shape == (3,)
    assert A[0] not in [same[0]] and A[0] in [A[0] + 0] and not np.array_equal(A, same)


def test_a_quantity_in_place_is_a_new_one() -> None:
    for change in (lambda x: operator.iadd(x, 1), lambda x: operator.isub(x, B), lambda x: operator.imul(x, 2),
                   lambda x: operator.itruediv(x, B), lambda x: operator.ipow(x, 2)):
        assert isinstance(change(A), pp.Quantity)
    x = A
    x += 1
    assert x.value.tolist() == [3.0, 4.0, 1.5] and x.error.tolist() == A.error.tolist() and A.value[0] == 2


def test_what_is_no_number_beside_a_quantity_is_said() -> None:
    for other, said in (("1", "real numbers and arrays of them, got str"), (None, "got NoneType"),
                        (np.array(["1"] * 3), "got an array of dtype <U1"), (1j, "got complex")):
        with pytest.raises(TypeError, match=said):
            A + other
    with pytest.raises(TypeError, match=r"numpy\.add\.reduce would lose the errors"):
        np.add.reduce(A)


def test_masked_values_are_no_numbers() -> None:
    hidden = np.ma.masked_array(np.ones(3), [0, 0, 1])
    for call in (lambda: A + hidden, lambda: A > hidden):
        with pytest.raises(TypeError, match="1 of 3 values are masked"):
            call()
    assert (A + np.ma.masked_array(np.ones(3), False)).value[0] == 3  # none is masked
    with pytest.raises(pp.InputError, match="1 of 3 values are masked"):
        pp.Quantity(hidden, np.zeros(3))


def test_a_quantity_is_an_array() -> None:
    assert np.array_equal(np.asarray(A), A.value) and np.asarray(A, dtype=np.float32).dtype == np.float32
    assert np.shares_memory(A.__array__(copy=False), A.value) and not np.shares_memory(np.asarray(A), A.value)
    assert len(A) == 3 and A.shape == (3,) and [float(item) for item in A] == [2.0, 3.0, 0.5]
    assert A[1].shape == () and A[1].error == 0.01 and A[A > 1].value.tolist() == [2.0, 3.0] and A[::-1].model[0] == 0.3
    assert (A > B).tolist() == [True, True, False] and bool(A[0] == 2.0)
    assert f"{A[0]:.2f}" == "2.00 ± 0.02" and f"{A[:2]:.1f}" == "[2.0 ± 0.0, 3.0 ± 0.0]"
    many = pp.Quantity(np.arange(50.0), np.ones(50))
    assert repr(A) == "Quantity(2 ± 0.02, 3 ± 0.01, 0.5 ± 0.005, N)" and "46 more" in repr(many) and len(repr(many)) < 90
    with pytest.raises(TypeError, match="numpy.sin would lose the errors of a Quantity: take its .value"):
        np.sin(A)
    with pytest.raises(TypeError):
        A + "1 N"
    with pytest.raises(TypeError):
        np.add.reduce(A)
    with pytest.raises(TypeError):
        A.parts["sampling"] = A.error  # type: ignore[index]


def test_arrays_of_quantities_are_read_only() -> None:
    own = np.array([1.0, 2.0])
    q = pp.Quantity(own, np.array(0.1))
    own *= 1e3
    assert q.value.tolist() == [1.0, 2.0], "the quantity has its own"
    for array in (q.value, q.error, q.numerical, q.model, q.parts["grid"], q[:1].value, (2 * q).error):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0


LOSING: list[Callable] = [
    np.mean, np.median, np.std, np.average, np.sum, np.max, np.sort, np.diff, np.cumsum, np.trapz,
    lambda a: np.concatenate([a, a]), lambda a: np.stack([a, a]), lambda a: np.where(a > 1, a, 0), lambda a: np.clip(a, 0, 1),
    lambda a: np.interp(1.5, a.value, a), lambda a: np.dot(a, a), lambda a: np.polyfit(a.value, a, 1),
]


@pytest.mark.parametrize("function", LOSING)
def test_functions_that_would_lose_the_errors_are_refused(function: Callable) -> None:
    with pytest.raises(TypeError, match="would lose the errors of a Quantity: take its .value"):
        function(A)


def test_comparisons_of_quantities_are_those_of_their_values() -> None:
    assert np.allclose(A, A.value) and np.array_equal(A, A) and np.isclose(A, 2).tolist() == [True, False, False]
    assert np.shape(A) == (3,) and np.ndim(A[0]) == 0 and np.size(A) == 3
    assert np.isclose([2.0, 1.0, 0.5], b=A).tolist() == [True, False, True] and np.allclose(a=A, b=A) and np.shape(a=A) == (3,)


def results() -> list[Callable[[float], object]]:
    """Results that hold arrays, from a number of them."""
    z = np.outer(np.cos(np.arange(16)), np.sin(np.arange(16))) * 1e-8
    return [lambda x: pp.Judgement(True, "", np.array([x, np.nan]), np.array([0.1, 0.2]), np.array([])),
            lambda x: pp.Differences(np.array([x, 2.0]), np.array([0.1, 0.2]), (True, True), np.full(2, np.nan), np.full(2, 0.5)),
            lambda x: pp.contact(z, "6 um", pressure=x, modulus="1 MPa"), lambda x: pp.spectrum(x * z, "6 um"),
            lambda x: pp.droplets(z + 3e-8, "6 um", volume=1e-20 * x), lambda x: pp.field(z + 3e-8, "6 um", voltage=x)]


@pytest.mark.parametrize("made", results())
def test_results_are_equal_where_all_their_numbers_are(made: Callable[[float], object]) -> None:
    one = made(2.0)
    assert one == made(2.0) and one != made(3.0) and one != 2.0 and one != A.unit
    with pytest.raises(TypeError, match="unhashable"):
        hash(one)


def test_results_of_numbers_alone_are_keys_of_dicts() -> None:
    one, other = (pp.bridge("1 um3", "100 nm", 0.5, 0.5) for _ in range(2))
    assert one == other and {one: "first"}[other] == "first" and repr(one).startswith("Bridge(exists=True, ")


def test_quantities_survive_pickle_and_copy() -> None:
    for other in (pickle.loads(pickle.dumps(A)), copy.copy(A), copy.deepcopy(A)):
        assert np.array_equal(other.value, A.value) and other.unit == "N"
        assert np.array_equal(other.parts["sampling"], A.parts["sampling"]) and np.array_equal(other.model, A.model)


def test_a_response_is_a_table_with_units(quick: pp.Design) -> None:
    r = quick.evaluate()
    frame = r.to_dataframe()
    assert frame.attrs["units"]["friction_off"] == frame.attrs["units"]["friction_off_error"] == "N"
    assert frame["modulation"][0] == r.modulation[0]
    assert (r.friction_on - r.friction_off).unit == "N" and repr(r).count("Quantity") == 0
    xarray = pytest.importorskip("xarray")
    data = r.to_xarray()
    assert isinstance(data, xarray.Dataset) and data["friction_on"].attrs["units"] == "N"
    assert float(data["modulation"].sel(humidity=0.5)) == r.modulation.value[0]
    assert float(data["modulation_numerical"][0]) == r.modulation.numerical[0] and bool(data["sound"][0]) == r.sound[0]
    data["modulation"][...] = -1
    assert r.modulation.value[0] != -1, "the table has its own"
    with pytest.raises(ValueError, match="read-only"):
        r.humidity[0] = 0


def test_a_sweep_is_its_evaluations(quick: pp.Design) -> None:
    told: list[tuple[int, int]] = []
    depths, volts = ["200 nm", 400e-9], [100.0, 200.0]
    s = pp.sweep(quick, {"texture.depth": depths, "drive.amplitude": volts}, progress=lambda *state: told.append(state))
    assert told == [(i, 4) for i in range(1, 5)] and len(s) == 4
    assert s.points[1] == {"texture.depth": "200 nm", "drive.amplitude": 200.0}
    assert s.responses[2] == quick.with_({"texture.depth": 400e-9, "drive.amplitude": 100.0}).evaluate()
    frame = s.to_dataframe()
    assert list(frame["drive.amplitude"]) == volts * 2 and frame["modulation"][3] == s.responses[3].modulation.value[0]
    summary = s.summary()
    assert len(summary) == 4 and summary["mean_modulation"][0] == s.responses[0].modulation.value[0]
    assert np.all(summary["mean_modulation_error"] > 0)
    pytest.importorskip("xarray")
    grid = s.to_xarray()
    assert dict(grid.sizes) == {"texture.depth": 2, "drive.amplitude": 2, "humidity": 1}
    assert float(grid["modulation"].sel({"drive.amplitude": 200.0})[0, 0]) == s.responses[1].modulation.value[0]
    listed = pp.sweep(quick, [{"texture.depth": "200 nm"}, {"texture.diameter": "2 um"}])
    assert listed.designs[1]["texture.diameter"] == 2e-6
    with pytest.raises(LookupError, match="to_dataframe"):
        listed.to_xarray()


def test_the_table_of_a_sweep_has_the_units_of_all_its_points() -> None:
    import pandas

    class Told:
        """As a response of these columns."""

        def __init__(self, units: dict[str, str]) -> None:
            self.units = units

        def to_dataframe(self) -> pandas.DataFrame:
            frame = pandas.DataFrame({name: [1.0] for name in self.units})
            frame.attrs["units"] = self.units
            return frame

    undriven, driven = {"friction_off": "N"}, {"friction_off": "N", "modulation": "", "electrostatic_force": "N"}
    s = pp.Sweep({}, [{"drive.amplitude": 0.0}, {"drive.amplitude": 200.0}], [], [Told(undriven), Told(driven)])  # type: ignore[list-item]
    assert s.to_dataframe().attrs["units"] == driven


def test_the_grid_of_a_sweep_lacks_what_a_point_lacks() -> None:
    xarray = pytest.importorskip("xarray")

    class Told:
        """As a response of these numbers."""

        def __init__(self, **values: float) -> None:
            self.values = values

        def to_xarray(self) -> xarray.Dataset:
            return xarray.Dataset({name: ("humidity", [value], {"units": name[0]}) for name, value in self.values.items()},
                                  {"humidity": [0.5]})

    told = [Told(friction_off=1.0), Told(friction_off=2.0, modulation=0.5)]
    grid = pp.Sweep({"drive.amplitude": [0.0, 200.0]}, [], [], told).to_xarray()  # type: ignore[arg-type]
    assert grid["friction_off"].values.tolist() == [[1.0], [2.0]]
    assert np.array_equal(grid["modulation"].values, [[np.nan], [0.5]], equal_nan=True)
    assert grid["modulation"].attrs == {"units": "m"}


def test_a_sweep_names_every_mistake_before_it_works(quick: pp.Design) -> None:
    told: list[object] = []
    with pytest.raises(pp.InputError) as caught:
        pp.sweep(quick, {"texture.depth": ["100 nm", "-1 nm"], "drive.amplitude": [100.0, "200 Hz"]}, progress=told.append)
    assert {p.key for p in caught.value.problems} == {"texture.depth", "drive.amplitude"} and not told
    for values in ({}, [], {"texture.depth": []}, 3, [3]):
        with pytest.raises(pp.InputError):
            pp.sweep(quick, values)  # type: ignore[arg-type]
