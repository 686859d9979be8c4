"""Looking before choosing: the materials side by side, filtered and searched, and what the pointer rests on drawn on the object."""

from contextlib import suppress

import numpy as np
import pytest
from conftest import Explorer, to_linear  # pyright: ignore[reportMissingImports]
from patience import wait_until
from playwright.sync_api import TimeoutError as TooLate
from playwright.sync_api import expect

from halfway.library import ProceduralLibrary
from halfway.people import distances

SIZE = {"width": 1280, "height": 900}
SMALL = {"width": 460, "height": 560}
PAIR = "#space=linear&pace=uniform&stops=cherry-235,gold-paint&light=points&t="


def shown(explorer: Explorer) -> list[str]:
    return explorer.page.locator(".grid button:visible").all_text_contents()


def by_likeness(library: ProceduralLibrary, name: str) -> list[str]:
    """The materials, those first that people would find most alike to one."""
    order = distances(library)[library.index(name)].argsort()
    return [library.names[i] for i in order]


def test_the_materials_side_by_side_are_filtered_ordered_and_chosen(
    explorer: Explorer, library: ProceduralLibrary
) -> None:
    page = explorer.page
    page.set_viewport_size(SIZE)
    explorer.open(PAIR + "0&map=Grid")
    expect(page.locator(".grid button:visible")).to_have_count(10)
    page.locator("[name=kind]").select_option("paint")
    assert shown(explorer) == ["gold-paint", "pearl-paint", "red-metallic-paint"]
    # Read off the tables, it is there a moment later.
    page.locator("[name=gloss]").select_option("satin")
    expect(page.locator(".grid button:visible")).to_have_text(["gold-paint", "pearl-paint"])
    expect(page.locator(".filters .count")).to_have_text("2 of 10")
    page.locator("[name=kind]").select_option("")
    page.locator("[name=gloss]").select_option("")
    page.locator("[name=order]").select_option("gloss")
    assert shown(explorer)[-1] == "chrome"
    # By what people say, of what is shown.
    page.locator("[name=order]").select_option("likeness")
    wait_until(lambda: shown(explorer) == by_likeness(library, "cherry-235"), explorer.pause)
    page.locator("[name=search]").fill("like chrome")
    results = page.locator(".results li")
    expect(results).to_have_text(by_likeness(library, "chrome")[1:])
    page.locator("[name=search]").fill("plastic like chrome")
    expect(results).to_have_text(["green-plastic", "yellow-matte-plastic", "teflon"])
    page.locator("[name=search]").fill("")
    page.locator(".grid").get_by_role("button", name="teflon").click()
    wait_until(lambda: explorer.stops == ["cherry-235", "teflon"], explorer.pause)


@pytest.mark.parametrize(
    ("query", "names"),
    [
        ("glossy plastic", ["green-plastic"]),
        ("shiny", ["chrome", "red-metallic-paint", "green-plastic"]),
        ("car", ["pearl-paint", "red-metallic-paint"]),
        ("felt", ["pink-felt"]),
    ],
)
def test_the_search_knows_what_materials_are(
    explorer: Explorer, query: str, names: list[str]
) -> None:
    explorer.open(PAIR + "0")
    explorer.page.locator("[name=search]").fill(query)
    results = explorer.page.locator(".results li")
    # How glossy they are is read off the tables, and there a moment later.
    wait_until(lambda: sorted(results.all_text_contents()) == sorted(names), explorer.pause)


def test_what_the_pointer_rests_on_is_drawn_before_it_is_chosen(explorer: Explorer) -> None:
    page = explorer.page
    page.set_viewport_size(SMALL)
    explorer.open(PAIR + "1&map=Grid")
    explorer.wait_until_settled()
    gold = to_linear(explorer.drawn())
    chrome = page.locator(".grid").get_by_role("button", name="chrome")
    chrome.hover()
    expect(page.locator(".ghost")).to_contain_text("chrome")
    page.wait_for_selector(".haunted")
    wait_until(lambda: difference(to_linear(explorer.drawn()), gold) > 0.2, explorer.pause)
    explorer.wait_until_settled()
    ghost = to_linear(explorer.drawn())
    # Nothing is chosen: the recipe and the stops stay, and leaving brings the material back.
    assert (explorer.recipe, explorer.stops) == (["gold-paint"], ["cherry-235", "gold-paint"])
    page.mouse.move(5, 5)
    expect(page.locator(".ghost")).to_be_hidden()
    wait_until(lambda: difference(to_linear(explorer.drawn()), gold) < 0.1, explorer.pause)
    chrome.click()
    explorer.wait_for_recipe(["chrome"])
    expect(page.locator(".haunted")).to_have_count(0)
    wait_until(lambda: difference(to_linear(explorer.drawn()), ghost) < 0.1, explorer.pause)


def test_a_place_in_the_space_is_looked_at_before_going_there(explorer: Explorer) -> None:
    page = explorer.page
    page.set_viewport_size(SIZE)
    explorer.open(PAIR.replace("linear", "anchored") + "0.5&map=Body%20colour")
    explorer.wait_for_picture(1)
    here = page.locator(".here").bounding_box()
    assert here is not None
    before = explorer.recipe
    # Beside the dot no material is at some place.
    place = page.locator(".ghost", has_text="%")
    for x, y in [(16, 16), (-16, -16), (16, -16), (-16, 16), (20, 0), (0, 20), (-20, 0), (0, -20)]:
        page.mouse.move(here["x"] + 6 + x, here["y"] + 6 + y)
        with suppress(TooLate):
            place.wait_for(timeout=10_000)
            break
    expect(place).to_be_visible()
    assert explorer.recipe == before
    page.mouse.move(5, 5)
    expect(page.locator(".ghost")).to_be_hidden()


def difference(picture: np.ndarray, other: np.ndarray) -> float:
    """As a share of the other's mean; neither small nor large where they are not as large."""
    if picture.shape != other.shape:
        return np.nan
    return float(np.abs(picture - other).mean() / other.mean())
