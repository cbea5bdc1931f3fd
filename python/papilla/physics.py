"""Single pieces of the physics, on arrays or on cases of one's own."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from papilla import _native, values as v
from papilla.design import Heights, Look
from papilla.errors import wrong
from papilla.values import FloatArray, Path, Quantified

__all__ = ["Bridge", "Contact", "Drive", "Droplets", "Field", "Persson", "bridge", "contact", "drive", "droplets",
           "field", "haze", "persson"]

Size = Union[Quantified, Sequence[Quantified]]
Map = Union[npt.ArrayLike, Heights]


def map_of(z: Map, size: Size | None, key: str) -> tuple[FloatArray, float, float]:
    if isinstance(z, Heights):
        if size is not None:
            raise wrong("size", "is known of Heights; leave it out")
        return v.height_map(z.z, key), z.dx, z.dy
    heights = v.height_map(z, key)
    if size is None:
        raise wrong("size", "give the width of the map, e.g. \"12 um\"")
    return (heights, *v.pixel_size(heights.shape, size))


@dataclass(frozen=True, eq=False, repr=False)
class Contact(v.WithArrays):
    """A rough surface pressed on an elastic solid."""

    converged: bool
    reason: str
    """For people; empty where it converged."""
    pressure: FloatArray
    """Shape of the heights [Pa]."""
    gap: FloatArray
    """Shape of the heights [m]; 0 in contact."""
    area_fraction: float
    """With a sub-pixel edge, Eq. contact.7."""
    area_fraction_error: float
    """By the grid, Eq. contact.8."""
    mean_pressure: float
    """[Pa]"""
    approach: float
    """Of the mean planes since first touch [m]."""
    elastic_energy: float
    """[J]"""
    certificate: float
    """Bound on the energy error, relative, Eq. contact.4."""


def contact(z: Map, size: Size | None = None, *, pressure: Quantified, modulus: Quantified | None = None,
            layer_modulus: Quantified | None = None, layer_thickness: Quantified = 0.0, layer_poisson: float = 0.5,
            bulk_modulus: Quantified | None = None, bulk_poisson: float = 0.5, tolerance: float = 1e-8,
            hardness: Quantified = 0.0) -> Contact:
    """A rigid rough surface under a mean pressure on a (layered) elastic half-space, without friction, periodic.

    z: Heights, or an array of shape (ny, nx) [m], high touches first. size: its width, or (width, height).
    pressure: mean [Pa]. modulus: E* of a half-space [Pa]; or layer_modulus, layer_thickness, bulk_modulus with
    Poisson's ratios. tolerance: of the certificate. hardness: cap on the pressure [Pa], 0: none.

    Raises InputError naming the argument. Source: docs/theory/contact.md (Polonsky and Keer 1999 with certificates).
    """
    heights, dx, dy = map_of(z, size, "z")
    if (modulus is None) == (layer_modulus is None):
        raise wrong("modulus", "give modulus (E* of a half-space), or layer_modulus with bulk_modulus")
    if modulus is not None:
        given = [name for name, value, default in (
            ("layer_thickness", layer_thickness, 0.0), ("layer_poisson", layer_poisson, 0.5),
            ("bulk_modulus", bulk_modulus, None), ("bulk_poisson", bulk_poisson, 0.5))
            if value is not default and not (isinstance(value, (int, float)) and value == default)]
        if given:
            raise wrong(given[0], "is of layer_modulus, a layer on a half-space; modulus is of all of it")
        e = v.positive(modulus, "Pa", "modulus")
        solid = [e, 0.0, 0.0, e, 0.0]
    else:
        if bulk_modulus is None or layer_modulus is None:
            raise wrong("bulk_modulus", "a layer needs bulk_modulus too")
        solid = [v.positive(layer_modulus, "Pa", "layer_modulus"), _poisson(layer_poisson, "layer_poisson"),
                 v.positive(layer_thickness, "m", "layer_thickness"), v.positive(bulk_modulus, "Pa", "bulk_modulus"),
                 _poisson(bulk_poisson, "bulk_poisson")]
    return Contact(**_native.contact(heights, dx, dy, solid, v.si(pressure, "Pa", "pressure"),
                                     v.si(tolerance, "", "tolerance"), v.si(hardness, "Pa", "hardness")))


def _poisson(value: float, key: str) -> float:
    number = v.si(value, "", key)
    if not 0 <= number <= 0.5:
        raise wrong(key, f"{number} is outside 0 to 0.5")
    return number


@dataclass(frozen=True)
class Bridge:
    """A liquid bridge between two plates."""

    exists: bool
    reason: str
    """For people: why there is none."""
    energy: float
    """[J]"""
    force: float
    """[N], positive attracts."""
    pressure: float
    """Inside less outside [Pa]."""
    radius1: float
    """Of the contact circles [m]."""
    radius2: float
    rupture_gap: float
    """[m]; 0 where it is not known."""


def bridge(volume: Quantified, gap: Quantified, theta1: Quantified, theta2: Quantified,
           surface_tension: Quantified = 0.072126) -> Bridge:
    """The exact bridge of a volume [m^3] between plates at a gap [m], contact angles [rad], without gravity.

    Raises InputError naming the argument. Source: docs/theory/capillary.md.
    """
    return Bridge(**_native.bridge(v.positive(volume, "m3", "volume"), v.positive(gap, "m", "gap"),
                                   _angle(theta1, "theta1"), _angle(theta2, "theta2"),
                                   v.positive(surface_tension, "N/m", "surface_tension")))


def _angle(value: Quantified, key: str) -> float:
    number = v.si(value, "rad", key)
    if not 0 <= number <= np.pi:
        raise wrong(key, f"{number:.4g} rad is outside 0 to pi")
    return number


@dataclass(frozen=True, eq=False, repr=False)
class Droplets(v.WithArrays):
    """Sweat in a gap, settled where its energy is lowest."""

    converged: bool
    state: str
    """"dry", "discs", "film", or "flooded": more water than gap, no force."""
    x: FloatArray
    """Centres of the droplets [m], shape (droplets,)."""
    y: FloatArray
    volume: FloatArray
    """[m^3]"""
    radius: FloatArray
    """Footprints [m]."""
    height: FloatArray
    """[m]"""
    force: FloatArray
    """Of bridges [N], positive attracts."""
    place: list[str]
    """Of each droplet: "skin", "substrate", "bridge"."""
    bridged: npt.NDArray[np.uint8]
    """Shape of the gap: 1 inside a bridge or a film."""
    capillary_force: float
    """On the patch [N], positive attracts."""
    retention: float
    """Lateral hysteresis force [N]."""
    wetted_fraction: float
    bridges: int
    bridge_volume: float
    """Of the water [m^3]."""
    initial_energy: float
    """[J]"""
    final_energy: float


def droplets(gap: Map, size: Size | None = None, *, volume: Quantified, theta_skin: Quantified = "80 deg",
             theta_substrate: Quantified = "50 deg", surface_tension: Quantified = 0.072126, hysteresis: float = 0.33,
             drops_per_volume: Quantified = 100e18, first_step: Quantified = 200e-9, seed: int = 1, index: int = 0,
             threshold: bool = False) -> Droplets:
    """Droplets of sweat in a gap [m], shape (ny, nx), 0 in contact.

    volume: of the water in the patch [m^3]. theta_skin, theta_substrate: contact angles [rad]. drops_per_volume:
    droplets that a volume starts as [1/m^3]. first_step: their mobility [m]. seed, index: of their places. threshold:
    water at one pressure in place of droplets.

    Raises InputError naming the argument. Source: docs/theory/capillary.md, Eqs. capillary.4 to 10.
    """
    heights, dx, dy = map_of(gap, size, "gap")
    return Droplets(**_native.droplets(
        heights, dx, dy, v.si(volume, "m3", "volume"), v.positive(surface_tension, "N/m", "surface_tension"),
        _angle(theta_skin, "theta_skin"), _angle(theta_substrate, "theta_substrate"),
        v.si(hysteresis, "", "hysteresis"), v.positive(drops_per_volume, "1/m3", "drops_per_volume"),
        v.positive(first_step, "m", "first_step"), v.whole(seed, "seed", 0, 2**53), v.whole(index, "index", 0, 2**53),
        v.flag(threshold, "threshold")))


@dataclass(frozen=True, eq=False, repr=False)
class Field(v.WithArrays):
    """The electrostatic pull over a gap."""

    converged: bool
    reason: str
    pressure: FloatArray
    """Time mean on the skin, shape of the gap [Pa], positive attracts; of a field that failed shape (0, 0)."""
    mean_pressure: float
    """[Pa]"""
    force: float
    """On the patch [N]."""
    peak_air_field: float
    """At peak voltage [V/m]."""
    peak_oxide_field: float
    residual: float
    """Relative; 0 of the method "local"."""


def field(gap: Map, size: Size | None = None, *, voltage: Quantified, thickness: Quantified = 500e-9,
          permittivity: float = 3.9, skin_layer: Quantified = 0.0, edge_radius: Quantified = 0.0, dc: bool = False,
          method: str = "spread", surface: npt.ArrayLike | None = None) -> Field:
    """The pull of a driven electrode under a dielectric on a skin over a gap [m], shape (ny, nx).

    voltage: the peak of a sine, with dc a constant [V]. thickness, permittivity: of the dielectric. skin_layer: d/eps
    of the stratum corneum [m]. method: "local" (columns), "spread" (flux spreads in the dielectric), "full" (3-D).
    surface: heights [m] of the shape of the gap, whose dielectric follows its walls; None: flat.

    Raises InputError naming the argument. Source: docs/theory/electrostatics.md.
    """
    heights, dx, dy = map_of(gap, size, "gap")
    below = None if surface is None else v.height_map(surface, "surface")
    if below is not None and below.shape != heights.shape:
        raise wrong("surface", f"expected the shape of the gap, {heights.shape}, got {below.shape}")
    if isinstance(surface, Heights) and not np.allclose((surface.dx, surface.dy), (dx, dy), rtol=1e-6, atol=0):
        raise wrong("surface", f"expected the pixels of the gap, {dx:.4g} x {dy:.4g} m, got {surface.dx:.4g} x {surface.dy:.4g} m")
    if method not in ("local", "spread", "full"):
        raise wrong("method", f'expected "local", "spread" or "full", got {method!r}')
    return Field(**_native.field(
        heights, dx, dy, v.si(voltage, "V", "voltage"), v.si(thickness, "m", "thickness"),
        v.si(permittivity, "", "permittivity"), v.si(skin_layer, "m", "skin_layer"),
        v.si(edge_radius, "m", "edge_radius"), v.flag(dc, "dc"), getattr(_native.FieldMethod, method), below))


class _Case:
    """What cases share: the numbers of the command."""

    def __init__(self, columns: dict[str, Any]) -> None:
        self._columns = columns

    def to_dict(self) -> dict[str, Any]:
        """What the command prints with --json, number for number."""
        document: dict[str, Any] = json.loads(self._columns["json"])
        return document

    @property
    def table(self) -> str:
        """What the command prints for people."""
        text: str = self._columns["table"]
        return text


class Persson(_Case):
    """The mean field of a rough skin under voltage. Arrays of a sweep have one item per value of it.

    ``point``, ``over_voltage``, ``over_load`` and ``over_frequency`` are dicts of arrays: voltage [V], load [N],
    frequency [Hz], area_off, area_on (shares), pressure and pull [Pa], mean_gap [m], friction [N], coefficient,
    capacitance [F]; collapsed (no equilibrium below 1 GPa), breaks_down (more than its strength on the dielectric where
    the skin touches it) and yielded (the pressure is at the hardness or beyond: the numbers under voltage mean nothing)
    are arrays of bool. Where a point is collapsed or breaks down, its numbers under voltage and its capacitance are NaN.
    """

    def __init__(self, columns: dict[str, Any]) -> None:
        super().__init__(columns)
        self.rms: float = columns["rms"]
        self.slope: float = columns["slope"]
        self.contact_modulus: float = columns["contact_modulus"]
        self.collapsed: bool = columns["collapsed"]
        self.breaks_down: bool = columns["breaks_down"]
        self.yielded: bool = columns["yielded"]
        self.point: dict[str, float] = {name: column[0].item() for name, column in columns["point"].items()}
        self.over_voltage: dict[str, npt.NDArray[Any]] = columns["over_voltage"]
        self.over_load: dict[str, npt.NDArray[Any]] = columns["over_load"]
        self.over_frequency: dict[str, npt.NDArray[Any]] = columns["over_frequency"]


class Drive(_Case):
    """From the source to the force: one period of the series, and the spectrum of the friction."""

    def __init__(self, columns: dict[str, Any]) -> None:
        super().__init__(columns)
        self.period: float = columns["period"]
        self.source_voltage: FloatArray = columns["source_voltage"]
        self.current: FloatArray = columns["current"]
        self.gap_voltage: FloatArray = columns["gap_voltage"]
        self.pull: FloatArray = columns["pull"]
        self.friction: FloatArray = columns["friction"]
        self.line_frequency: FloatArray = columns["line_frequency"]
        self.line_amplitude: FloatArray = columns["line_amplitude"]
        self.mean_pull: float = columns["mean_pull"]
        self.distortion: float = columns["distortion"]

    @property
    def time(self) -> FloatArray:
        """Of each sample [s]."""
        return np.arange(len(self.friction)) * (self.period / len(self.friction))


Case = Union[Path, Mapping[str, Any]]


def _case(case: Case, values: Mapping[str, Any] | None) -> tuple[str, str, list[tuple[str, str]]]:
    if isinstance(case, Mapping):
        given = {key: value for key, value in case.items() if key != "schema_version"}
        return "", "schema_version = 1\n", v.settings(given) + v.settings(values)
    return v.path(case, "case"), "", v.settings(values)


def persson(case: Case, values: Mapping[str, Any] | None = None) -> Persson:
    """The mean field of a rough layered skin on a driven dielectric: statistical, without a texture.

    case: a file, or its keys as a dict (docs/reference/persson.md); values: that replace its own. Milliseconds per
    point. Raises InputError. Source: docs/theory/persson.md.
    """
    return Persson(_native.persson(*_case(case, values)))


def drive(case: Case, values: Mapping[str, Any] | None = None) -> Drive:
    """From a source through impedances to the force on a finger, over time and frequency.

    case: a file, or its keys as a dict (docs/reference/circuit.md); values: that replace its own. Raises InputError.
    Source: docs/theory/drive.md.
    """
    return Drive(_native.drive(*_case(case, values)))


def haze(z: Map, size: Size | None = None, *, index: float = 1.46, fill_index: float = 1.0,
         angles: Sequence[Quantified] = (0.0,)) -> Look:
    """How a periodic map of heights looks on glass, as a thin phase screen; of a design: ``Design.look``.

    index: of the glass. fill_index: of what fills the texture, 1: air. angles: of the light from the normal [rad],
    up to 70 degrees; the answer is their mean. Raises InputError. Source: docs/theory/optics.md.
    """
    heights, dx, dy = map_of(z, size, "z")
    return Look(**_native.look(heights, dx, dy, v.si(index, "", "index"), v.si(fill_index, "", "fill_index"),
                               [_angle(angle, "angles") for angle in v.items(angles, "angles")]))
