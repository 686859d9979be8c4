"""The laws of the warp that RGL's files are stored through."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from halfway.formats.rgl_warp import Warp, slices

densities = st.integers(0, 2**32 - 1).map(
    lambda seed: np.random.default_rng(seed).uniform(0.01, 1, (2, 5, 6)) ** 3
)
unit = st.floats(0.001, 0.999)


@settings(max_examples=50)
@given(densities, unit, unit, st.integers(0, 1))
def test_invert_undoes_sample(values, s_theta, s_phi, i):
    warp = Warp.of(values)
    s = np.array([s_theta]), np.array([s_phi])
    where = slices((np.arange(2.0),), (np.array([float(i)]),))
    assert_allclose(warp.invert(*warp.sample(*s, i), where), s, atol=1e-9)


@settings(max_examples=20)
@given(densities, st.floats(0, 1))
def test_the_warp_is_onto_the_unit_square(values, p):
    corners = np.array([0.0, 0, 1, 1]), np.array([0.0, 1, 0, 1])
    where = slices((np.arange(2.0),), (np.full(4, p),))
    assert_allclose(Warp.of(values).invert(*corners, where), corners, atol=1e-12)


def test_the_warp_follows_the_density():
    """The area that maps to a patch is the integral of the density over it."""
    values = np.random.default_rng(7).uniform(0.1, 1, (1, 3, 3))
    warp = Warp.of(values)
    # The image of the quarter u_theta, u_phi < 1/2: s_theta at its right edge, integrated over s_phi.
    rows = np.linspace(0, 0.5, 2001)
    s_theta, s_phi = warp.invert(
        np.full(2001, 0.5), rows, slices((np.zeros(1),), (np.zeros(2001),))
    )
    area = np.trapezoid(s_theta, s_phi)
    v = values[0] / (values[0] @ [0.25, 0.5, 0.25] @ [0.25, 0.5, 0.25])
    assert_allclose(area, v[:2, :2].mean() / 4, rtol=1e-6)


def test_a_row_of_zeros_does_not_break_the_warp():
    values = np.ones((1, 4, 4))
    values[:, 1:3] = 0
    s_theta, s_phi = Warp.of(values).invert(
        np.array([0.5]), np.array([0.5]), slices((np.zeros(1),), (np.zeros(1),))
    )
    assert (s_theta, s_phi) == (0, 0.5)
