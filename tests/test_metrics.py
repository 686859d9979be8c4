"""Differences of tables and of pictures."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from skimage import color

from halfway.brdf import TabularBrdf
from halfway.brdf.metrics import MAPPINGS, difference
from halfway.errors import FormatError
from halfway.halfdiff import Axis, Grid, cosines
from halfway.look import flip
from halfway.look.appearance import (
    SHOULDER,
    appearance,
    ciede2000,
    ciede2000_difference,
    cielab_difference,
    shown,
    to_lab,
)

GRID = Grid.merl(6, 5, 8)
numbers = st.integers(0, 2**32 - 1).map(np.random.default_rng)


ALL = [*MAPPINGS, "relative"]


def table(values: np.ndarray | float, grid: Grid = GRID) -> TabularBrdf:
    """A table with these values where both directions are above the horizon."""
    samples = np.broadcast_to(values, (3, *grid.shape)).astype(np.float32)
    return TabularBrdf(np.where(grid.mask(), samples, np.float32(np.nan)), grid, name="table")


def test_solid_angles_of_all_pairs_of_directions():
    """A hemisphere of h times one of d, 4 cos(theta_d) on average 2: 8 pi^2, exactly, on any grid."""
    for grid in (
        GRID,
        Grid.merl(),
        Grid(GRID.axes[:2]),
        Grid((Axis("phi_h", 3, 2 * np.pi, periodic=True), *GRID.axes)),
    ):
        assert grid.solid_angles().shape == grid.shape
        assert_allclose(grid.solid_angles().sum(), 8 * np.pi**2)


def test_solid_angles_above_the_horizon_are_two_hemispheres():
    """(2 pi)^2, up to the cells that the horizon cuts: half a cell of 90 each way."""
    merl = Grid.merl()
    assert_allclose(merl.solid_angles()[merl.mask()].sum(), 4 * np.pi**2, rtol=1 / 180)


def test_solid_angles_integrate_a_function_of_both_directions():
    """The integral of cos_i cos_o over two hemispheres is pi^2."""
    merl = Grid.merl()
    angles = merl.centres()
    cos_i, cos_o = cosines(angles.theta_h, angles.theta_d, angles.phi_d)
    integral = (merl.solid_angles() * cos_i * cos_o)[merl.mask()].sum()
    assert_allclose(integral, np.pi**2, rtol=1e-3)


def test_one_cell_by_hand():
    """Four cells, one of them different: sqrt(its share of the solid angle) x the difference of the mapped values."""
    grid = Grid(
        (Axis("theta_h", 2, 0.6), Axis("theta_d", 2, 0.8), Axis("phi_d", 1, np.pi, periodic=True))
    )
    values = np.full((3, *grid.shape), 0.5)
    values[:, 1, 0, 0] = 2.0
    bands_h = [1 - np.cos(0.3), np.cos(0.3) - np.cos(0.6)]
    bands_d = [np.sin(0.4) ** 2, np.sin(0.8) ** 2 - np.sin(0.4) ** 2]
    share = bands_h[1] * bands_d[0] / (sum(bands_h) * sum(bands_d))
    cos_i = np.cos(0.45) * np.cos(0.2)  # phi_d = pi/2 at the centre: the cosines are equal
    apart = {
        "cosine": 1.5 * cos_i,
        "cube-root": (2 * cos_i) ** (1 / 3) - (0.5 * cos_i) ** (1 / 3),
        "log": np.log((1 + 2 * cos_i) / (1 + 0.5 * cos_i)),
        "log-relative": np.log((2 * cos_i**2 + 1e-3) / (0.5 * cos_i**2 + 1e-3)),
    }
    for metric, expected in apart.items():
        actual = difference(table(0.5, grid), table(values, grid), metric)
        assert_allclose(actual.below, np.sqrt(share) * expected, rtol=1e-6)
        assert np.isnan(actual.grazing)
    # |(0, 1.5, 0, 0)| / |(.5, .5, .5, .5)|
    assert_allclose(difference(table(0.5, grid), table(values, grid), "relative").below, 1.5)


@pytest.mark.parametrize("metric", ALL)
def test_a_table_does_not_differ_from_itself(metric):
    f = table(np.random.default_rng(1).gamma(0.5, size=(3, *GRID.shape)))
    assert difference(f, f, metric) == (0, 0)


@pytest.mark.parametrize("metric", MAPPINGS)
@given(numbers)
def test_differences_are_distances(metric: str, rng: np.random.Generator):
    """Symmetric, and no detour is shorter."""
    f, g, h = (table(rng.gamma(0.3, size=(3, *GRID.shape))) for _ in range(3))
    fg, gf, gh, fh = (difference(*pair, metric) for pair in ((f, g), (g, f), (g, h), (f, h)))
    assert_allclose(fg, gf, rtol=1e-12)
    assert fh.below <= fg.below + gh.below + 1e-12
    assert fh.grazing <= fg.grazing + gh.grazing + 1e-12


@pytest.mark.parametrize("metric", ALL)
def test_what_happens_past_80_degrees_is_reported_apart(metric):
    angles = Grid.merl(20, 20, 8).centres()
    cosine = np.minimum(*cosines(angles.theta_h, angles.theta_d, angles.phi_d))
    grid = Grid.merl(20, 20, 8)
    f, g = table(0.3, grid), table(np.where(cosine < np.cos(np.radians(80)), 5.0, 0.3), grid)
    assert difference(f, g, metric).below == 0
    assert difference(f, g, metric).grazing > 0.1


@pytest.mark.parametrize("metric", ALL)
def test_cells_that_one_table_lacks_do_not_count(metric):
    """A wrong value beside a hole of the other table changes nothing."""
    f, g, wrong = np.full((3, 3, *GRID.shape), [[[[[0.3]]]], [[[[0.6]]]], [[[[0.6]]]]])
    f[:, 2] = np.nan
    wrong[:, 2] = 9.0
    assert difference(table(f), table(g), metric) == difference(table(f), table(wrong), metric)
    assert difference(table(g), table(f), metric).below > 0


def test_a_black_reference_has_no_relative_error():
    assert np.isnan(difference(table(0.0), table(1.0), "relative")).all()


def test_tables_on_different_grids_are_refused():
    with pytest.raises(
        FormatError, match="6 x 5 x 8 grid and 'table' on 6 x 5 x 9: only tables on one grid"
    ):
        difference(table(1.0), table(1.0, Grid.merl(6, 5, 9)))


def test_white_grey_and_black_have_no_colour():
    greys = np.array([[0.0, 0, 0], [0.18418651851244414] * 3, [1, 1, 1]])
    assert_allclose(to_lab(greys), [[0, 0, 0], [50, 0, 0], [100, 0, 0]], atol=1e-12)


def test_lab_agrees_with_scikit_image():
    """Its white differs from ours in the fourth digit: 500/3 x 2e-4 in a*, 200/3 x 3e-4 in b*."""
    rgb = np.random.default_rng(1).random((500, 3))
    theirs = color.xyz2lab(
        color.rgb2xyz(np.where(rgb <= 0.0031308, 12.92 * rgb, 1.055 * rgb ** (1 / 2.4) - 0.055))
    )
    assert_allclose(to_lab(rgb), theirs, atol=0.05)


def test_float32_pictures_stay_float32():
    rgb = np.random.default_rng(1).random((50, 3))
    assert appearance(rgb.astype(np.float32)).dtype == np.float32
    assert_allclose(appearance(rgb.astype(np.float32)), appearance(rgb), atol=2e-4)


def test_a_display_shows_what_is_below_the_shoulder_and_compresses_the_rest():
    x = np.array([0.0, 0.3, SHOULDER, SHOULDER + 1e-6, 1.0, 2.0, 40.0])
    y = shown(x)
    assert_allclose(y[:3], x[:3])
    assert_allclose((y[3] - y[2]) / 1e-6, 1, rtol=1e-5)
    assert (np.diff(y) > 0).all()
    assert y[-1] <= 1


@given(numbers)
def test_ciede2000_agrees_with_scikit_image(rng: np.random.Generator):
    a, b = rng.uniform([0, -120, -120], [100, 120, 120], (2, 200, 3))
    assert_allclose(ciede2000(a, b), color.deltaE_ciede2000(a, b), rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(
    ("a", "b", "expected"),
    [
        # Sharma et al. 2005, table 1: pairs 1, 4, 7, 9, 13, 16, 17, 25, 31, 34.
        ((50, 2.6772, -79.7751), (50, 0, -82.7485), 2.0425),
        ((50, -1.3802, -84.2814), (50, 0, -82.7485), 1.0000),
        ((50, 0, 0), (50, -1, 2), 2.3669),
        ((50, 2.49, -0.001), (50, -2.49, 0.0009), 7.1792),
        ((50, -0.001, 2.49), (50, 0.0009, -2.49), 4.8045),
        ((50, 2.5, 0), (50, 0, -2.5), 4.3065),
        ((50, 2.5, 0), (73, 25, -18), 27.1492),
        ((60.2574, -34.0099, 36.2677), (60.4626, -34.1751, 39.4387), 1.2644),
        ((22.7233, 20.0904, -46.6940), (23.0331, 14.9730, -42.5619), 2.0373),
        ((2.0776, 0.0795, -1.1350), (0.9033, -0.0636, -0.5514), 0.9082),
    ],
)
def test_ciede2000_gives_the_published_values(a, b, expected):
    assert_allclose(ciede2000(np.array([a], float), np.array([b], float)), expected, atol=5e-5)
    assert_allclose(ciede2000(np.array([b], float), np.array([a], float)), expected, atol=5e-5)


def test_ciede2000_keeps_its_digits_in_float32_where_pictures_hardly_differ():
    """Differences of .01 between values up to 100 (spacing 8e-6) to a percent."""
    rng = np.random.default_rng(3)
    a = rng.uniform([0, -100, -100], [100, 100, 100], (500, 3)).astype(np.float32)
    b = a + (0.01 * rng.standard_normal(a.shape)).astype(np.float32)
    exact = ciede2000(a.astype(np.float64), b.astype(np.float64))
    assert_allclose(ciede2000(a, b), exact, rtol=0.01, atol=2e-5)


@pytest.mark.parametrize("difference", [cielab_difference, ciede2000_difference])
def test_differences_are_means_over_pixels(difference):
    a, b = to_lab(np.random.default_rng(2).random((2, 4, 7, 3)))
    one_by_one = [
        [difference(x[None], y[None]) for x, y in zip(u, v, strict=True)]
        for u, v in zip(a, b, strict=True)
    ]
    assert difference(a, b).shape == (4,)
    assert_allclose(difference(a, b), np.mean(one_by_one, axis=1))
    assert_allclose(difference(a, a), 0, atol=1e-12)
    assert_allclose(difference(a, b), difference(b, a))


def test_the_difference_of_white_and_black_is_100():
    black, white = to_lab(np.array([[[0.0] * 3], [[1.0] * 3]]))
    assert_allclose(cielab_difference(black, white), 100)
    assert_allclose(ciede2000_difference(black, white), 100, rtol=1e-6)


def test_flip_runs_from_0_to_about_1():
    black = np.zeros((16, 16, 3), np.float32)
    white = np.full_like(black, 50.0)
    assert flip(black, black) == 0
    assert flip(white, white) == 0
    assert 0.9 < flip(black, white) <= 1
    grey = np.full_like(black, 0.5)
    assert 0 < flip(grey, grey * 1.1) < flip(grey, white) < 1
