"""Polonsky and Keer (1999), periodic by FFT: a plain solver in numpy to hold the library against.

    PYTHONPATH=build/release/python python3 python/tests/reference_contact.py

prints pressures and seconds of both on the same maps.
"""

from __future__ import annotations

import time
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import papilla as pp

SIZE, MODULUS = 5e-6, 50e6  # of the map [m] and E* [Pa]


def polonsky_keer(z: NDArray[np.float64], pixel: float, modulus: float, mean: float,
                  tolerance: float = 1e-8, most: int = 5000) -> NDArray[np.float64]:
    """Pressure [Pa] of a rigid surface z [m] on a half-space of contact modulus E* [Pa] under a mean pressure."""
    ny, nx = z.shape
    q = 2 * np.pi * np.hypot(*np.meshgrid(np.fft.fftfreq(nx, pixel), np.fft.fftfreq(ny, pixel)))
    compliance = np.zeros_like(q)
    compliance[q > 0] = 2 / (modulus * q[q > 0])

    def displaced(p: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.fft.ifft2(compliance * np.fft.fft2(p)).real

    p = np.full_like(z, mean)
    t = np.zeros_like(z)
    delta, old = 0.0, 1.0
    for _ in range(most):
        gap = displaced(p) - z
        touching = p > 0
        gap -= gap[touching].mean()
        error = np.sum(p * np.abs(gap)) / (mean * p.size * (z.max() - z.min()))
        now = np.sum(gap[touching] ** 2)
        t = np.where(touching, gap + delta * now / old * t, 0)
        old = now
        r = displaced(t)
        r -= r[touching].mean()
        step = np.sum(gap[touching] * t[touching]) / np.sum(r[touching] * t[touching])
        p = np.where(touching, p - step * t, p).clip(min=0)
        overlap = (p == 0) & (gap < 0)
        delta = 0.0 if overlap.any() else 1.0
        p[overlap] -= step * gap[overlap]
        p *= mean / p.mean()
        if error < tolerance:
            return p
    raise RuntimeError("not converged")


def rough_map(n: int) -> NDArray[np.float64]:
    """Heights [m] of a rough surface without waves shorter than five pixels of 128, rms 30 nm."""
    q = np.hypot(*np.meshgrid(np.fft.fftfreq(n, 128 / n), np.fft.fftfreq(n, 128 / n)))
    spectrum = np.where((q > 0) & (q < 0.2), np.maximum(q, 0.03) ** -1.8, 0)
    z = np.fft.ifft2(spectrum * np.fft.fft2(np.random.default_rng(3).standard_normal((n, n)))).real
    return np.asarray(z * (30e-9 / z.std()))


class Beside(NamedTuple):
    """The library and the plain solver on one map under one load; `load` is p / (E* h'rms)."""

    n: int
    load: float
    mine: pp.Contact
    theirs: NDArray[np.float64]
    seconds_mine: float
    seconds_theirs: float

    @property
    def difference(self) -> float:
        """Largest difference of two pressures over the largest pressure."""
        return float(np.abs(self.mine.pressure - self.theirs).max() / self.theirs.max())


def beside(n: int, load: float) -> Beside:
    z = rough_map(n)
    mean = load * MODULUS * float(np.hypot(*np.gradient(z, SIZE / n)).std())
    begin = time.perf_counter()
    mine = pp.contact(z, SIZE, pressure=mean, modulus=MODULUS, tolerance=1e-10)
    middle = time.perf_counter()
    theirs = polonsky_keer(z, SIZE / n, MODULUS, mean, tolerance=1e-9)
    return Beside(n, load, mine, theirs, middle - begin, time.perf_counter() - middle)


def main() -> None:
    print("| pixels | p / (E* h'rms) | contact area | largest pressure | difference | papilla | numpy |")
    print("|---|---|---|---|---|---|---|")
    for n in (128, 256, 512):
        for load in (2e-3, 2e-2, 0.2):
            b = beside(n, load)
            print(f"| {n}² | {load:g} | {np.mean(b.theirs > 0):.2%} | {b.theirs.max() / 1e6:.3g} MPa | {b.difference:.1e} "
                  f"| {b.seconds_mine:.3f} s | {b.seconds_theirs:.3f} s |")


if __name__ == "__main__":
    main()
