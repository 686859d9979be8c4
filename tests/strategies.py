"""What the tests draw from: hypothesis strategies, and tables made in the test."""

import numpy as np
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from halfway.brdf import TabularBrdf
from halfway.halfdiff import Grid

TINY = Grid.merl(3, 4, 5)
"""Small enough to write down, with a different size along each axis."""

_azimuths = st.floats(-np.pi, np.pi)


@st.composite
def directions(draw: st.DrawFn, max_degrees: float = 89.0) -> np.ndarray:
    """A unit vector above the horizon."""
    theta = draw(st.floats(0, np.radians(max_degrees)))
    phi = draw(_azimuths)
    return np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])


def points(n: int, k: int) -> st.SearchStrategy[np.ndarray]:
    """``n`` points in ``k`` dimensions, some of them on a coarse lattice: coincident, collinear, coplanar."""
    lattice = hnp.arrays(np.float64, (n, k), elements=st.integers(-3, 3).map(float))
    return lattice | points_in_general_position(n, k)


def points_in_general_position(n: int, k: int) -> st.SearchStrategy[np.ndarray]:
    """``n`` points in ``k`` dimensions with one triangulation: normal deviates, of which no k + 2 lie on a sphere."""
    seeds = st.integers(0, 2**32 - 1)
    return seeds.map(lambda seed: np.random.default_rng(seed).normal(size=(n, k)))


def distinct_points(n: int, k: int) -> st.SearchStrategy[np.ndarray]:
    """``n`` points that span ``k`` dimensions, none at the place of another; on a coarse lattice or in general position."""
    places = st.tuples(*[st.integers(-3, 3)] * k)
    lattice = st.lists(places, min_size=n, max_size=n, unique=True).map(
        lambda x: np.array(x, float)
    )
    spanning = lattice.filter(lambda x: np.linalg.matrix_rank(x - x.mean(axis=0)) == k)
    return spanning | points_in_general_position(n, k)


def convex_weights(n: int) -> st.SearchStrategy[np.ndarray]:
    """``n`` non-negative weights that sum to 1, zeros among them."""
    raw = hnp.arrays(np.float64, n, elements=st.floats(0, 1)).filter(lambda w: w.sum() > 0.1)
    return raw.map(lambda w: w / w.sum())


def random_tables(n: int, grid: Grid, seed: int = 0) -> dict[str, TabularBrdf]:
    """``n`` reproducible tables: positive where both directions are above the horizon, NaN elsewhere."""
    rng = np.random.default_rng(seed)
    tables = {}
    for name in map("material-{}".format, range(n)):
        values = rng.gamma(0.5, size=(3, *grid.shape)).astype(np.float32)
        values[:, ~grid.mask()] = np.nan
        tables[name] = TabularBrdf(values, grid, name=name)
    return tables
