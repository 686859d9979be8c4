"""How tables, recipes and routes show themselves in a notebook."""

import io
import subprocess
import sys

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image

from halfway.brdf import TabularBrdf
from halfway.brdf.portrait import GAP, PORTRAIT_SCENE, STRIP_SCENE, portrait
from halfway.halfdiff import Grid
from halfway.library import ProceduralLibrary, library_called
from halfway.space import LinearSpace, Recipe, Route
from halfway.space.portraits import N_SPHERES

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
    picture = pixels(matte((0.8, 0.02, 0.02))._repr_png_())
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
    assert_allclose(pixels(recipe._repr_png_()), pixels(mixed._repr_png_()), atol=1)


def test_a_route_is_a_row_of_spheres_from_its_first_stop_to_its_last(
    library: ProceduralLibrary,
) -> None:
    route = Route.through(LinearSpace(library.name, library.names), ["red", "green"])
    row = pixels(route._repr_png_())
    size = STRIP_SCENE.size
    assert row.shape == (size, N_SPHERES * size + (N_SPHERES - 1) * GAP, 4)
    middles = row[size // 2, size // 2 :: size + GAP, :3]
    assert (np.diff(middles[:, 0]) < 0).all()
    assert (np.diff(middles[:, 1]) > 0).all()


def test_a_recipe_finds_its_library_while_someone_holds_it(library: ProceduralLibrary) -> None:
    assert library_called("crayons") is library
    newer = ProceduralLibrary("crayons", {"red": matte((1, 0, 0)), "blue": matte((0, 0, 1))})
    assert library_called("crayons") is newer


def test_a_recipe_whose_library_is_out_of_reach_is_text_alone(library: ProceduralLibrary) -> None:
    assert Recipe.of("nowhere", {"red": 1.0})._repr_png_() is None
    assert Recipe.of(library.name, {"octarine": 1.0})._repr_png_() is None


def test_a_route_says_where_it_goes(library: ProceduralLibrary) -> None:
    route = Route.through(LinearSpace(library.name, library.names), ["red", "green", "white"])
    assert repr(route) == "Route(red to green to white, linear, uniform pace, 'crayons')"


def test_showing_loads_neither_mitsuba_nor_a_server() -> None:
    code = (
        "import sys; from halfway import Recipe; Recipe.from_text('builtin:merl-abc', 'teflon=1')._repr_png_();"
        "print([m for m in ('mitsuba', 'drjit', 'fastapi', 'matplotlib') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
