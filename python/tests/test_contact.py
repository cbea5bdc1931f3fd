"""Contact beside a second method: Polonsky and Keer's conjugate gradients, written here in numpy."""

from __future__ import annotations

import numpy as np
import pytest

import papilla as pp
from reference_contact import beside


@pytest.mark.parametrize("load", [2e-3, 2e-2, 0.2])
def test_pressures_are_those_of_polonsky_and_keer(load: float) -> None:
    b = beside(128, load)
    assert b.mine.converged
    assert b.mine.pressure.mean() == pytest.approx(b.theirs.mean(), rel=1e-9)
    assert b.difference < 1e-4
    assert (b.mine.gap[b.theirs > 1e-3 * b.theirs.max()] < 1e-12).all()
    assert 0 < b.seconds_mine < b.seconds_theirs


def test_a_layer_as_stiff_as_the_bulk_is_a_half_space() -> None:
    x = np.arange(64) / 64
    z = 20e-9 * np.add.outer(np.cos(2 * np.pi * x), np.cos(2 * np.pi * x))
    young, poisson = 3e6, 0.4
    whole = pp.contact(z, "2 um", pressure="10 kPa", modulus=young / (1 - poisson**2))
    layered = pp.contact(z, "2 um", pressure="10 kPa", layer_modulus=young, layer_poisson=poisson,
                         layer_thickness="1 um", bulk_modulus=young, bulk_poisson=poisson)
    assert np.abs(whole.pressure - layered.pressure).max() < 1e-6 * whole.pressure.max()
