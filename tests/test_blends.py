"""Blends: the laws that hold for each of them, and what each is for, on materials whose mixes are known."""

import json
from dataclasses import replace
from itertools import pairwise
from typing import get_args

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from strategies import convex_weights, random_tables

from halfway import Recipe, TabularBrdf, mix
from halfway.brdf import albedos, gloss, tabulate
from halfway.cli.options import Blending
from halfway.errors import RecipeError
from halfway.fit import OpenPbr
from halfway.fit.microfacet import ggx
from halfway.halfdiff import Grid
from halfway.judge import highlight, ladder_errors, ladders
from halfway.library import ProceduralLibrary
from halfway.look import PACING_SCENE, Looks, SphereOperator, appearance, cielab_difference
from halfway.look.small_tables import SmallTables
from halfway.models import builtin
from halfway.recipes import Blend, Mixer, aligned_mean
from halfway.space import AnchoredSpace, LinearSpace, Route

GRID = Grid.merl(8, 6, 10)
FINE = Grid.merl(90, 12, 12)
NAMES = ("pink-felt", "cherry-235", "chrome", "gold-paint", "teflon", "tungsten-carbide")
blends = pytest.mark.parametrize("blend", Blend)


@pytest.fixture(scope="module")
def noise():
    return ProceduralLibrary("noise", random_tables(5, GRID), grid=GRID)


@pytest.fixture(scope="module")
def materials():
    models = builtin("merl-abc").models
    return ProceduralLibrary("six", {name: models[name] for name in NAMES}, grid=FINE)


def recipe_of(library, weights, blend):
    return Recipe.from_dense(library, library.names, np.array(weights, np.float64), blend)


def metal(alpha):
    return OpenPbr([0.9, 0.6, 0.3], base_metalness=1.0, specular_roughness=alpha**0.5)


def plastic(alpha):
    return OpenPbr([0.5, 0.1, 0.05], specular_roughness=alpha**0.5)


def test_a_mixer_keeps_the_materials_of_each_blend_apart(noise):
    """Alone, and mixed in one blend after another, twice: as a mixer has it that does nothing else."""
    kept = Mixer(noise)
    alone = Recipe.of(noise, {"material-1": 1.0})
    half = Recipe.of(noise, {"material-1": 0.5, "material-2": 0.5})
    recipes = [replace(each, blend=blend) for each in (half, alone) for blend in Blend]
    for recipe in 2 * recipes:
        assert_array_equal(kept.mix(recipe).values, Mixer(noise).mix(recipe).values)


@blends
def test_a_material_alone_is_its_table(noise, blend):
    """To the rounding of 32 bits, also where another one's weight is too small to be seen."""
    expected = noise.brdf("material-2").values
    alone = mix(noise, Recipe.of(noise, {"material-2": 1.0}, blend)).values
    nearly = mix(noise, Recipe.of(noise, {"material-2": 1 - 1e-14, "material-4": 1e-14}, blend))
    assert np.array_equal(alone, expected, equal_nan=True)
    # A weight of 1e-14 is 1e-7 in front of a square root.
    assert_allclose(nearly.values, expected, rtol=2e-6, atol=1e-6)


@blends
@given(convex_weights(5), st.integers(0, 100))
def test_a_mix_is_not_negative_and_reciprocal(noise, blend, weights, seed):
    mixed = mix(noise, recipe_of(noise, [weights] * 3, blend))
    assert (mixed.values[~np.isnan(mixed.values)] >= 0).all()
    direction = np.random.default_rng(seed).normal(size=(2, 3)) * [1, 1, 0] + [0, 0, 1]
    wi, wo = direction / np.linalg.norm(direction, axis=1, keepdims=True)
    assert_allclose(mixed.eval(wi, wo), mixed.eval(wo, wi), rtol=1e-5)


@blends
def test_a_mix_reflects_no_more_than_it_receives(blend):
    """Mirrors and mattes that reflect all: whatever is stretched, 1 stays the limit."""
    ends = {
        "mirror": OpenPbr([1, 1, 1], base_metalness=1.0, specular_roughness=0.1),
        "satin": OpenPbr([1, 1, 1], base_metalness=1.0, specular_roughness=0.6),
    }
    library = ProceduralLibrary("ends", ends, grid=FINE)
    angles = np.radians([0, 20, 40, 60, 70, 80])
    most = np.max([albedos(library.brdf(name), angles) for name in ends], axis=0)
    for share in (0.02, 0.3, 0.7, 0.98):
        weights = {"mirror": share, "satin": 1 - share}
        mixed = mix(library, weights, blend=blend)
        assert (albedos(mixed, angles) <= np.maximum(most, 1) * (1 + 1e-5)).all()


@blends
def test_a_mean_lies_at_or_below_the_linear_one(materials, blend):
    """Jensen, of materials that have been brought to one width."""
    weights = np.full((3, 2), 0.5)
    rows = [materials.row(i) for i in (1, 2)]
    parts = [gloss.Gloss.of(row, FINE) for row in rows]
    of = Blend.LINEAR.mapping
    assert (
        aligned_mean(parts, weights, blend.mapping, FINE)
        <= aligned_mean(parts, weights, of, FINE) * (1 + 1e-5)
    )[~np.isnan(rows[0])].all()


@blends
def test_recipes_go_continuously_into_each_other(materials, blend):
    """Steps of t ten times smaller change the picture at most a fifth as much."""
    route = Route.through(LinearSpace.of(materials, blend=blend), ["pink-felt", "chrome"])
    looks = Looks.fit(materials, replace(PACING_SCENE, size=16))

    def largest_step(ts):
        pictures = appearance(looks.mix(route.at(ts), blend))
        return max(float(cielab_difference(a, b)) for a, b in pairwise(pictures))

    # At the ends a square root's slope is infinite.
    coarse = largest_step(np.linspace(0.1, 0.9, 9))
    assert largest_step(np.linspace(0.1, 0.9, 81)) < coarse / 5


@blends
def test_the_picture_of_a_mix_is_that_of_its_table(materials, blend):
    """Of small tables, where pictures do not mix: off by less than can be seen."""
    recipe = recipe_of(materials, [[0.2, 0.3, 0.1, 0.2, 0.1, 0.1]] * 3, blend)
    scene = replace(PACING_SCENE, size=32)
    looks = Looks.fit(materials, scene)
    operator = SphereOperator.of(scene, FINE)
    exact = operator.picture(mix(materials, recipe).values.reshape(3, -1))
    shown = looks.mix(recipe.weights[:, None], blend)[0]
    assert cielab_difference(appearance(shown), appearance(exact)) < 0.3


@blends
def test_how_a_mix_changes_is_what_mixes_nearby_differ_by(materials, blend):
    """Towards each material, on some columns. The slope of a stretched lobe jumps from cell to cell, within a step of .005."""
    weights, step = np.array([0.3, 0.2, 0.1, 0.2, 0.1, 0.1]), 0.005
    columns = np.arange(0, 270, 7)
    tables = SmallTables(materials)

    def mixed(towards, share):
        each = weights + share * (np.eye(6)[towards] - weights)
        whole = tables.mix(np.broadcast_to(each, (3, 1, 6)), blend)[:, 0]
        return whole.reshape(3, 90, 270)[..., columns].reshape(3, -1).astype(np.float64)

    mix, changes = tables.on(columns).about(weights, blend, np.arange(6))
    assert_allclose(mix, mixed(0, 0.0), rtol=1e-4)
    for i, change in enumerate(changes):
        between = (mixed(i, step) - mixed(i, -step)) / (2 * step)
        assert np.abs(change - between).sum() < 0.02 * np.abs(between).sum()


def test_lobes_bring_a_matte_and_a_mirror_to_one_highlight():
    """It narrows by about the same factor at every step, and is one lobe; a linear mix shows the mirror at once, over a blur."""
    library = ProceduralLibrary("ends", {"matte": metal(0.3), "mirror": metal(0.02)}, grid=FINE)

    def on_the_way(blend):
        mixes = (
            mix(library, {"matte": 1 - t, "mirror": t}, blend=blend)
            for t in np.linspace(0, 1, 11)[1:-1]
        )
        return [highlight(mixed) for mixed in mixes]

    lobes, linear = on_the_way(Blend.LOBES), on_the_way(Blend.LINEAR)
    steps = np.diff(np.log([each.width for each in lobes]))
    assert (steps < 0).all()
    assert steps.min() > 1.5 * steps.mean()
    assert {each.n_inflections for each in lobes} == {1}
    assert linear[0].width < 1.1 * linear[-1].width
    assert linear[3].n_inflections == 3


def test_the_width_of_a_lobe_is_proportional_to_that_of_its_microfacets():
    """The slopes of GGX are alpha times those of alpha = 1; shadowing bends the broad ones."""
    alphas = np.array([0.02, 0.04, 0.08])
    width = [gloss.Gloss.of(tabulate(plastic(alpha), FINE).values, FINE).width for alpha in alphas]
    assert_allclose(width / alphas, width[0] / alphas[0], rtol=0.1)


def test_a_stretched_lobe_is_the_wider_one():
    """GGX of alpha .05, made twice as wide, is GGX of alpha .1, to the interpolation between cells."""
    narrow, wide = (
        ggx(FINE.axes[0].centres(), alpha).astype("f4")[:, None] for alpha in (0.05, 0.1)
    )
    stretched = gloss.Stretch.by(2.0, FINE).rows(narrow, slice(None))
    assert_allclose(stretched, wide, rtol=0.012)


def test_what_does_not_stand_out_is_body():
    flat = TabularBrdf(np.where(FINE.mask(), 0.1, np.nan)[None].repeat(3, 0).astype("f4"), FINE)
    part = gloss.Gloss.of(flat.values, FINE)
    assert (part.width, part.gloss.max()) == (1.0, 0.0)


def test_what_falls_slowly_beyond_a_highlight_is_body():
    """A coat that reflects more towards grazing leaves less to the base: that is no lobe to be stretched."""
    table = tabulate(plastic(0.02), FINE)
    lobes, gloss_there = (
        gloss.to_lobes(table.values, FINE),
        gloss.Gloss.of(table.values, FINE).gloss,
    )
    beyond = np.degrees(FINE.axis("theta_h").centres()) > 31
    falls = np.nan_to_num(lobes[:, beyond][:, 0] - lobes[:, beyond][:, -1])
    assert falls.max() > 0.01
    assert not beyond[: gloss_there.shape[1]].any()
    assert gloss_there[:, -1].max() == 0
    assert gloss_there[:, 0].min() > 0


def test_the_width_of_a_highlight_is_not_that_of_the_slow_fall_beyond():
    """A faint highlight is as wide over a body that is level to 31 degrees as it is alone."""
    theta_h = FINE.axis("theta_h").centres()
    lobe = 1e-3 * ggx(theta_h, 0.02)
    body = 0.3 * np.minimum(1, np.cos(theta_h) / np.cos(np.radians(31)))

    def width(profile):
        values = np.broadcast_to(profile[:, None, None], FINE.shape)[None].repeat(3, 0)
        return gloss.Gloss.of(np.where(FINE.mask(), values, np.nan).astype("f4"), FINE).width

    assert_allclose(width(lobe + body), width(lobe), rtol=0.1)


def test_lobes_come_nearer_to_the_material_halfway():
    """Half of the linear mix's error in the metric log, in the median over rungs of GGX."""
    conductor, *_, changing = ladders(Grid.merl(60, 12, 12))
    for ladder in (conductor, changing):
        linear, lobes = (ladder_errors(ladder, blend) for blend in (Blend.LINEAR, Blend.LOBES))
        assert np.median(lobes.log / linear.log) < 0.5


def test_a_space_has_coordinates_in_its_blends_mapping(materials):
    for blend, unit in ((Blend.LINEAR, "1/sr"), (Blend.LOBES, "sr^-1/2")):
        space = AnchoredSpace.fit(materials, blend=blend)
        assert {group.unit for group in space.charts[0].coordinates.groups} == {unit}
        assert Route.through(space, ["teflon", "chrome"]).recipe(0.5).blend is blend


@blends
def test_a_recipe_brings_its_blend_back_from_json(noise, blend):
    recipe = Recipe.of(noise, {"material-0": 0.25, "material-1": 0.75}, blend)
    assert Recipe.from_json(json.loads(json.dumps(recipe.to_json()))).blend is blend


def test_a_recipe_without_a_blend_is_linear():
    assert Recipe.from_json({"library": "old", "weights": {"a": 1.0}}).blend is Blend.LINEAR


def test_the_command_line_has_every_blend():
    choices, _ = get_args(get_args(Blending)[0])
    assert get_args(choices) == tuple(str(blend) for blend in Blend)


def test_an_unknown_blend_is_said(noise):
    with pytest.raises(
        RecipeError, match="there is no blend 'optimal': expected linear, root, log"
    ):
        mix(noise, {"material-0": 1.0}, blend="optimal")


def test_a_mixer_of_lobes_travels_without_its_rows(noise):
    import pickle

    mixer = Mixer(noise)
    recipe = recipe_of(noise, [[0.2] * 5] * 3, Blend.LOBES)
    there = pickle.loads(pickle.dumps(mixer))
    assert np.array_equal(there.mix(recipe).values, mixer.mix(recipe).values, equal_nan=True)
