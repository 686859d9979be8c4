"""Recipes: what a person or a program may write, and what is refused."""

import json

import numpy as np
import pytest
from hypothesis import given
from numpy.testing import assert_allclose
from strategies import convex_weights

from halfway import Grid, Recipe, TabularBrdf
from halfway.errors import RecipeError
from halfway.library import ProceduralLibrary

NAMES = tuple("abcdef")


def test_from_text():
    recipe = Recipe.from_text("lib", " gold-paint = .7, teflon=0.3 ")
    assert recipe.names == ("gold-paint", "teflon")
    assert_allclose(recipe.weights, [[0.7, 0.3]] * 3)


@pytest.mark.parametrize("name", ["gold=paint", "red, matte", "scan 12:30", "a, b=c"])
def test_a_name_may_hold_commas_and_signs_of_equality(name):
    recipe = Recipe.from_text("lib", f"{name}=0.5, chalk = .5")
    assert recipe.names == (name, "chalk")
    assert_allclose(recipe.weights, 0.5)


def library_of(*names):
    table = TabularBrdf(np.ones((3, 1, 1, 1), np.float32), Grid.merl(1, 1, 1))
    return ProceduralLibrary("lib", dict.fromkeys(names, table), grid=table.grid)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("gold=paint=0.5, café=.5", {"gold=paint": 0.5, "café": 0.5}),
        ("red, matte=0.5, café = 5e-1,", {"red, matte": 0.5, "café": 0.5}),
        ("12:30=0.25,, two\nlines=0.75", {"12:30": 0.25, "two\nlines": 0.75}),
        ("gold=1", {"gold": 1.0}),
    ],
)
def test_names_are_told_from_what_stands_between_them(text, expected):
    """Of a library that is only named, and of one with other names that begin like these."""
    for library in ("lib", library_of(*expected, "red", "gold", "gold=", "2")):
        assert Recipe.from_text(library, text).to_json()["weights"] == expected


def test_of_two_names_that_fit_the_longer_is_meant():
    recipe = Recipe.from_text(library_of("b", "c", "b=0.5, c"), "b=0.5, c=0.25, b=0.75")
    assert recipe.to_json()["weights"] == {"b=0.5, c": 0.25, "b": 0.75}


def test_a_comma_in_no_name_of_the_library_is_between_two():
    with pytest.raises(RecipeError, match="'gold' has no weight: expected NAME=WEIGHT"):
        Recipe.from_text(library_of("gold", "silver"), "gold, silver=1")


def test_weights_that_sum_to_100_are_parts_of_a_hundred_and_said_to_be():
    with pytest.warns(UserWarning, match="parts of a hundred"):
        recipe = Recipe.from_text("lib", "gold=70, chalk=30")
    assert_allclose(recipe.weights, [[0.7, 0.3]] * 3)


def test_per_channel():
    weights = {"r": {"a": 1}, "g": {"a": 0.5, "b": 0.5}, "b": {"b": 1}}
    recipe = Recipe.of("lib", weights)
    assert_allclose(recipe.weights, [[1, 0], [0.5, 0.5], [0, 1]])
    assert recipe.to_json() == {
        "library": "lib",
        "weights": {c: dict(w) for c, w in weights.items()},
    }


@given(convex_weights(6), convex_weights(6), convex_weights(6))
def test_json_round_trip(r, g, b):
    recipe = Recipe.from_dense("lib", NAMES, np.stack([r, g, b]))
    back = Recipe.from_json(json.loads(json.dumps(recipe.to_json())))
    assert back.library.name == "lib"
    for name, column in zip(back.names, back.weights.T, strict=True):
        assert_allclose(column, recipe.weights[:, recipe.names.index(name)], rtol=1e-12)


def test_materials_without_weight_are_left_out():
    dense = np.array([[0, 1.0, 0]] * 3)
    assert Recipe.from_dense("lib", ("a", "b", "c"), dense).names == ("b",)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("gold=0.7, teflon=0.2", r"channel r sum to 0.9: they must sum to 1. Divide each by 0.9."),
        (
            "gold=1.5, teflon=-0.5",
            r"the weight of teflon in channel r is -0.5: a recipe takes numbers that are not",
        ),
        ("gold=nan", "the weight of gold in channel r is nan"),
        ("gold=much", "the weight of gold, 'much', is no number"),
        ("gold", "'gold' has no weight: expected NAME=WEIGHT"),
        ("gold=0.5, gold=0.5", "gold is given twice"),
        ("", "has no weight"),
        ("gold=0.5, teflon", "'teflon' has no weight"),
    ],
)
def test_what_is_no_recipe_says_why(text, message):
    with pytest.raises(RecipeError, match=message):
        Recipe.from_text("lib", text)


@pytest.mark.parametrize(
    "document",
    [None, [], "x", {}, {"weights": 3}, {"weights": {"a": "1"}}, {"weights": {"a": True}}],
)
def test_json_of_something_else_is_refused(document):
    with pytest.raises(RecipeError):
        Recipe.from_json(document)
