"""The anchored space and perceptual pace: the laws, on random materials and on the built-in ones."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from strategies import convex_weights, points, points_in_general_position, random_tables

from halfway import Route
from halfway.errors import OutsideHullError, SpaceError
from halfway.formats import read_nbrdf_archive
from halfway.halfdiff import Grid
from halfway.library import ProceduralLibrary
from halfway.look import CellSamples, Looks
from halfway.look.appearance import appearance, ciede2000_difference, cielab_difference
from halfway.recipes import Blend
from halfway.space import (
    AnchoredSpace,
    LinearSpace,
    Triangulation,
    make_space,
    perceptual,
)
from halfway.space.anchored import N_PICTURES, THINNING
from halfway.space.hull import nearest_in_hull
from halfway.space.walk import DelaunayWalk

GRID = Grid.merl(8, 6, 10)


@pytest.fixture(scope="module")
def library():
    return ProceduralLibrary("twelve", random_tables(12, GRID), grid=GRID)


@pytest.fixture(scope="module")
def images(library):
    return Looks.fit(library)


@pytest.fixture(scope="module")
def samples(library):
    return CellSamples.fit(library)


@pytest.fixture(scope="module")
def make(library):
    return lambda **options: AnchoredSpace.fit(library, **options)


@pytest.fixture(scope="module")
def space(make):
    return make()


@given(
    st.integers(2, 5).flatmap(
        lambda k: st.tuples(
            points_in_general_position(14, k), st.integers(0, 13), st.integers(0, 13)
        )
    )
)
def test_the_walk_is_the_way_through_the_triangulation(drawn):
    """The programme and the triangulation give the same weights, where there is one triangulation."""
    x, start, stop = drawn
    t = np.linspace(0, 1, 65)
    ways = [made.of(x).way(start, stop) for made in (Triangulation, DelaunayWalk)]
    a, b = (way.at(t) for way in ways)
    assert_allclose(a, b, atol=1e-7)


@pytest.mark.filterwarnings("ignore::halfway.errors.DegenerateSpaceWarning")
@given(st.integers(1, 5).flatmap(lambda k: points(12, k)), st.integers(0, 11), st.integers(0, 11))
def test_the_walk_is_convex_and_on_the_line_wherever_it_goes(x, start, stop):
    """Lattices included: whatever simplices it takes, the weights stand for the points of the line."""
    way = DelaunayWalk.of(x).way(start, stop)
    t = np.linspace(0, 1, 17)
    weights = way.at(t)
    assert weights.min() >= 0
    assert_allclose(weights.sum(axis=1), 1, atol=1e-12)
    line = (1 - t)[:, None] * x[start] + t[:, None] * x[stop]
    assert_allclose(weights @ x, line, atol=1e-6 * (1 + np.abs(x).max()))


@given(
    st.integers(2, 4).flatmap(
        lambda k: st.tuples(points_in_general_position(12, k), convex_weights(12))
    )
)
def test_a_point_located_by_programme_and_by_triangulation(drawn):
    x, w = drawn
    inside = w @ x
    walk, triangulation = DelaunayWalk.of(x), Triangulation.of(x)
    assert_allclose(walk.weights(inside), triangulation.weights(inside), atol=1e-6)


def test_eight_dimensions_without_a_quarter_million_simplices():
    x = np.random.default_rng(0).normal(size=(100, 8))
    way = DelaunayWalk.of(x).way(3, 60)
    line = (1 - way.knots)[:, None] * x[3] + way.knots[:, None] * x[60]
    assert_allclose(way.weights @ x, line, atol=1e-9)


@pytest.mark.parametrize("x", [np.array([3.0, 1.0]), np.array([-1.0, -1.0])])
def test_the_nearest_point_of_a_hull(x):
    square = np.array([[0.0, 0], [2, 0], [2, 2], [0, 2]])
    assert_allclose(nearest_in_hull(square, x) @ square, np.clip(x, 0, 2), atol=1e-9)


@pytest.fixture(scope="module")
def route(space):
    return Route.through(space, ["material-0", "material-7"])


@given(st.floats(0, 1))
def test_every_coordinate_of_a_mix_is_on_the_straight_line(space, route, t):
    """The body colours among them: no detour through a foreign colour."""
    weights = route.at(np.array([t]))[:, 0]
    assert_allclose(weights[0], weights[1])
    wanted = (1 - t) * space.points[0] + t * space.points[7]
    assert_allclose(weights[0] @ space.points, wanted, atol=1e-8 * abs(space.points).max())


@pytest.mark.parametrize("detour", [1.0, 1.05, 1.5])
def test_no_leg_is_longer_than_allowed(make, library, images, detour):
    """Or than the ends in plain proportion, which are curved in CIELAB themselves; on the pixels that a space measures on."""
    limited = make(detour=detour)
    pixels = images.thinned(THINNING)
    t = np.linspace(0, 1, N_PICTURES)
    for start, stop in ((0, 1), (3, 9), (11, 2)):
        leg, plain = limited.leg(start, stop), LinearSpace.of(library).leg(start, stop)
        lengths = []
        for way in (leg, plain):
            looks = appearance(pixels.mix(way.at(t), Blend.LINEAR))
            lengths.append(
                cielab_difference(looks[1:], looks[:-1]).sum()
                / cielab_difference(looks[0], looks[-1])
            )
        # Pictures are float32, 1e-7 of some 100; a step of them is about 1.
        assert lengths[0] <= max(detour, lengths[1]) * (1 + 1e-5)


def test_without_a_limit_the_weights_are_delaunays(make):
    free = make(detour=np.inf)
    leg, path = free.leg(2, 5), free.charts[0].way(2, 5)
    assert_allclose(leg.weights[0], path.weights)


def test_a_material_stands_at_its_own_point(space):
    recipe = space.at(space.points[4]).recipe
    assert_allclose(recipe.weights[:, recipe.names.index("material-4")], 1, atol=1e-6)


def test_a_point_by_the_names_of_its_coordinates(space):
    middle = space.points[:5].mean(axis=0)
    named = dict(zip(space.coordinates, middle.tolist(), strict=True))
    assert_allclose(space.at(named).recipe.weights, space.at(middle).recipe.weights)
    del named["body_g"]
    with pytest.raises(SpaceError, match=r"the point lacks \['body_g'\]"):
        space.at(named)
    with pytest.raises(
        SpaceError, match="the point has 2 coordinates: expected 7 numbers, score_1"
    ):
        space.at(np.zeros(2))


def test_outside_the_hull_names_the_nearest_point_and_clamp_takes_it(space):
    far = space.points.max(axis=0) * 3
    with pytest.raises(OutsideHullError, match=r"from it in scaled coordinates.*--clamp takes it"):
        space.at(far)
    recipe = space.at(far, clamp=True).recipe
    assert_allclose(recipe.weights.sum(axis=1), 1)


def test_paced_steps_look_equally_far_apart(space, images):
    """Largest step at most 1.1 times the mean, where uniform t gives more."""
    route = Route.through(space, ["material-0", "material-7", "material-3"])
    paced = perceptual(route, images)
    looks = appearance(images.mix(paced.at(np.linspace(0, 1, 51)), paced.blend))
    steps = ciede2000_difference(looks[1:], looks[:-1])
    assert steps.max() / steps.mean() < 1.1


def test_pacing_changes_when_not_where(space, images):
    """The same recipes in the same order; ends and stops stay exact."""
    route = Route.through(space, ["material-0", "material-7", "material-3"])
    paced = perceptual(route, images)
    assert paced.pace == "perceptual"
    np.testing.assert_array_equal(paced.at(np.array([0.0, 1.0])), route.at(np.array([0.0, 1.0])))
    assert_allclose(paced.at(paced.stop_ts), route.at(route.stop_ts), atol=1e-9)
    assert (np.diff(paced.way.knots) > 0).all()


def test_a_route_on_which_nothing_changes_keeps_its_t(library, images):
    space = LinearSpace.of(library)
    same = Looks(
        images.names, images.scene, np.repeat(images.planes[:, :1], 12, axis=1), images.tables
    )
    route = Route.through(space, ["material-0", "material-1"])
    assert_allclose(perceptual(route, same).at(np.array([0.5])), route.at(np.array([0.5])))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"n_components": -1}, "of -1 components cannot be made"),
        ({"detour": 0.9}, "a detour of 0.9 is shorter than"),
    ],
)
def test_what_no_space_can_be_made_of(make, options, message):
    with pytest.raises(SpaceError, match=message):
        make(**options)


def test_cherry_to_tungsten_carbide_on_the_neural_stand_in(shared_data):
    """The paper's hardest pair: straight in colour, evenly paced, through other materials."""
    networks = read_nbrdf_archive(shared_data / "nbrdf" / "merl_nbrdf.zip")
    wanted = [
        "cherry-235",
        "tungsten-carbide",
        "pink-felt",
        "chrome",
        "blue-fabric",
        "gold-paint",
        "teflon",
        "black-obsidian",
    ]
    wanted += [
        "alum-bronze",
        "red-fabric",
        "green-latex",
        "pvc",
        "steel",
        "nylon",
        "grease-covered-steel",
        "blue-rubber",
    ]
    some = {name: networks.models[name] for name in wanted}
    # On fewer cells than the database's: the pictures are as small.
    few = ProceduralLibrary("few", some, grid=Grid.merl(60, 30, 36))
    space = make_space("anchored", few, blend="linear")
    route = Route.through(space, ["cherry-235", "tungsten-carbide"])
    images = Looks.fit(few)
    looks = appearance(images.mix(perceptual(route, images).at(np.linspace(0, 1, 51)), route.blend))
    length = cielab_difference(looks[1:], looks[:-1]).sum()
    assert length / cielab_difference(looks[0], looks[-1]) < 1.12
    steps = ciede2000_difference(looks[1:], looks[:-1])
    assert steps.max() / steps.mean() < 1.1
