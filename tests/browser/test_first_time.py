"""Two tasks of somebody who sees the page for the first time, to their ends: a file that another program reads, and a film.

Each is walked at another width; what was looked for by eye on the way is held here: nothing that is said is cut away.
"""

import json
import struct
from collections.abc import Generator
from pathlib import Path

import numpy as np
import pytest
from conftest import (  # pyright: ignore[reportMissingImports]
    GRID,
    Explorer,
    frames,
    served,
)
from playwright.sync_api import Locator, expect

from halfway import attributes, mix
from halfway.formats import write_merl
from halfway.library import ProceduralLibrary
from halfway.models import builtin
from halfway.recipes import Recipe

WIDE = {"width": 1440, "height": 900}
PHONE = {"width": 390, "height": 844}
MATERIALS = (
    "black-obsidian",
    "chrome",
    "orange-paint",
    "pink-felt",
    "red-specular-plastic",
    "teflon",
)
YESTERDAY = {"library": "lab", "weights": {"red-specular-plastic": 0.5, "pink-felt": 0.5}}


@pytest.fixture(scope="module")
def library() -> ProceduralLibrary:
    models = builtin("merl-abc").models
    return ProceduralLibrary("lab", {name: models[name] for name in MATERIALS}, grid=GRID)


@pytest.fixture(scope="module")
def address(library: ProceduralLibrary) -> Generator[str]:
    with served(library) as address:
        yield address


def is_inside(element: Locator, panel: str) -> bool:
    """Whether all of an element can be seen in the panel around it."""
    return element.evaluate(
        """(element, panel) => {
          const [a, b] = [element, element.closest(panel)].map((each) => each.getBoundingClientRect());
          return a.height > 0 && a.left >= b.left && a.right <= b.right && a.top >= b.top && a.bottom <= b.bottom;
        }""",
        panel,
    )


@pytest.mark.parametrize("size", [WIDE, {"width": 800, "height": 900}])
def test_a_red_glossy_plastic_is_made_warmer_compared_and_sent_to_blender(
    explorer: Explorer, library: ProceduralLibrary, size: dict[str, int]
) -> None:
    page = explorer.page
    page.set_viewport_size(size)  # pyright: ignore[reportArgumentType]
    explorer.open("#space=anchored&stops=chrome,teflon&light=points")
    search = page.locator("[name=search]")
    search.fill("red glossy plastic")
    expect(page.locator("[role=option]")).to_have_text(["red-specular-plastic"])
    search.press("Enter")
    explorer.wait_for_recipe(["red-specular-plastic"])
    page.get_by_role("button", name="numbers", exact=True).click()
    expect(page.locator("[name=b]")).to_be_enabled()
    now = attributes(library.brdf("red-specular-plastic"))
    wished = f"b {now['b'] + 3:.3g}"
    explorer.ask("b", wished.removeprefix("b "))
    price = page.locator(".missing")
    expect(price).to_contain_text("Given up: ")
    assert is_inside(price, ".panel")
    page.get_by_role("button", name="Pin", exact=True).click()
    explorer.drop(".space", "shortlist.json", shortlist({"yesterday's red": YESTERDAY}))
    page.get_by_title("Compare with yesterday's red").click()
    ours, theirs = page.locator(".split span").all()
    expect(ours).to_have_text(f"red-specular-plastic, {wished}, L {now['L']:.3g}")
    expect(theirs).to_have_text("yesterday's red")
    assert is_inside(ours, ".area")
    assert is_inside(theirs, ".area")
    with page.expect_download() as file:
        page.get_by_role("button", name=".glb (Blender)").click()
    name = f"red-specular-plastic-{wished.replace(' ', '-')}-L-{now['L']:.3g}.glb"
    assert file.value.suggested_filename == name
    red, green, blue = base_colour(file.value.path().read_bytes())
    assert red > green > blue


def shortlist(recipes: dict[str, object]) -> bytes:
    """The file of a shortlist that was taken home before."""
    materials = [{"name": name, "recipe": recipe} for name, recipe in recipes.items()]
    return json.dumps({"format": 1, "library": "lab", "materials": materials}).encode()


def base_colour(glb: bytes) -> list[float]:
    """Of the one material in a file of glTF."""
    magic, version, _, length, kind = struct.unpack("<4sII I4s", glb[:20])
    assert (magic, version, kind) == (b"glTF", 2, b"JSON")
    (material,) = json.loads(glb[20 : 20 + length])["materials"]
    return material["pbrMetallicRoughness"]["baseColorFactor"][:3]


def test_a_measurement_of_ones_own_is_placed_walked_to_chrome_and_filmed(
    explorer: Explorer, library: ProceduralLibrary, tmp_path: Path
) -> None:
    mixed = mix(library, Recipe.of("lab", {"teflon": 0.9, "pink-felt": 0.1}))
    write_merl(tmp_path / "scan.binary", mixed)
    page = explorer.page
    page.set_viewport_size(PHONE)  # pyright: ignore[reportArgumentType]
    explorer.open("#space=linear&pace=uniform&stops=red-specular-plastic,orange-paint&light=points")
    explorer.wait_for_picture(1)
    explorer.drop(".space", "scan.binary", (tmp_path / "scan.binary").read_bytes())
    explorer.wait_for_recipe(["scan"])
    # Where it lies, in words.
    page.locator("[name=search]").fill("like sca")
    expect(page.locator("[role=option]").first).to_have_text("teflon")
    expect(page.locator(".results .note")).to_have_text("What people find most like scan")
    page.locator("[name=search]").fill("")
    page.locator(".chip[data-stop] > button").first.click()
    page.locator("[name=search]").fill("chrome")
    page.keyboard.press("Enter")
    explorer.wait_for_recipe(["chrome"])
    assert explorer.stops == ["chrome", "scan"]
    name, content = explorer.film(film_as="frames (zip of PNG)")
    assert name == "chrome-to-scan-frames.zip"
    first, *_, last = frames(content)
    # A mirror under three points is black all around; what was measured is nearly white.
    assert np.median(first[16:32, 16:32]) < 0.1 < np.median(last[16:32, 16:32])
    page.keyboard.press("Escape")
    name, content = explorer.film(film_as="video")
    assert name.startswith("chrome-to-scan.")
    assert len(content) > 1000
