"""The triangulation and the way of a line through it: by hand, against scipy, and where points are degenerate."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.spatial import Delaunay
from strategies import convex_weights, distinct_points, points

from halfway.components import Pca
from halfway.errors import DegenerateSpaceWarning, OutsideHullError
from halfway.space import PaperSpace, Triangulation
from halfway.space.walk import DelaunayWalk

SQUARE = np.array([[0.0, 0], [2, 0], [2, 2], [0, 2], [1, 1]])
"""A square and its centre: four triangles."""


def at(path, t):
    return path.at(np.atleast_1d(np.asarray(t, float)))


def test_the_weights_of_a_point_by_hand():
    """(1, 0.5) is half way between the centre and the middle of the lower edge."""
    assert_allclose(
        Triangulation.of(SQUARE).weights(np.array([1.0, 0.5])), [0.25, 0.25, 0, 0, 0.5], atol=1e-12
    )


def test_a_line_between_corners_of_the_square_passes_its_centre():
    path = Triangulation.of(SQUARE).way(0, 2)
    assert_allclose(at(path, 0.5), [[0, 0, 0, 0, 1]], atol=1e-12)
    assert_allclose(at(path, 0.25), [[0.5, 0, 0, 0, 0.5]], atol=1e-12)


def test_crossings_by_hand():
    """From (0, 0) to (4, 1) over the edge from (1, 1) to (2, -1): the line y = x/4 meets y = 3 - 2x at x = 4/3."""
    x = np.array([[0.0, 0], [1, 1], [2, -1], [4, 1]])
    path = Triangulation.of(x).way(0, 3)
    assert_allclose(path.knots, [0, 1 / 3, 1], atol=1e-12)
    assert_allclose(path.weights[1], [0, 2 / 3, 1 / 3, 0], atol=1e-12)


@pytest.mark.parametrize("k", [2, 3, 4])
def test_weights_are_scipys(k):
    x = np.random.default_rng(0).normal(size=(30, k))
    ours, scipys = Triangulation.of(x), Delaunay(x)
    for inside in np.random.default_rng(1).dirichlet(np.ones(30), size=20) @ x:
        simplex = scipys.find_simplex(inside)
        m = scipys.transform[simplex]
        barycentric = m[:k] @ (inside - m[k])
        expected = np.zeros(30)
        expected[scipys.simplices[simplex]] = np.append(barycentric, 1 - barycentric.sum())
        assert_allclose(ours.weights(inside), expected, atol=1e-9)


@pytest.mark.filterwarnings("ignore::halfway.errors.DegenerateSpaceWarning")
@given(st.integers(1, 4).flatmap(lambda k: st.tuples(points(12, k), convex_weights(12))))
def test_weights_are_convex_and_give_the_point(drawn):
    x, w = drawn
    triangulation = Triangulation.of(x)
    inside = w @ x
    found = triangulation.weights(inside)
    assert found.min() >= 0
    assert_allclose(found.sum(), 1, atol=1e-12)
    assert_allclose(found @ x, inside, atol=1e-7 * (1 + np.abs(x).max()))


@pytest.mark.filterwarnings("ignore::halfway.errors.DegenerateSpaceWarning")
@given(st.integers(1, 4).flatmap(lambda k: points(10, k)), st.integers(0, 9), st.integers(0, 9))
def test_a_path_is_convex_exact_at_its_ends_and_on_the_line(x, start, stop):
    path = Triangulation.of(x).way(start, stop)
    t = np.linspace(0, 1, 33)
    weights = at(path, t)
    np.testing.assert_array_equal(weights[[0, -1]], np.eye(10)[[start, stop]])
    assert weights.min() >= 0
    assert_allclose(weights.sum(axis=1), 1, atol=1e-12)
    line = (1 - t)[:, None] * x[start] + t[:, None] * x[stop]
    assert_allclose(weights @ x, line, atol=1e-7 * (1 + np.abs(x).max()))


@given(distinct_points(10, 3), st.integers(0, 9), st.integers(0, 9))
def test_the_weights_of_a_path_are_those_of_its_points(x, start, stop):
    """The crossings, solved once, agree with locating every point by itself (where no points coincide)."""
    triangulation = Triangulation.of(x)
    path = triangulation.way(start, stop)
    for t in (0.1, 0.37, 0.8):
        here = (1 - t) * x[start] + t * x[stop]
        located = triangulation.weights(here)
        # On cospherical lattice points several simplices may claim a place: compare what they stand for.
        assert_allclose(located @ x, at(path, t)[0] @ x, atol=1e-9)


@pytest.mark.parametrize("k", [2, 3, 4, 5, 6])
def test_paths_in_every_dimension_of_the_paper(k):
    x = np.random.default_rng(k).normal(size=(40, k))
    path = Triangulation.of(x).way(3, 17)
    assert (np.diff(path.knots) > 0).all()
    assert (path.weights > 0).sum(axis=1).max() <= k + 1
    line = (1 - path.knots)[:, None] * x[3] + path.knots[:, None] * x[17]
    assert_allclose(path.weights @ x, line, atol=1e-9)


def test_coincident_points_are_one_vertex():
    x = np.concatenate([SQUARE, SQUARE[:2]])
    with pytest.warns(DegenerateSpaceWarning, match="2 of 7 materials coincide with another"):
        triangulation = Triangulation.of(x)
    assert set(triangulation.simplices.ravel()) == {0, 1, 2, 3, 4}
    # A coincident material is still reached exactly.
    assert_allclose(at(triangulation.way(5, 3), [0, 1]), np.eye(7)[[5, 3]])


@pytest.mark.parametrize(
    ("x", "n_dimensions"),
    [
        pytest.param(np.outer(np.arange(5.0), [1, 2, 3]), 1, id="collinear"),
        pytest.param(
            np.random.default_rng(0).normal(size=(9, 2)) @ [[1, 0, 1], [0, 1, 1.0]],
            2,
            id="coplanar",
        ),
        pytest.param(
            np.random.default_rng(0).normal(size=(9, 3)) * [1, 1, 1e-7], 2, id="below-32-bits"
        ),
        pytest.param(np.random.default_rng(0).normal(size=(2, 3)), 1, id="two-points"),
        pytest.param(np.random.default_rng(0).normal(size=(3, 3)), 2, id="three-points"),
    ],
)
def test_flat_points_drop_a_dimension_and_say_so(x, n_dimensions):
    with pytest.warns(DegenerateSpaceWarning, match=f"extend in {n_dimensions} of 3 dimensions"):
        triangulation = Triangulation.of(x)
    assert triangulation.n_dimensions == n_dimensions
    path = triangulation.way(0, 1)
    assert_allclose(at(path, 0.5) @ x, [(x[0] + x[1]) / 2], atol=1e-9)


@pytest.mark.filterwarnings("ignore::halfway.errors.DegenerateSpaceWarning")
def test_points_that_all_coincide_are_still_a_space():
    triangulation = Triangulation.of(np.ones((4, 2)))
    assert_allclose(
        at(triangulation.way(1, 3), [0, 0.5, 1]), [[0, 1, 0, 0], [0, 0.5, 0, 0.5], [0, 0, 0, 1]]
    )


def test_a_simplex_alone_is_a_triangulation():
    """N = k + 1: Qhull wants one more point."""
    x = np.array([[0.0, 0], [1, 0], [0, 1]])
    assert_allclose(Triangulation.of(x).weights(np.array([0.25, 0.25])), [0.5, 0.25, 0.25])


def test_outside_the_hull_is_an_error_not_the_last_simplex():
    with pytest.raises(
        OutsideHullError,
        match="outside the hull of the 5 materials",
    ):
        Triangulation.of(SQUARE).weights(np.array([3.0, 1.0]))


def test_the_scale_of_the_scores_does_not_matter():
    """Raw scores reach 1e5 and fall to 1e-3; tolerances are shares of the extent."""
    x = np.random.default_rng(5).normal(size=(20, 3)) * [1, 0.1, 0.01]
    paths = [Triangulation.of(scale * x).way(2, 9) for scale in (1e-6, 1, 1e6)]
    for path in paths[1:]:
        assert_allclose(path.knots, paths[0].knots, atol=1e-9)
        assert_allclose(path.weights, paths[0].weights, atol=1e-9)


def test_a_paper_space_of_very_many_simplices_is_walked(small_library, monkeypatch):
    """And its legs are those of the triangulation."""
    pca = Pca.fit(small_library)
    made = PaperSpace.fit(small_library, pca)
    monkeypatch.setattr("halfway.space.spaces.MOST_SIMPLICES", 10)
    walked = PaperSpace.fit(small_library, pca)
    assert isinstance(walked.charts[0].delaunay, DelaunayWalk)
    t = np.linspace(0, 1, 23)
    for start, stop in ((0, 1), (3, 7), (8, 2)):
        a, b = (leg.at(t) for leg in (space.leg(start, stop) for space in (made, walked)))
        assert_allclose(a, b, atol=1e-8)


def test_ten_thousand_points_in_six_dimensions_are_walked():
    """Thirteen million simplices, of which a line meets some dozens."""
    points = np.random.default_rng(0).normal(size=(10_000, 6))
    walk = DelaunayWalk.of(points)
    path = walk.way(3, 4)
    assert_allclose(
        path.weights @ points, path.knots[:, None] * (points[4] - points[3]) + points[3], atol=1e-7
    )
    assert (path.weights >= 0).all()
    assert ((path.weights > 0).sum(axis=1) <= 7).all()
