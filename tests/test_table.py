"""Tables: interpolation, unmeasured samples, albedo."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from scipy.interpolate import RegularGridInterpolator
from strategies import TINY, directions, random_tables

from halfway import TabularBrdf, directional_albedo, open_library, tabulate
from halfway.errors import FormatError
from halfway.halfdiff import Grid, from_half_diff, to_half_diff

GRID = Grid.merl(6, 5, 8)
TABLE = random_tables(1, GRID)["material-0"]


def constant(value: float, grid: Grid = GRID) -> TabularBrdf:
    return TabularBrdf(np.full((3, *grid.shape), value, np.float32), grid, name="constant")


def random_pairs(n: int, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    v = rng.normal(size=(2, n, 3))
    v[..., 2] = np.abs(v[..., 2])
    return tuple(v / np.linalg.norm(v, axis=-1, keepdims=True))


def test_evaluation_at_a_centre_is_the_sample():
    wi, wo = GRID.directions()
    expected = np.where(GRID.mask(), TABLE.values, 0)
    for interpolation in ("trilinear", "floor"):
        found = np.moveaxis(TABLE.eval(wi, wo, interpolation=interpolation), -1, 0)
        assert_allclose(found, expected, rtol=1e-6, atol=1e-9)


def test_trilinear_agrees_with_scipy():
    """Against an interpolator that we did not write, on a table padded by the rules: clamp, clamp, wrap."""
    values = np.random.default_rng(2).random((3, *GRID.shape)).astype(np.float32)
    padded = np.pad(values, ((0, 0), (1, 1), (1, 1), (0, 0)), mode="edge")
    padded = np.pad(padded, ((0, 0), (0, 0), (0, 0), (1, 1)), mode="wrap")
    nodes = [np.arange(-1, n + 1) + 0.5 for n in GRID.shape]
    reference = RegularGridInterpolator(nodes, np.moveaxis(padded, 0, -1))
    wi, wo = random_pairs(200)
    angles = to_half_diff(wi, wo)
    positions = np.stack(
        [axis.to_position(getattr(angles, axis.angle)) for axis in GRID.axes], axis=-1
    )
    assert_allclose(TabularBrdf(values, GRID).eval(wi, wo), reference(positions), rtol=1e-6)


def test_an_unmeasured_sample_never_blends_in():
    """A table of 1s with holes is 1 wherever anything around is measured."""
    values = np.ones((3, *GRID.shape), np.float32)
    values[:, np.random.default_rng(3).random(GRID.shape) < 0.8] = np.nan
    found = TabularBrdf(values, GRID).eval(*random_pairs(500))
    assert np.isnan(found).any()
    assert_allclose(found[~np.isnan(found)], 1, rtol=1e-12)


def test_nothing_measured_around_is_nan():
    assert np.isnan(constant(np.nan).eval(*random_pairs(3))).all()


def test_below_the_horizon_is_zero():
    up, down = np.array([0.0, 0, 1]), np.array([0.6, 0, -0.8])
    assert_allclose(constant(1).eval(np.stack([up, down]), np.stack([down, up])), 0)


@given(directions(), directions())
def test_tables_are_reciprocal(wi, wo):
    # Nearer than rounding the difference has no direction, and phi_d no value.
    assume(np.linalg.norm(wi - wo) > 1e-9)
    assert_allclose(TABLE.eval(wi, wo), TABLE.eval(wo, wi), rtol=1e-6, atol=1e-9)


@given(directions(), directions())
def test_a_pair_and_its_reverse_fall_into_one_cell(wi, wo):
    """Inside a cell: on a border, rounding decides between two."""
    angles = to_half_diff(wi, wo)
    positions = np.array([axis.to_position(getattr(angles, axis.angle)) for axis in GRID.axes])
    assume((np.abs(positions - np.round(positions)) > 1e-6).all())
    there, back = (TABLE.eval(*pair, interpolation="floor") for pair in ((wi, wo), (wo, wi)))
    assert_array_equal(there, back)


def test_batches_of_any_shape():
    wi, wo = (v.reshape(2, 3, 5, 3) for v in random_pairs(30))
    assert TABLE.eval(wi, wo).shape == (2, 3, 5, 3)
    assert TABLE.eval(wi[0, 0, 0], wo[0, 0, 0]).shape == (3,)
    assert TABLE.eval(wi[0, 0, 0], wo).shape == (2, 3, 5, 3)


def test_a_table_of_the_wrong_shape_is_refused():
    with pytest.raises(
        FormatError, match=r"has shape \(3, 3, 4, 5\): a 6 x 5 x 8 grid takes \(3, 6, 5, 8\)"
    ):
        TabularBrdf(np.zeros((3, *TINY.shape), np.float32), GRID)


def test_a_table_cannot_be_changed():
    with pytest.raises(ValueError, match="read-only"):
        TABLE.values[0, 0, 0, 0] = 1


def test_tabulating_a_table_on_its_grid_is_the_table():
    np.testing.assert_array_equal(tabulate(TABLE, GRID).values, TABLE.values)


@pytest.mark.parametrize("degrees", [0, 30, 60, 85])
def test_a_white_diffuse_surface_reflects_everything(degrees):
    """Constant: the midpoint rule's nodes alone, good to 1e-4."""
    assert_allclose(directional_albedo(constant(1 / np.pi), np.radians(degrees)), 1, rtol=1e-4)


def test_albedo_of_a_lobe_with_a_closed_form():
    """With f = 1 where theta_h is below a, else 0: seen along the normal, theta_o runs to 2 a, and the albedo is pi sin^2(2a)."""
    a = np.radians(25)

    def lobe(wi, wo):
        h = wi + wo
        inside = h[..., 2] / np.linalg.norm(h, axis=-1) > np.cos(a)
        return np.repeat(np.where(inside, 1.0, 0.0)[..., None], 3, axis=-1)

    # The edge of the lobe is known to one node of theta_h, about a quarter of a degree.
    assert_allclose(directional_albedo(lobe, 0.0), np.pi * np.sin(2 * a) ** 2, rtol=0.02)


@given(st.floats(0, 85), st.floats(0.01, 10))
def test_albedo_is_linear_in_the_table(degrees, factor):
    theta = np.radians(degrees)
    scaled = TabularBrdf(TABLE.values * np.float32(factor), GRID)
    few = {"n_theta_h": 12, "n_phi_h": 8}
    assert_allclose(
        directional_albedo(scaled, theta, **few),
        np.float32(factor) * directional_albedo(TABLE, theta, **few),
        rtol=1e-5,
    )


def test_floor_and_trilinear_agree_in_the_mean():
    """A sample at its cell's centre: no half-bin bias. The albedos differ by less than 1 % of the light.

    Near a mirror's peak, a few cells wide, the mean of a straight line through convex samples is above their own: up to
    1.5 % of the albedo itself (steel), .3 % of the light. Half a cell of bias would be ten times that.
    """
    library = open_library("builtin:merl-abc")
    for name in library.names[::7]:
        table = library.brdf(name)
        for degrees in (10, 45, 74):
            a, b = (
                directional_albedo(
                    lambda wi, wo, t=table, i=i: t.eval(wi, wo, interpolation=i),
                    np.radians(degrees),
                    n_phi_h=36,
                )
                for i in ("trilinear", "floor")
            )
            assert_allclose(a, b, atol=0.003, rtol=0.016, err_msg=f"{name} at {degrees} degrees")


def test_from_half_diff_centres_are_the_grids_directions():
    for each, expected in zip(from_half_diff(GRID.centres()), GRID.directions(), strict=True):
        assert_allclose(np.broadcast_to(each, (*GRID.shape, 3)), expected)
