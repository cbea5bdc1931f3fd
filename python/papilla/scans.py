"""Measured maps: read as every command takes them, and what they are in the words of ISO 25178-2."""

from __future__ import annotations

import html
import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from papilla import _native, pictures, values as v
from papilla.design import Design, Heights
from papilla.physics import Map, Size, map_of
from papilla.response import as_array
from papilla.values import FloatArray, Path, Quantified

__all__ = ["Scan", "Spectrum", "read_scan", "roughness", "spectrum"]


@dataclass(frozen=True, eq=False, repr=False)
class Spectrum(v.WithArrays):
    """The radially averaged power spectrum of a map, of its heights tapered by a Hann window. Eq. geometry.6."""

    wavelength: FloatArray
    """[m], rings a tenth of a decade wide, from the length of the map to two pixels."""
    density: FloatArray
    """[m^4]: the variance of the heights is the sum of density times (2 pi)^2 / area over the wave numbers."""
    longest: float
    """[m]; longer waves are fewer than four across the map: their power is not known."""
    shortest: float
    """[m]; shorter ones the pixels, or the instrument's tip, do not show (Eq. geometry.7)."""
    by_tip: bool
    """Whether the tip ends the band before the pixels do."""

    @property
    def known(self) -> npt.NDArray[np.bool_]:
        """True where the wavelength lies in the band that the map can know."""
        inside: npt.NDArray[np.bool_] = (self.wavelength <= self.longest * (1 + 1e-9)) & (self.wavelength >= self.shortest * (1 - 1e-9))
        return inside


class Scan:
    """A map from an instrument, as every command takes it: levelled, mended. Made by ``papilla.read_scan``."""

    heights: Heights
    changes: str
    """What was changed of the file's map, for people."""
    roughness: Mapping[str, float | None]
    """ISO 25178-2: Sa, Sq, Sz, ... [m], Ssk, Sku, Sdq, Sdr, Sal [m], Str, Std [rad], Sk, Spk, Svk [m]; None: not known."""
    spectrum: Spectrum

    def __init__(self, heights: Heights, changes: str, document: str) -> None:
        told = json.loads(document)
        self.heights, self.changes, self._document = heights, changes, document
        self.roughness = told["areal"]
        self.spectrum = Spectrum(as_array([ring["wavelength"] for ring in told["spectrum"]]),
                                 as_array([ring["density"] for ring in told["spectrum"]]), **told["band"])

    def design(self, values: Mapping[str, Any] | None = None) -> Design:
        """The map as a texture, made periodic as scans are (docs/how_to/scans.md); values: all other keys. Raises
        InputError for a map that is not square."""
        return Design.from_heights(self.heights.z, self.heights.size[0], values, repeats=False)

    def to_dict(self) -> dict[str, Any]:
        """What ``papilla surface --json`` prints."""
        document: dict[str, Any] = json.loads(self._document)
        return document

    def __reduce__(self) -> tuple[Any, ...]:
        return Scan, (self.heights, self.changes, self._document)

    def __repr__(self) -> str:
        return f"<papilla.Scan {self.heights!r}, Sq {1e9 * (self.roughness['Sq'] or 0):.4g} nm>"

    def _repr_html_(self) -> str:
        return f"<p>{html.escape(self.changes)}</p>" + pictures.image(self.heights.z)


def read_scan(file: Path, size: Quantified = 0.0, *, fill: bool = False, as_is: bool = False, tip: Quantified = 0.0) -> Scan:
    """A map from an instrument: .npy .gsf .exr .tif .x3p and what ``papilla surface`` reads.

    size: width of the map, where the file does not say. fill: heights that are no numbers get those around them; else they
    are refused. as_is: neither levelled nor mended. tip: radius of the instrument's tip, for the band that it knows.
    Raises InputError.
    """
    heights, changes, document = _native.read_scan(v.path(file, "file"), v.si(size, "m", "size"), v.flag(fill, "fill"),
                                                   v.flag(as_is, "as_is"), v.si(tip, "m", "tip"))
    return Scan(Heights(heights.z, heights.dx, heights.dy), changes, document)


def roughness(z: Map, size: Size | None = None) -> Mapping[str, float | None]:
    """ISO 25178-2 of a map as it is, about its mean: as ``Scan.roughness``. z: heights [m], shape (ny, nx), or Heights;
    size: width, or width and height. Raises InputError."""
    return _measured(z, size, 0.0).roughness


def spectrum(z: Map, size: Size | None = None, *, tip: Quantified = 0.0) -> Spectrum:
    """The power spectrum of a map as it is, and the band that it can know. z, size: as of ``roughness``; tip: as of
    ``read_scan``. Raises InputError."""
    return _measured(z, size, tip).spectrum


def _measured(z: Map, size: Size | None, tip: Quantified) -> Scan:
    heights, changes, document = _native.measured(*map_of(z, size, "z"), v.si(tip, "m", "tip"))
    return Scan(Heights(heights.z, heights.dx, heights.dy), changes, document)
