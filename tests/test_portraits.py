"""How tables, recipes and routes show themselves in a notebook."""

import io
import subprocess
import sys

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image

from halfway._display import N_SPHERES, material_html
from halfway.brdf import TabularBrdf
from halfway.halfdiff import Grid
from halfway.library import ProceduralLibrary
from halfway.look import portrait, recipes_png, table_png
from halfway.look.portraits import GAP, PORTRAIT_SCENE, STRIP_SCENE
from halfway.recipes import Recipe
from halfway.space import LinearSpace, Route

GRID = Grid.merl(12, 8, 10)


@pytest.fixture
def library() -> ProceduralLibrary:
    """Matte spheres of plain colours."""
    colours = {"red": (0.8, 0.02, 0.02), "green": (0.02, 0.5, 0.02), "white": (0.8, 0.8, 0.8)}
    return ProceduralLibrary(
        "crayons", {name: matte(colour) for name, colour in colours.items()}, grid=GRID
    )


def matte(reflectance: tuple[float, float, float], grid: Grid = GRID) -> TabularBrdf:
    values = np.ones((3, *grid.shape), np.float32)
    return TabularBrdf(values * np.reshape(reflectance, (3, 1, 1, 1)).astype("f4") / np.pi, grid)


def pixels(png: bytes | None) -> np.ndarray:
    assert png is not None
    return np.asarray(Image.open(io.BytesIO(png)), float)


def test_a_table_is_a_sphere_of_its_colour_on_nothing() -> None:
    picture = pixels(table_png(matte((0.8, 0.02, 0.02))))
    size = PORTRAIT_SCENE.size
    assert picture.shape == (size, size, 4)
    r, g, b, alpha = picture[size // 2, size // 2]
    assert (r > 150, g < 60, b < 60, alpha) == (True, True, True, 255)
    # The corners are empty and the rim is soft.
    assert_array_equal(picture[[0, 0, -1, -1], [0, -1, 0, -1]], 0)
    assert (np.abs(picture[..., 3] - 128) < 120).any()
    assert_allclose(picture[..., 3].sum() / 255, np.pi * (size / 2) ** 2, rtol=0.01)


def test_a_portrait_of_white_is_the_irradiance_of_the_scene() -> None:
    # f = 1/pi under lights that make a white matte surface 1.0 at its brightest (PACING_SCENE).
    assert_allclose(portrait(matte((1, 1, 1)).values, GRID).max(), 1.0, atol=0.02)


def test_a_recipe_is_the_mix_of_its_materials_portraits(library: ProceduralLibrary) -> None:
    recipe = Recipe.of(library.name, {"red": 0.25, "green": 0.75})
    mixed = matte(tuple(0.25 * np.array([0.8, 0.02, 0.02]) + 0.75 * np.array([0.02, 0.5, 0.02])))
    shown = recipes_png(library, recipe.names, recipe.weights[:, None], recipe.blend)
    assert_allclose(pixels(shown), pixels(table_png(mixed)), atol=1)


def test_a_route_is_a_row_of_spheres_from_its_first_stop_to_its_last(
    library: ProceduralLibrary,
) -> None:
    route = Route.through(LinearSpace.of(library), ["red", "green"])
    weights = route.at(np.linspace(0, 1, N_SPHERES))
    row = pixels(recipes_png(library, route.names, weights, route.blend))
    size = STRIP_SCENE.size
    assert row.shape == (size, N_SPHERES * size + (N_SPHERES - 1) * GAP, 4)
    middles = row[size // 2, size // 2 :: size + GAP, :3]
    assert (np.diff(middles[:, 0]) < 0).all()
    assert (np.diff(middles[:, 1]) > 0).all()


def test_a_recipe_whose_library_is_out_of_reach_is_text_alone() -> None:
    assert material_html(Recipe.of("nowhere", {"red": 1.0})) is None
    assert material_html(Recipe.of("builtin:merl-abc", {"octarine": 1.0})) is None


def test_a_notebook_shows_materials_as_spheres_beside_their_numbers() -> None:
    code = """
import base64, re
from IPython.core.interactiveshell import InteractiveShell
shell = InteractiveShell.instance()
import halfway
recipe = halfway.Recipe.from_text("builtin:merl-abc", "teflon=1")
for value in (recipe, halfway.open_library("builtin:merl-abc").material("teflon")):
    html = shell.display_formatter.format(value)[0]["text/html"]
    picture = base64.b64decode(re.search('base64,([^"]*)', html)[1])
    assert picture.startswith(b"\\x89PNG"), html
    shown = float(re.search(r"albedo +(\\S+)", html)[1])
    assert abs(shown / halfway.attributes(value)["albedo"] - 1) < 1e-3, html
"""
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_route_says_where_it_goes(library: ProceduralLibrary) -> None:
    route = Route.through(LinearSpace.of(library), ["red", "green", "white"])
    assert repr(route) == "Route(red to green to white, linear, uniform pace, 'crayons')"


def test_showing_loads_neither_mitsuba_nor_a_server() -> None:
    code = (
        "import sys; from halfway import Recipe; from halfway._display import material_html;"
        "material_html(Recipe.from_text('builtin:merl-abc', 'teflon=1'));"
        "print([m for m in ('mitsuba', 'drjit', 'fastapi', 'matplotlib') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
