"""Spaces, routes and mixes: the laws of docs/laws.md, on random and on built-in libraries."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from strategies import convex_weights

from halfway import LinearSpace, PaperSpace, Pca, Recipe, Route, mix
from halfway.errors import OutsideHullError, RecipeError, SpaceError
from halfway.halfdiff import Grid
from halfway.library import LibraryRef, ProceduralLibrary
from halfway.models import builtin
from halfway.recipes import Blend, Mixer
from halfway.recipes.mixing import N_AT_ONCE
from halfway.space import make_space

unit = st.floats(0, 1)


@pytest.fixture(scope="module")
def pca(small_library):
    return Pca.fit(small_library)


@pytest.fixture(scope="module")
def space(small_library, pca):
    return PaperSpace.fit(small_library, pca, n_components=3)


def table(library, name):
    return library.brdf(name).values


def test_the_ends_of_a_route_are_the_materials_alone(space):
    route = Route.through(space, ["material-1", "material-5"])
    for t, name in ((0, "material-1"), (1, "material-5")):
        assert route.recipe(t).to_json()["weights"] == {name: 1.0}


@given(unit)
def test_scores_of_a_mix_are_the_point_asked_for(space, pca, t):
    """s(t) = (1 - t) p + t q, eq. 6, in every channel."""
    weights = Route.through(space, ["material-0", "material-7"]).at(np.array([t]))[:, 0]
    scores = pca.scores(3)
    wanted = (1 - t) * scores[:, 0] + t * scores[:, 7]
    assert_allclose(np.einsum("cn,cnk->ck", weights, scores), wanted, atol=1e-9 * abs(scores).max())


@given(st.lists(unit, min_size=2, max_size=5))
def test_recipes_are_convex_and_continuous(space, ts):
    route = Route.through(space, ["material-2", "material-8", "material-3"])
    weights = route.at(np.array(ts))
    assert weights.min() >= 0
    assert_allclose(weights.sum(axis=-1), 1, atol=1e-12)
    steepest = abs(np.diff(route.way.weights, axis=1) / np.diff(route.way.knots)[:, None]).max()
    moved = abs(route.at(np.array(ts) * (1 - 1e-6)) - weights).max()
    assert moved <= 1.01e-6 * steepest + 1e-12


def test_several_stops_are_reached_in_turn(space):
    route = Route.through(space, ["material-2", "material-8", "material-3"])
    for t, name in ((0, "material-2"), (0.5, "material-8"), (1, "material-3")):
        assert route.recipe(t).to_json()["weights"] == {name: 1.0}


@pytest.mark.parametrize("name", ["anchored", "paper", "linear"])
def test_from_a_recipe_a_route_goes_straight_and_ends_exactly(small_library, name):
    """A mean of legs, each of which is straight in the coordinates."""
    fitted = make_space(name, small_library, blend="linear")
    recipe = Recipe.of(small_library, {"material-0": 0.5, "material-3": 0.3, "material-5": 0.2})
    route = Route.through(fitted, [recipe, "material-3", recipe])
    at_start, at_stop = recipe.dense(fitted.names), np.eye(len(fitted.names))[[3] * 3]
    assert_allclose(route.at(np.array([0, 0.5, 1])).swapaxes(0, 1), [at_start, at_stop, at_start])
    t = np.linspace(0, 0.5, 7)
    weights = route.at(t)
    assert (weights >= 0).all()
    for channel, of_channel in enumerate(weights):
        chart = fitted.charts[channel % len(fitted.charts)] if fitted.charts else None
        points = chart.coordinates.points if chart else np.eye(len(fitted.names))
        ends = (of_channel @ points)[[0, -1]]
        straight = ends[0] + 2 * t[:, None] * (ends[1] - ends[0])
        assert_allclose(of_channel @ points, straight, atol=1e-7 * np.abs(points).max())


def test_a_stop_that_is_mixed_in_another_way_is_refused(space):
    names = {"material-0": 0.5, "material-3": 0.5}
    root = Recipe.of(space.library, names, "root")
    with pytest.raises(SpaceError, match=r"mix of 2 is mixed by the blend 'root'.*--blend root"):
        Route.through(space, [root, "material-1"])
    scaled = replace(Recipe.of(space.library, names), body_scale=(0.5, 0.5, 0.5))
    with pytest.raises(SpaceError, match="mix of 2 has its body scaled"):
        Route.through(space, ["material-1", scaled])


def test_linear_is_the_two_ends_in_proportion(small_library):
    linear = LinearSpace.of(small_library)
    recipe = Route.through(linear, ["material-4", "material-6"]).recipe(0.25)
    assert recipe.to_json()["weights"] == {"material-4": 0.75, "material-6": 0.25}


def test_a_free_point_is_located_in_each_channel(space, pca):
    point = pca.scores(3)[:, :4].mean(axis=1)
    recipe = space.at(point).recipe
    dense = np.zeros((3, 9))
    dense[:, [space.names.index(name) for name in recipe.names]] = recipe.weights
    assert_allclose(
        np.einsum("cn,cnk->ck", dense, pca.scores(3)), point, atol=1e-9 * abs(point).max()
    )


def test_a_point_far_away_is_refused(space, pca):
    with pytest.raises(OutsideHullError):
        space.at(100 * pca.scores(3)[:, 0])


@pytest.mark.parametrize("k", [2, 3, 4, 5, 6])
def test_the_papers_space_in_two_to_six_dimensions(small_library, pca, k):
    route = Route.through(
        PaperSpace.fit(small_library, pca, n_components=k), ["material-0", "material-1"]
    )
    assert (route.at(np.linspace(0, 1, 9)) >= 0).all()


def test_two_materials_are_a_space(small_library):
    from strategies import random_tables

    from halfway.errors import DegenerateSpaceWarning
    from halfway.library import ProceduralLibrary

    two = ProceduralLibrary("two", random_tables(2, small_library.grid), grid=small_library.grid)
    with pytest.warns(DegenerateSpaceWarning, match="2 materials extend in 1 of 2 dimensions"):
        space = PaperSpace.fit(two, Pca.fit(two))
    weights = Route.through(space, two.names).recipe(0.25).weights
    assert_allclose(weights, [[0.75, 0.25]] * 3, atol=1e-9)


@pytest.mark.parametrize(
    ("stops", "message"),
    [
        (["material-1"], "with 1 stop goes nowhere"),
        (["material-1", "material-1"], "material-1 follows itself"),
        (["material-1", "nothing"], "'nothing' is not a material of small"),
    ],
)
def test_a_route_needs_two_different_stops(space, stops, message):
    with pytest.raises(SpaceError, match=message):
        Route.through(space, stops)


@pytest.mark.parametrize("t", [-0.1, 1.1, float("nan")])
def test_t_off_the_route_is_refused(space, t):
    with pytest.raises(SpaceError, match=f"t = {t:g} is off the route"):
        Route.through(space, ["material-1", "material-2"]).recipe(t)


def test_steps_include_every_stop(space):
    route = Route.through(space, ["material-2", "material-8", "material-3"])
    assert_allclose(route.steps(5), [0, 0.25, 0.5, 0.75, 1])
    assert 0.5 in route.steps(4)
    uneven = replace(route, stop_ts=np.array([0, 0.01, 1]))
    assert_allclose(uneven.steps(4), [0, 0.01, 0.505, 1])


def test_steps_and_components_have_limits(small_library, space, pca):
    with pytest.raises(
        SpaceError, match="a route of 1 materials cannot pass 2 stops: expected -n 2 or more"
    ):
        Route.through(space, ["material-1", "material-2"]).steps(1)
    with pytest.raises(SpaceError, match="of 7 components cannot be made: expected 1 to 6"):
        PaperSpace.fit(small_library, pca, n_components=7)
    with pytest.raises(SpaceError, match="there is no space 'cubic': expected one of"):
        make_space("cubic", small_library)


@pytest.mark.parametrize("blend", [Blend.LINEAR, Blend.LOBES])
@pytest.mark.parametrize("n", [1, 2, 3, 4, 5, 8, 9])
def test_the_first_mixes_and_the_compiled_ones_have_the_same_bits(small_library, n, blend):
    weights = np.random.default_rng(n).dirichlet(np.ones(n), 3)
    recipe = Recipe(LibraryRef("small"), small_library.names[:n], weights, blend)
    mixer = Mixer(small_library)
    tables = [mixer.mix(recipe).values for _ in range(N_AT_ONCE + 1)]
    np.testing.assert_array_equal(tables[-1], tables[0])


def test_a_mix_is_the_weighted_sum_of_tables(small_library):
    weights = {
        "r": {"material-0": 1},
        "g": {"material-0": 0.5, "material-1": 0.5},
        "b": {"material-2": 0.25, "material-3": 0.75},
    }
    a, b, c, d = (table(small_library, f"material-{i}").astype(float) for i in range(4))
    expected = [a[0], 0.5 * a[1] + 0.5 * b[1], 0.25 * c[2] + 0.75 * d[2]]
    assert_allclose(mix(small_library, Recipe.of("small", weights)).values, expected, rtol=1e-6)


@given(convex_weights(9))
def test_many_ingredients_take_several_passes(small_library, w):
    recipe = Recipe.from_dense("small", small_library.names, np.stack([w] * 3))
    rows = np.stack([small_library.row(i) for i in range(9)]).astype(float)
    found = mix(small_library, recipe).values.reshape(3, -1)
    assert_allclose(found, np.tensordot(w, rows, 1), rtol=1e-5)


def test_the_recipe_of_a_material_is_its_table_to_the_bit(small_library):
    found = mix(small_library, Recipe.of("small", {"material-3": 1}))
    np.testing.assert_array_equal(found.values, table(small_library, "material-3"))


@given(convex_weights(9), st.integers(0, 8))
def test_mixes_keep_positivity_and_the_mask(small_library, w, i):
    recipe = Recipe.from_dense("small", small_library.names, np.stack([w, np.eye(9)[i], w[::-1]]))
    values = mix(small_library, recipe).values
    np.testing.assert_array_equal(np.isnan(values[0]), ~small_library.grid.mask())
    assert np.nanmin(values) >= 0


def test_an_unknown_ingredient_is_refused(small_library):
    with pytest.raises(RecipeError, match="'gold' is not one of the 9 materials of small"):
        mix(small_library, Recipe.of("small", {"gold": 1}))


def test_a_mixer_keeps_a_bounded_number_of_rows(small_library):
    mixer = Mixer(small_library, n_rows=2)
    for name in small_library.names:
        mixer.mix(Recipe.of("small", {name: 1}))
    assert mixer._row.cache_info().currsize == 2


def test_the_papers_fine_navigation_on_the_builtin_library():
    """At t = .0001, .0002 ... 1: ten thousand recipes, each convex, none far from its neighbour."""
    models = builtin("merl-abc").models
    library = ProceduralLibrary("coarse", models, grid=Grid.merl(30, 20, 24))
    space = make_space("paper", library)
    route = Route.through(space, ["cherry-235", "tungsten-carbide"])
    weights = route.at(np.arange(1, 10_001) / 10_000)
    assert weights.shape == (3, 10_000, 100)
    assert weights.min() >= 0
    assert_allclose(weights.sum(axis=2), 1, atol=1e-12)
    assert ((weights > 0).sum(axis=2) <= 4).all()
