"""What a person keeps, brings and takes home: the shortlist, a recipe, a measurement."""

import json
from dataclasses import replace
from pathlib import Path
from zipfile import ZipFile

from conftest import (  # pyright: ignore[reportMissingImports]
    GRID,
    MATERIALS,
    Explorer,
    opened,
    served,
)
from playwright.sync_api import expect

from halfway.formats import write_merl
from halfway.library import ProceduralLibrary
from halfway.models import builtin
from halfway.recipes import Recipe, mix

SIZE = {"width": 1280, "height": 900}
PAIR = "#space=linear&pace=uniform&stops=cherry-235,gold-paint&light=points&t="


def kept(explorer: Explorer) -> list[str]:
    return explorer.page.locator(".kept .name").all_text_contents()


def test_what_is_kept_is_compared_named_and_taken_to_another_machine(
    explorer: Explorer, library: ProceduralLibrary, tmp_path: Path
) -> None:
    page = explorer.page
    page.set_viewport_size(SIZE)
    explorer.open(PAIR + "0.25")
    explorer.wait_for_recipe(["cherry-235", "gold-paint"])
    page.get_by_role("button", name="Pin", exact=True).click()
    explorer.set_t(0.75)
    page.locator(".live").press("p")
    assert kept(explorer) == ["0.25 cherry-235 to gold-paint", "0.75 cherry-235 to gold-paint"]
    page.get_by_label("order of 0.75").click()
    page.locator("[name=name]").fill("warm")
    page.locator("[name=note]").fill("for the lid")
    page.get_by_role("button", name="Earlier").click()
    assert kept(explorer) == ["warm", "0.25 cherry-235 to gold-paint"]
    # Any two, in one picture: neither is a stop, and the route stays where it is.
    explorer.set_t(0.5)
    page.get_by_title("warm: for the lid").click()
    assert page.locator(".recipe .share").all_text_contents() == ["75 %", "25 %"]
    page.get_by_title("Compare with 0.25").click()
    assert page.locator(".split span").all_text_contents() == kept(explorer)
    page.reload()
    page.wait_for_selector("#app.ready")
    assert kept(explorer) == ["warm", "0.25 cherry-235 to gold-paint"]
    page.get_by_role("button", name="Take home").click()
    page.get_by_label("MERL file").check()
    with page.expect_download() as file:
        page.get_by_role("button", name="Save", exact=True).click()
    with ZipFile(file.value.path()) as archive:
        shortlist = archive.read("shortlist.json")
        recipe = Recipe.from_json(json.loads(archive.read("warm.json")))
        write_merl(tmp_path / "warm.binary", mix(library, recipe))
        assert archive.read("warm.binary") == (tmp_path / "warm.binary").read_bytes()
    assert page.context.browser is not None
    with opened(page.context.browser, viewport=SIZE) as elsewhere:
        there = replace(explorer, page=elsewhere)
        there.open(PAIR + "0.5")
        there.drop(".space", "shortlist.json", shortlist)
        expect(elsewhere.get_by_title("warm: for the lid")).to_be_visible()
        assert kept(there) == ["warm", "0.25 cherry-235 to gold-paint"]


def test_a_recipe_that_is_dropped_is_shown_and_one_of_elsewhere_is_refused(
    explorer: Explorer,
) -> None:
    explorer.page.set_viewport_size(SIZE)
    explorer.open(PAIR + "0.5")
    weights = {"teflon": 0.4, "chrome": 0.6}
    explorer.drop(
        ".space", "mine.json", json.dumps({"library": "browser", "weights": weights}).encode()
    )
    explorer.wait_for_recipe(["chrome", "teflon"])
    assert kept(explorer) == ["mine"]
    explorer.drop(
        ".space", "other.json", json.dumps({"library": "other", "weights": weights}).encode()
    )
    said = explorer.page.locator(".space .problem")
    expect(said).to_contain_text("other.json is of the library other, and this is browser")


def test_a_measurement_that_is_dropped_is_a_stop(explorer: Explorer, tmp_path: Path) -> None:
    models = builtin("merl-abc").models
    library = ProceduralLibrary("own", {name: models[name] for name in MATERIALS}, grid=GRID)
    recipe = Recipe.of("own", {"teflon": 0.5, "gold-paint": 0.5})
    write_merl(tmp_path / "scan.binary", mix(library, recipe))
    explorer.page.set_viewport_size(SIZE)
    with served(library) as address:
        explorer.expected = "Failed to load resource"
        explorer = replace(explorer, address=address)
        explorer.open(PAIR + "0.5")
        explorer.page.wait_for_selector(".here")
        explorer.drop(".space", "notes.binary", b"nothing")
        expect(explorer.page.locator(".space .problem")).to_contain_text("notes.binary")
        explorer.drop(".space", "scan.binary", (tmp_path / "scan.binary").read_bytes())
        explorer.wait_for_recipe(["scan"])
        assert explorer.stops == ["cherry-235", "scan"]
        explorer.wait_for_picture(1)
