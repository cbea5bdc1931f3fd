"""Contact beside a second method: Polonsky and Keer's conjugate gradients, written here in numpy."""

from __future__ import annotations

import numpy as np
import pytest

import papilla as pp
from reference_contact import polonsky_keer


@pytest.mark.parametrize("load", [2e-3, 2e-2, 0.2])
def test_pressures_are_those_of_polonsky_and_keer(load: float) -> None:
    n, size, modulus = 128, 5e-6, 50e6
    r = np.random.default_rng(3)
    q = np.hypot(*np.meshgrid(np.fft.fftfreq(n), np.fft.fftfreq(n)))
    spectrum = np.where((q > 0) & (q < 0.2), np.maximum(q, 0.03) ** -1.8, 0)
    z = np.fft.ifft2(spectrum * np.fft.fft2(r.standard_normal((n, n)))).real
    z *= 30e-9 / z.std()
    mean = load * modulus * np.hypot(*np.gradient(z, size / n)).std()
    mine = pp.contact(z, size, pressure=mean, modulus=modulus, tolerance=1e-10)
    theirs = polonsky_keer(z, size / n, modulus, mean, tolerance=1e-9)
    assert mine.converged
    assert mine.pressure.mean() == pytest.approx(mean, rel=1e-9)
    assert np.abs(mine.pressure - theirs).max() < 1e-4 * theirs.max()
    assert (mine.gap[theirs > 1e-3 * theirs.max()] < 1e-12).all()


def test_a_layer_as_stiff_as_the_bulk_is_a_half_space() -> None:
    x = np.arange(64) / 64
    z = 20e-9 * np.add.outer(np.cos(2 * np.pi * x), np.cos(2 * np.pi * x))
    young, poisson = 3e6, 0.4
    whole = pp.contact(z, "2 um", pressure="10 kPa", modulus=young / (1 - poisson**2))
    layered = pp.contact(z, "2 um", pressure="10 kPa", layer_modulus=young, layer_poisson=poisson,
                         layer_thickness="1 um", bulk_modulus=young, bulk_poisson=poisson)
    assert np.abs(whole.pressure - layered.pressure).max() < 1e-6 * whole.pressure.max()
