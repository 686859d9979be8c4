"""How long a material takes to show itself in a notebook: under .3 s is at once."""

import pytest

from halfway._display import material_html, route_png
from halfway.library import open_library
from halfway.recipes import Recipe
from halfway.space import LinearSpace, Route


@pytest.fixture(scope="module")
def library():
    return open_library("builtin:merl-abc")


def bench_showing_a_table(benchmark, library):
    benchmark(material_html, library.brdf("gold-paint"))


def bench_showing_a_recipe(benchmark, library):
    recipe = Recipe.from_text(library.name, "gold-paint=0.4, teflon=0.3, chrome=0.2, nylon=0.1")
    benchmark(material_html, recipe)


def bench_showing_a_route(benchmark, library):
    """Through eight stops: as many materials as a route between two of them meets."""
    space = LinearSpace.of(library)
    benchmark(route_png, Route.through(space, library.names[:8]))
