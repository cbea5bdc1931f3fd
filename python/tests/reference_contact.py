"""Polonsky and Keer (1999), periodic by FFT: a plain solver in numpy to hold the library against."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


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
