"""Materials that depend on phi_h, on the page, beside Mitsuba: as they are, and turned against the tangent."""

from collections.abc import Generator
from dataclasses import replace

import numpy as np
import pytest
from conftest import (  # pyright: ignore[reportMissingImports]
    Explorer,
    in_mitsuba,
    served,
    squares,
    to_linear,
)
from numpy.testing import assert_allclose
from playwright.sync_api import expect
from roughconductor import anisotropic, plugin

from halfway.brdf import TabularBrdf
from halfway.library import ProceduralLibrary
from halfway.render.scenes import SCENES

ALPHAS = {"narrow": (0.05, 0.3), "wide": (0.2, 0.4)}
SIZE = {"width": 460, "height": 420}
TEAPOT = replace(SCENES["teapot"], points=SCENES["spheres"].points, ground=False)
SCENE_OF = {"sphere": SCENES["spheres"], "teapot": TEAPOT}


@pytest.fixture(scope="module")
def scale() -> float:
    return 0.5


@pytest.fixture(scope="module")
def tables() -> dict[str, TabularBrdf]:
    return {name: anisotropic(*alphas) for name, alphas in ALPHAS.items()}


@pytest.fixture(scope="module")
def address(tables: dict[str, TabularBrdf]) -> Generator[str]:
    grid = tables["narrow"].grid
    with served(ProceduralLibrary("brushed", dict(tables), grid=grid)) as address:
        yield address


def show(explorer: Explorer, name: str, view: str) -> None:
    """One material, its exposure halved."""
    explorer.page.set_viewport_size(SIZE)
    other = next(each for each in ALPHAS if each != name)
    explorer.open(f"#space=linear&pace=uniform&stops={name},{other}&t=0&exposure=-1&{view}")
    explorer.wait_for_picture()


def difference(shown: np.ndarray, rendered: np.ndarray) -> float:
    """Mean absolute difference of linear values in squares of pixels inside the object, over their mean."""
    opaque = shown[..., 3] == 255
    whole = opaque & np.roll(opaque, 1, 0) & np.roll(opaque, 1, 1)
    inside = squares(whole[..., None])[..., 0] == 1
    expected = squares((rendered / 2).clip(0, 1))
    found = squares(to_linear(shown))
    return np.abs(found - expected)[inside].mean() / expected[inside].mean()


# The truth where it stands as the model does; turned, the same table in Mitsuba, which has its own tests against the model.
@pytest.mark.parametrize(
    ("name", "shape", "light", "grain"),
    [
        ("narrow", "sphere", "points", 0),
        ("narrow", "sphere", "points", 37),
        ("narrow", "sphere", "studio", 37),
        ("narrow", "teapot", "points", 37),
        ("wide", "sphere", "studio", 0),
    ],
)
def test_the_picture_is_that_of_mitsuba(
    explorer: Explorer,
    tables: dict[str, TabularBrdf],
    name: str,
    shape: str,
    light: str,
    grain: int,
) -> None:
    show(explorer, name, f"shape={shape}&light={light}&grain={grain}")
    explorer.wait_until_settled()
    shown = explorer.drawn()
    scene = SCENE_OF[shape] if light == "points" else replace(SCENE_OF[shape], points=())
    truth = tables[name] if grain else plugin(*ALPHAS[name])
    rendered = in_mitsuba(scene, truth, shown, spp=64, turn_degrees=grain)
    # Turned by 37 degrees and drawn as if it were not, the sphere is 40 % off at least.
    assert difference(shown, rendered) < 0.025


SHEET = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
ALONG_X = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
ALONG_Y = "vt 0 1\nvt 0 0\nvt 1 0\nvt 1 1\n"


def on_sheet(explorer: Explorer, texture_coordinates: str) -> np.ndarray:
    """The picture of the present material on an upright sheet."""
    faces = "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n" if texture_coordinates else "f 1 2 3\nf 1 3 4\n"
    body = (SHEET + texture_coordinates + faces).encode()
    file = {"name": "sheet.obj", "mimeType": "text/plain", "buffer": body}
    before = explorer.drawn()
    explorer.page.set_input_files("input[aria-label='Mesh file']", file)
    explorer.drawn_after(before)
    explorer.wait_until_settled()
    return to_linear(explorer.drawn())


def test_the_tangent_of_a_mesh_is_where_its_first_texture_coordinate_grows(
    explorer: Explorer,
) -> None:
    said = explorer.page.get_by_text("sheet.obj has no texture coordinates")
    show(explorer, "narrow", "light=points&grain=0")
    upright, across = (on_sheet(explorer, along) for along in (ALONG_Y, ALONG_X))
    show(explorer, "narrow", "light=points&grain=90")
    turned = on_sheet(explorer, ALONG_X)
    expect(said).to_have_count(0)
    level = on_sheet(explorer, "")
    expect(said).to_be_visible()
    assert_allclose(turned, upright, atol=0.02)
    assert_allclose(level, upright, atol=0.02)
    assert np.abs(across - upright).max() > 0.1
