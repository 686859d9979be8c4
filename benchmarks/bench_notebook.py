"""How long a material takes to show itself in a notebook: under .3 s is at once."""

import pytest

from halfway.library import open_library
from halfway.recipes import Recipe
from halfway.space import LinearSpace, Route


@pytest.fixture(scope="module")
def library():
    return open_library("builtin:merl-abc")


def bench_showing_a_table(benchmark, library):
    benchmark(library.brdf("gold-paint")._repr_png_)


def bench_showing_a_recipe(benchmark, library):
    recipe = Recipe.from_text(library.name, "gold-paint=0.4, teflon=0.3, chrome=0.2, nylon=0.1")
    benchmark(recipe._repr_png_)


def bench_showing_a_route(benchmark, library):
    """Through eight stops: as many materials as a route between two of them meets."""
    space = LinearSpace.of(library)
    benchmark(Route.through(space, library.names[:8])._repr_png_)
