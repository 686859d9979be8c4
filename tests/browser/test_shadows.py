"""The shadows that an object casts on itself: the page's teapot beside Mitsuba's."""

from dataclasses import replace

import numpy as np
import pytest
from conftest import (  # pyright: ignore[reportMissingImports]
    Explorer,
    in_mitsuba,
    squares,
    to_linear,
)

from halfway.library import ProceduralLibrary
from halfway.render import SCENES

SIZE = {"width": 720, "height": 620}
# The page's teapot stands alone.
TEAPOT = replace(SCENES["teapot"], points=SCENES["spheres"].points, ground=False)
MATERIAL = "pink-felt"
"""Matte: a shadow is as dark as it is, and little else is."""


@pytest.fixture(scope="module")
def scale() -> float:
    return 0.5


@pytest.mark.parametrize(("light", "samples", "spp"), [("points", 8, 64), ("studio", 48, 256)])
def test_the_teapot_is_shadowed_as_in_mitsuba(
    explorer: Explorer, library: ProceduralLibrary, light: str, samples: int, spp: int
) -> None:
    explorer.page.set_viewport_size(SIZE)
    explorer.open(f"#space=linear&stops={MATERIAL},teflon&t=0&shape=teapot&light={light}")
    explorer.wait_for_whole_picture(samples)
    shown = explorer.drawn()
    scene = TEAPOT if light == "points" else replace(TEAPOT, points=())
    rendered = squares(in_mitsuba(scene, library.brdf(MATERIAL), shown, spp=spp).clip(0, 1))
    linear = squares(to_linear(shown))
    inside = squares(shown[..., 3:])[..., 0] == 255
    assert inside.sum() > 100
    # Without shadows 2.7 % under the three lights, and 4.2 % in the studio.
    assert np.abs(linear - rendered)[inside].mean() < 0.02 * rendered[inside].mean()
