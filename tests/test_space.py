"""What every space says of itself, whatever its kind; and ways."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from strategies import convex_weights

import halfway
from halfway.brdf import TabularBrdf
from halfway.components import Newcomer, Pca
from halfway.errors import OutsideHullError, RecipeError, SpaceError
from halfway.library import LibraryRef
from halfway.look import Looks
from halfway.recipes import Blend, Recipe, mix
from halfway.space import SPACES, AnchoredSpace, Coordinates, Numbers, Scores, Way, make_space
from halfway.space.chart import ON_THE_HULL

unit = st.floats(0, 1)


@pytest.fixture(scope="module")
def spaces(small_library):
    made = {name: make_space(name, small_library) for name in SPACES}
    return made | {"root": make_space("anchored", small_library, blend=Blend.ROOT)}


@pytest.fixture(params=["anchored", "paper"])
def space(request, spaces):
    """A space in which materials are points."""
    return spaces[request.param]


def test_every_material_stands_at_its_own_point(space):
    for i, name in enumerate(space.names):
        position = space.at(space.points[i])
        assert position.inside
        assert_allclose(position.recipe.weights[:, position.recipe.names.index(name)], 1, atol=1e-6)


@given(convex_weights(9))
def test_the_point_of_a_mix_is_the_mix_of_the_points(spaces, w):
    for name in ("anchored", "paper"):
        space = spaces[name]
        position = space.at(w @ space.points)
        # On a face of the hull rounding may put it outside.
        off = np.abs(position.point - w @ space.points)
        assert (off <= ON_THE_HULL * np.ptp(space.points, axis=0)).all()


@given(convex_weights(9))
def test_a_table_stands_where_the_mix_does_that_it_is(spaces, small_library, w):
    """Coordinates are linear functionals of the table, in the mapping of the blend."""
    for name in ("root", "paper"):
        space = spaces[name]
        recipe = Recipe.from_dense(
            small_library, small_library.names, np.stack([w] * 3), space.blend
        )
        newcomer = Newcomer(small_library, mix(small_library, recipe))
        # Tables are float32.
        expected = w @ space.points
        assert_allclose(space.point_of(newcomer), expected, atol=4e-7 * abs(space.points).max())


def test_the_scores_of_a_table_are_its_projections_on_the_components(small_library):
    """Of one that is no mix, against the components themselves, which the package never forms."""
    rows = np.stack([small_library.row(i) for i in range(9)]).reshape(9, -1).astype(float)
    known = ~np.isnan(rows).any(axis=0)
    rows = rows[:, known] - rows[:, known].mean(axis=0)
    _, _, components = np.linalg.svd(rows, full_matrices=False)
    own = np.full(known.shape, np.nan, np.float32)
    own[known] = np.random.default_rng(5).random(known.sum())
    table = TabularBrdf(own.reshape(3, *small_library.grid.shape), small_library.grid, name="own")
    scores = Scores.joint(Pca.fit(small_library), 3).of(Newcomer(small_library, table))
    centroid = np.stack([small_library.row(i) for i in range(9)]).mean(axis=0).ravel()[known]
    expected = components[:3] @ (own[known] - centroid)
    assert_allclose(np.abs(scores), np.abs(expected), rtol=1e-5)


def test_where_a_table_is_unmeasured_it_counts_as_the_mean(small_library):
    mean = np.mean([small_library.row(i) for i in range(9)], axis=0)
    half = np.array(mean)
    half[:, ::2] = np.nan
    table = TabularBrdf(half.reshape(3, *small_library.grid.shape), small_library.grid)
    with pytest.warns(UserWarning, match=r"unmeasured in \d\d\.\d% of what small is measured in"):
        scores = Scores.joint(Pca.fit(small_library), 3).of(Newcomer(small_library, table, "scan"))
    assert_allclose(scores, 0, atol=1e-5)


def test_numbers_that_are_not_of_tables_are_known_of_the_library_alone(small_library):
    weight = Numbers(label="Weight", names=("weight",), points=np.ones((9, 1)), unit="kg")
    with pytest.raises(SpaceError, match="weight cannot be read off a table"):
        weight.of(Newcomer(small_library, small_library.brdf("material-1")))


def test_a_point_may_be_given_by_the_names_of_its_coordinates(space):
    middle = space.points.mean(axis=0)
    named = dict(zip(space.coordinates, middle.tolist(), strict=True))
    assert_array_equal(space.at(named).recipe.weights, space.at(middle).recipe.weights)


def test_coordinates_of_channels_begin_with_their_letter(spaces):
    assert spaces["paper"].coordinates[:4] == ("r_score_1", "r_score_2", "r_score_3", "g_score_1")
    assert spaces["anchored"].coordinates[3:5] == ("score_4", "body_r")


def test_outside_the_hull_is_said_and_clamped_to_the_nearest(space):
    far = 100 * np.abs(space.points).max() * np.ones(len(space.coordinates))
    with pytest.raises(OutsideHullError, match="outside the hull of the 9 materials"):
        space.at(far)
    position = space.at(far, clamp=True)
    assert not position.inside
    assert_allclose(position.recipe.weights.sum(axis=1), 1)
    # No material is nearer than the nearest of all mixes.
    scale = np.concatenate([chart.coordinates.scale for chart in space.charts])
    off = np.linalg.norm((space.points - far) * scale, axis=1)
    assert np.linalg.norm((position.point - far) * scale) <= off.min() * (1 + 1e-9)


@pytest.mark.parametrize(
    ("point", "message"),
    [
        ([0.0], "has 1 coordinates: expected"),
        ([np.nan] * 7, "expected 7 numbers, score_1"),
        ({"score_1": 0.0}, r"lacks \['score_2'"),
    ],
)
def test_what_is_no_point_is_said(spaces, point, message):
    with pytest.raises(SpaceError, match=message):
        spaces["anchored"].at(point)


def test_the_linear_space_has_ways_and_no_points(spaces):
    linear = spaces["linear"]
    assert linear.coordinates == ()
    assert linear.embeddings() == []
    with pytest.raises(SpaceError, match="has no points between its routes"):
        linear.at([])


def test_a_material_left_out_has_no_weight_and_is_placed_by_the_others(space):
    weights = space.without(4)
    assert_array_equal(weights[:, 4], 0)
    assert_allclose(weights.sum(axis=1), 1)


def test_a_material_that_is_not_there_is_told_with_those_that_are_near(space):
    with pytest.raises(SpaceError, match="'material-33' is not a material of small: did you mean"):
        space.index("material-33")


def test_a_space_is_short_to_print(space):
    assert repr(space).startswith("<") and len(repr(space)) < 100  # noqa: PT018


def test_any_linear_coordinate_goes_straight_along_a_leg(small_library):
    """A coordinate that nobody thought of: how much of each material is the third one."""
    pca, looks = Pca.fit(small_library), Looks.fit(small_library)
    own = np.eye(9)[:, 2:3]
    third = Numbers(label="Third", names=("third",), points=own, spread=0.5, unit="1")
    coordinates = Coordinates((Scores.joint(pca, 2, spread=1.0), third))
    space = AnchoredSpace.of(LibraryRef.of(small_library), coordinates, looks, detour=np.inf)
    assert space.coordinates == ("score_1", "score_2", "third")
    assert [embedding.name for embedding in space.embeddings()] == ["Scores", "Third"]
    t = np.linspace(0, 1, 33)
    assert_allclose(space.leg(2, 7).at(t)[0] @ own[:, 0], 1 - t, atol=1e-9)


@given(st.integers(2, 4), st.lists(unit, min_size=1, max_size=5))
def test_ways_in_a_chain_take_equal_shares_of_t(n, ts):
    """Each leg is the way that it is, and they meet at the stops."""
    legs = [Way.of_channels([Way.between(i, i + 1, n + 1)]) for i in range(n)]
    chain, t = Way.chain(legs), np.array(ts)
    leg = np.minimum((t * n).astype(int), n - 1)
    within = [legs[i].at(np.array([n * x - i]))[:, 0] for i, x in zip(leg, t, strict=True)]
    assert_allclose(chain.at(t), np.stack(within, axis=1), atol=1e-12)


def test_channels_with_other_knots_share_those_of_all():
    one = Way.between(0, 1, 3, [(0.25, np.array([0.5, 0.0, 0.5]))])
    two = Way.between(0, 1, 3, [(0.75, np.array([0.0, 0.5, 0.5]))])
    way = Way.of_channels([one, two, one])
    assert_array_equal(way.knots, [0, 0.25, 0.75, 1])
    t = np.linspace(0, 1, 21)
    assert_allclose(way.at(t), np.stack([one.at(t), two.at(t), one.at(t)]), atol=1e-15)


def test_a_route_knows_its_library(small_library):
    route = halfway.route(small_library, "material-0", "material-1", space="linear", pace="uniform")
    assert route.library == (small_library.name, small_library.address, small_library.checksum)
    document = route.to_json([0.5])
    assert document["library_checksum"] == small_library.checksum
    again = Recipe.from_json({**document, **document["recipes"][0]})
    assert again.library == route.library


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"pace": "hasty"}, "there is no pace 'hasty': expected perceptual, people, uniform"),
        ({"space": "outer"}, "there is no space 'outer': expected one of anchored, paper, linear"),
    ],
)
def test_a_route_by_an_unknown_space_or_pace_is_refused(small_library, arguments, message):
    with pytest.raises(SpaceError, match=message):
        halfway.route(small_library, "material-0", "material-1", **arguments)


def test_a_recipe_of_an_unknown_blend_is_refused():
    document = {"library": "lib", "weights": {"a": 1.0}, "blend": "lobes-9"}
    with pytest.raises(RecipeError, match="there is no blend 'lobes-9': expected linear"):
        Recipe.from_json(document)
