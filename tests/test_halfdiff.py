"""Angles and grids: cases worked by hand, then the laws."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from strategies import TINY, directions

from halfway.halfdiff import MERL, Axis, Grid, HalfDiff, cosines, from_half_diff, to_half_diff

UP = np.array([0.0, 0.0, 1.0])
S = np.sqrt(0.5)


@pytest.mark.parametrize(
    ("wi", "wo", "degrees"),
    [
        pytest.param([0, 0, 1], [0, 0, 1], (0, 0, 0, 0), id="both-along-the-normal"),
        pytest.param([S, 0, S], [-S, 0, S], (0, 0, 45, 0), id="mirror-reflection"),
        pytest.param([S, 0, S], [S, 0, S], (45, 0, 0, 0), id="retroreflection"),
        pytest.param([0, S, S], [0, S, S], (45, 90, 0, 0), id="retroreflection-turned"),
        pytest.param([0, S, S], [0, -S, S], (0, 0, 45, 90), id="mirror-reflection-turned"),
        pytest.param([1, 0, 0], [0, 0, 1], (45, 0, 45, 0), id="grazing-light-viewed-from-above"),
        pytest.param([0, 0, 1], [1, 0, 0], (45, 0, 45, 180), id="light-from-above-viewed-grazing"),
    ],
)
def test_known_angles(wi, wo, degrees):
    angles = to_half_diff(np.array(wi, float), np.array(wo, float))
    # phi_h and phi_d are not defined where their theta is 0: compare the points on the sphere.
    for theta, phi, want_theta, want_phi in (
        (angles.theta_h, angles.phi_h, *np.radians(degrees[:2])),
        (angles.theta_d, angles.phi_d, *np.radians(degrees[2:])),
    ):
        assert_allclose(theta, want_theta, atol=1e-12)
        assert_allclose(
            np.sin(theta) * np.exp(1j * phi), np.sin(want_theta) * np.exp(1j * want_phi), atol=1e-12
        )


@given(directions(), directions())
def test_angles_and_directions_are_inverse(wi, wo):
    back_i, back_o = from_half_diff(to_half_diff(wi, wo))
    assert_allclose(back_i, wi, atol=1e-12)
    assert_allclose(back_o, wo, atol=1e-12)


@given(directions(), directions())
def test_swapping_light_and_viewer_turns_phi_d_by_pi(wi, wo):
    """Helmholtz reciprocity, in these coordinates, is a half turn of phi_d."""
    a, b = to_half_diff(wi, wo), to_half_diff(wo, wi)
    assert_allclose([a.theta_h, a.theta_d], [b.theta_h, b.theta_d], atol=1e-12)
    assert_allclose(
        np.sin(a.theta_d) * np.exp(1j * a.phi_d),
        -np.sin(b.theta_d) * np.exp(1j * b.phi_d),
        atol=1e-12,
    )


@given(directions(), directions(), st.floats(-3, 3))
def test_turning_the_surface_changes_phi_h_alone(wi, wo, turn):
    c, s = np.cos(turn), np.sin(turn)
    rotation = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    a, b = to_half_diff(wi, wo), to_half_diff(rotation @ wi, rotation @ wo)
    assert_allclose([a.theta_h, a.theta_d], [b.theta_h, b.theta_d], atol=1e-12)
    # Near theta_h = 0 the azimuth of h, and so of d, is any.
    if a.theta_h > 1e-3 and a.theta_d > 1e-3:
        assert_allclose(np.exp(1j * a.phi_d), np.exp(1j * b.phi_d), atol=1e-9)


@given(directions(), directions())
def test_cosines_are_the_z_of_the_directions(wi, wo):
    angles = to_half_diff(wi, wo)
    assert_allclose(
        cosines(angles.theta_h, angles.theta_d, angles.phi_d), [wi[2], wo[2]], atol=1e-12
    )


def test_the_first_theta_h_bins_are_resolved():
    """The first cell is 0.011 degrees wide; an arccos in float32 would see nothing of it."""
    tilt = np.radians(0.005)
    h = np.array([np.sin(tilt), 0, np.cos(tilt)], np.float32)
    assert_allclose(to_half_diff(h, h).theta_h, tilt, rtol=1e-6)


@pytest.mark.parametrize(
    ("angle", "position"),
    [(0.0, 0.0), (90.0, 90.0), (22.5, 45.0), (90 / 4, 45.0), (90 / 9, 30.0)],
)
def test_theta_h_is_square_root_spaced(angle, position):
    assert_allclose(MERL.axes[0].to_position(np.radians(angle)), position, rtol=1e-12)


@pytest.mark.parametrize(
    ("angle", "position"), [(0, 0), (90, 90), (180, 0), (-90, 90), (-45, 135), (270, 90)]
)
def test_phi_d_has_period_pi(angle, position):
    assert_allclose(MERL.axes[2].to_position(np.radians(angle)) % 180, position, atol=1e-9)


def test_a_tiny_negative_phi_d_stays_on_the_grid():
    position = MERL.axes[2].to_position(np.array(-1e-17))
    assert 0 <= position < 180


@pytest.mark.parametrize("axis", MERL.axes, ids=lambda axis: axis.angle)
def test_cell_centres_stand_half_way_between_positions(axis):
    assert_allclose(axis.to_position(axis.centres()), np.arange(axis.size) + 0.5, atol=1e-9)


def test_a_quarter_of_the_merl_grid_is_below_the_horizon():
    """1,096,216 of 1,458,000 cells have both directions above it."""
    assert MERL.mask().sum() == 1_096_216


def test_the_mask_is_where_both_directions_are_above_the_horizon():
    wi, wo = TINY.directions()
    np.testing.assert_array_equal(TINY.mask(), (wi[..., 2] > 0) & (wo[..., 2] > 0))


def test_centres_fall_into_their_own_cells():
    wi, wo = TINY.directions()
    assert_allclose(TINY.floor(wi, wo).cells[0].ravel(), np.arange(TINY.size))


def test_at_a_centre_one_corner_carries_all_weight():
    cells, weights = TINY.multilinear(*TINY.directions())
    best = weights.argmax(axis=0)
    assert_allclose(np.take_along_axis(weights, best[None], 0)[0], 1, atol=1e-9)
    found = np.take_along_axis(cells, best[None], 0)[0]
    np.testing.assert_array_equal(found.ravel(), np.arange(TINY.size))


@given(directions(), directions())
def test_corner_weights_are_convex(wi, wo):
    _, weights = TINY.multilinear(wi, wo)
    assert weights.shape == (8,)
    assert weights.min() >= -1e-12
    assert_allclose(weights.sum(), 1, atol=1e-12)


def test_a_grid_with_another_axis_needs_no_other_code():
    """Anisotropic materials depend on phi_h too."""
    grid = Grid((*TINY.axes, Axis("phi_h", 6, 2 * np.pi, periodic=True)))
    wi, wo = grid.directions()
    assert wi.shape == (3, 4, 5, 6, 3)
    assert_allclose(grid.floor(wi, wo).cells[0].ravel(), np.arange(grid.size))
    assert grid.multilinear(wi, wo).cells.shape == (16, 3, 4, 5, 6)


def test_half_diff_of_open_axes_broadcasts():
    angles = HalfDiff(*(np.zeros(shape) for shape in ((2, 1), (1, 1), (1, 3), (1, 1))))
    wi, wo = from_half_diff(angles)
    assert wi.shape == wo.shape == (2, 3, 3)
    assert_allclose(wi, np.broadcast_to(UP, wi.shape))
