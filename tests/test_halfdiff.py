"""Angles and grids: cases worked by hand, then the laws."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from strategies import TINY, directions

from halfway.errors import FormatError
from halfway.halfdiff import MERL, Grid, HalfDiff, cosines, from_half_diff, to_half_diff

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


ANISOTROPIC = Grid.anisotropic(3, 6, 4, 5)
HALF_TURN = Grid.anisotropic(3, 6, 4, 5, period=np.pi)


@pytest.mark.parametrize("grid", [ANISOTROPIC, HALF_TURN], ids=["whole-turn", "half-turn"])
def test_a_grid_with_another_axis_needs_no_other_code(grid):
    """Anisotropic materials depend on phi_h too."""
    wi, wo = grid.directions()
    assert wi.shape == (3, 6, 4, 5, 3)
    assert_allclose(grid.floor(wi, wo).cells[0].ravel(), np.arange(grid.size))
    assert grid.multilinear(wi, wo).cells.shape == (16, 3, 6, 4, 5)
    assert_allclose(grid.solid_angles().sum(), 8 * np.pi**2)
    np.testing.assert_array_equal(grid.mask(), TINY.mask()[:, None].repeat(6, axis=1))


def _placed(corners):
    """What each cell counts, shape (n_cells,)."""
    return np.bincount(corners.cells, corners.weights, minlength=ANISOTROPIC.size)


def _turn(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


@given(directions(), directions(), st.integers(1, 5))
def test_turning_by_cells_of_phi_h_moves_a_lookup_by_as_many(wi, wo, n):
    turn = _turn(n * 2 * np.pi / 6)
    assume(min(np.linalg.norm(wi[:2] + wo[:2]), np.linalg.norm(wi - wo)) > 1e-6)
    still, turned = (
        _placed(ANISOTROPIC.multilinear(r @ wi, r @ wo)).reshape(ANISOTROPIC.shape)
        for r in (np.eye(3), turn)
    )
    assert_allclose(np.roll(still, n, axis=1), turned, atol=1e-6)


@given(directions(), directions())
def test_swapping_light_and_viewer_looks_up_the_same_cells(wi, wo):
    """phi_d + pi is phi_d, and phi_h stays: reciprocity costs no cell twice."""
    assume(np.linalg.norm(wi - wo) > 1e-6)
    assert_allclose(
        _placed(ANISOTROPIC.multilinear(wi, wo)),
        _placed(ANISOTROPIC.multilinear(wo, wi)),
        atol=1e-6,
    )


@given(directions(), directions())
def test_after_its_period_a_grid_looks_up_the_same_cells(wi, wo):
    assume(min(np.linalg.norm(wi[:2] + wo[:2]), np.linalg.norm(wi - wo)) > 1e-6)
    still, turned = (
        _placed(HALF_TURN.multilinear(r @ wi, r @ wo)) for r in (np.eye(3), _turn(np.pi))
    )
    assert_allclose(still, turned, atol=1e-6)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: Grid.merl(3, 0, 5), "a grid of 3 x 0 x 5 cells is none: expected whole numbers"),
        (lambda: Grid.anisotropic(3, 6, -4, 5), "a grid of 3 x 6 x -4 x 5 cells is none"),
        (lambda: Grid.anisotropic(period=5.0), "same after a turn of 5 about its normal is none"),
        (lambda: Grid.anisotropic(period=0.0), "same after a turn of 0 about its normal is none"),
    ],
)
def test_a_grid_without_cells_or_turns_is_none(make, said):
    with pytest.raises(FormatError, match=said):
        make()


def test_half_diff_of_open_axes_broadcasts():
    angles = HalfDiff(*(np.zeros(shape) for shape in ((2, 1), (1, 1), (1, 3), (1, 1))))
    wi, wo = from_half_diff(angles)
    assert wi.shape == wo.shape == (2, 3, 3)
    assert_allclose(wi, np.broadcast_to(UP, wi.shape))
