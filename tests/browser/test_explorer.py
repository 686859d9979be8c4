"""What a person does with the explorer."""

import json
from pathlib import Path

import pytest
from conftest import Explorer  # pyright: ignore[reportMissingImports]
from PIL import Image
from playwright.sync_api import expect

from halfway import route
from halfway.formats import write_merl
from halfway.library import ProceduralLibrary
from halfway.recipes import Recipe, mix

PAIR = "#space=linear&pace=uniform&stops=cherry-235,gold-paint&light=points"


def test_the_first_picture_comes(explorer: Explorer) -> None:
    explorer.open()
    explorer.wait_for_picture()
    assert len(explorer.stops) == 2


def test_moving_t_changes_the_recipe_and_not_the_samples(explorer: Explorer) -> None:
    explorer.page.set_viewport_size({"width": 460, "height": 560})
    explorer.open(PAIR + "&t=0.5")
    explorer.wait_until_settled()
    before = picture(explorer)
    explorer.set_t(0.25)
    assert explorer.page.locator(".recipe .share").all_text_contents() == ["75 %", "25 %"]
    explorer.page.wait_for_function("() => document.querySelector('.t b').textContent === '0.250'")
    explorer.wait_for_picture(128)
    # No sample is drawn again: only the weights of the sum are others.
    assert explorer.page.locator(".material .note").inner_text() == "128 / 128 samples"
    assert picture(explorer) != before


def test_at_a_stop_the_recipe_is_that_material(explorer: Explorer) -> None:
    explorer.open("#space=paper&pace=uniform&stops=teflon,chrome,pink-felt&t=0.5&light=points")
    explorer.page.wait_for_selector(".recipe .name")
    assert explorer.recipe == ["chrome"]


def test_the_search_sets_a_stop_and_undo_takes_it_back(explorer: Explorer) -> None:
    explorer.open(PAIR)
    explorer.page.wait_for_selector(".recipe .name")
    explorer.page.keyboard.press("/")
    explorer.page.keyboard.type("pearl")
    explorer.page.keyboard.press("Enter")
    assert explorer.stops == ["cherry-235", "pearl-paint"]
    explorer.page.keyboard.press("Control+z")
    assert explorer.stops == ["cherry-235", "gold-paint"]
    explorer.page.keyboard.press("Control+Shift+z")
    assert explorer.stops == ["cherry-235", "pearl-paint"]


def test_a_search_without_a_match_says_so(explorer: Explorer) -> None:
    explorer.open(PAIR)
    explorer.page.locator("[name=search]").fill("unobtainium")
    assert explorer.page.locator(".results").inner_text().startswith("None fits")


def test_stops_are_added_and_removed(explorer: Explorer) -> None:
    explorer.open(PAIR)
    explorer.page.get_by_label("Add a stop").click()
    explorer.page.locator("[name=search]").fill("teflon")
    explorer.page.keyboard.press("Enter")
    assert explorer.stops == ["cherry-235", "gold-paint", "teflon"]
    explorer.page.get_by_label("Remove gold-paint").click()
    assert explorer.stops == ["cherry-235", "teflon"]


def test_a_click_in_the_space_sets_a_stop(explorer: Explorer) -> None:
    explorer.open(PAIR)
    explorer.page.wait_for_selector(".here")
    box = explorer.page.locator(".cloud").bounding_box()
    assert box is not None
    for x, y in (
        (x, y) for y in range(60, int(box["height"]), 9) for x in range(10, int(box["width"]), 9)
    ):
        explorer.page.mouse.move(box["x"] + x, box["y"] + y)
        hovered = explorer.page.locator(".label.hovered")
        if hovered.count() and hovered.inner_text() not in explorer.stops:
            break
    name = explorer.page.locator(".label.hovered").inner_text()
    explorer.page.mouse.down()
    explorer.page.mouse.up()
    assert explorer.stops == ["cherry-235", name]


def test_a_reload_comes_back_to_the_same_place(explorer: Explorer) -> None:
    explorer.open("#space=linear&stops=chrome,teflon,pink-felt&t=0.75&light=points&shape=teapot")
    explorer.page.wait_for_selector(".recipe .name")
    explorer.set_t(0.6)
    explorer.page.wait_for_function("() => location.hash.includes('t=0.6')")
    explorer.page.reload()
    explorer.page.wait_for_selector(".recipe .name")
    assert explorer.stops == ["chrome", "teflon", "pink-felt"]
    assert explorer.page.locator(".t b").inner_text() == "0.600"
    assert explorer.page.locator("[data-value=teapot]").get_attribute("aria-pressed") == "true"


def test_another_link_in_the_same_window_is_followed(explorer: Explorer) -> None:
    explorer.open("#space=linear&stops=chrome,teflon&t=0.75&light=points")
    explorer.page.wait_for_selector(".recipe .name")
    explorer.page.evaluate("location.hash = '#space=linear&stops=cherry-235,gold-paint&t=0.5'")
    explorer.wait_for_recipe(["cherry-235", "gold-paint"])
    assert explorer.stops == ["cherry-235", "gold-paint"]
    explorer.page.go_back()
    explorer.wait_for_recipe(["teflon", "chrome"])


def test_the_downloaded_merl_file_is_the_written_one(
    explorer: Explorer, library: ProceduralLibrary, tmp_path: Path
) -> None:
    explorer.open("#space=paper&stops=cherry-235,gold-paint&t=0.37&light=points")
    explorer.page.wait_for_selector(".recipe .name")
    with explorer.page.expect_download() as recipe_file:
        explorer.page.get_by_role("button", name="Recipe", exact=True).click()
    with explorer.page.expect_download() as merl_file:
        explorer.page.get_by_role("button", name="MERL file").click()
    recipe = Recipe.from_json(json.loads(recipe_file.value.path().read_text()))
    write_merl(tmp_path / "mixed.binary", mix(library, recipe))
    assert merl_file.value.path().read_bytes() == (tmp_path / "mixed.binary").read_bytes()
    assert merl_file.value.suggested_filename == "cherry-235-to-gold-paint-0.370.binary"


def test_steps_that_people_call_equal_are_a_pace(
    explorer: Explorer, library: ProceduralLibrary
) -> None:
    explorer.open("#space=linear&stops=chrome,teflon&t=0.5&light=points")
    explorer.page.wait_for_selector(".recipe .name")
    explorer.page.locator("[name=pace]").select_option("people")
    weights = route(library, "chrome", "teflon", space="linear", pace="people").recipe(0.5).weights
    shares = [f"{100 * weight:.0f} %" for weight in sorted(weights[0], reverse=True)]
    expect(explorer.page.locator(".recipe .share")).to_have_text(shares)


def test_two_spaces_are_compared_in_one_picture(explorer: Explorer) -> None:
    explorer.page.set_viewport_size({"width": 460, "height": 560})
    explorer.open("#space=linear&stops=teflon,chrome&t=0.4&light=points")
    explorer.wait_until_settled()
    alone = picture(explorer)
    explorer.page.locator("[name=compare]").select_option("paper")
    explorer.page.wait_for_function(
        "p => document.querySelector('.live').toDataURL() !== p", arg=alone
    )
    assert explorer.page.locator(".split").inner_text().split() == ["linear", "paper"]
    explorer.page.locator("[name=compare]").select_option("")
    explorer.page.wait_for_function(
        "p => document.querySelector('.live').toDataURL() === p", arg=alone
    )


def test_the_present_material_is_dragged_through_the_space(explorer: Explorer) -> None:
    explorer.open("#space=anchored&stops=cherry-235,teflon&t=0.5&light=points")
    explorer.wait_for_picture()
    explorer.page.get_by_role("button", name="Body colour").click()
    marker = explorer.page.locator(".here").bounding_box()
    assert marker is not None
    x, y = marker["x"] + marker["width"] / 2, marker["y"] + marker["height"] / 2
    explorer.page.mouse.move(x, y)
    explorer.page.mouse.down()
    explorer.page.mouse.move(x, y - 30, steps=4)
    explorer.page.mouse.up()
    explorer.page.get_by_role("button", name="Back to route").wait_for()


def test_what_is_let_go_of_beside_the_space_is_let_go_of(explorer: Explorer) -> None:
    explorer.page.set_viewport_size({"width": 1440, "height": 900})
    explorer.open("#space=anchored&stops=cherry-235,teflon&t=0.5&light=points")
    explorer.wait_for_picture()
    explorer.page.get_by_role("button", name="Body colour").click()
    marker = explorer.page.locator(".here").bounding_box()
    assert marker is not None
    x, y = marker["x"] + marker["width"] / 2, marker["y"] + marker["height"] / 2
    explorer.page.mouse.move(x, y)
    explorer.page.mouse.down()
    explorer.page.mouse.move(x, y - 30, steps=2)
    explorer.page.mouse.move(x, 10)
    explorer.page.mouse.up()
    back = explorer.page.get_by_role("button", name="Back to route")
    back.click()
    back.wait_for(state="hidden")
    explorer.page.mouse.move(x, y + 60, steps=5)
    # The link says where the person is: what was done before it says of the light is in it, too.
    explorer.page.locator("[name=light]").select_option("studio")
    explorer.page.wait_for_function("() => location.hash.includes('light=studio')")
    assert "point=" not in explorer.page.evaluate("location.hash")


def test_a_stop_that_is_removed_is_pointed_at_no_more(explorer: Explorer) -> None:
    explorer.open("#space=linear&stops=cherry-235,teflon,gold-paint&light=points")
    explorer.page.wait_for_selector(".here")
    explorer.page.get_by_label("Remove teflon").hover()
    assert explorer.page.locator(".label.hovered").inner_text() == "teflon"
    explorer.page.get_by_label("Remove teflon").click()
    explorer.page.mouse.move(5, 5)
    explorer.page.locator(".label.hovered").wait_for(state="detached")


def test_an_environment_is_chosen(explorer: Explorer) -> None:
    explorer.page.set_viewport_size({"width": 460, "height": 560})
    explorer.open(PAIR + "&t=0")
    explorer.wait_for_picture(16)
    explorer.page.locator("[name=light]").select_option("forest")
    explorer.page.wait_for_function(
        "() => document.querySelector('.material .note').innerText.endsWith('/ 384 samples')"
    )
    explorer.wait_for_picture(2)


def test_it_plays(explorer: Explorer) -> None:
    explorer.open(PAIR + "&t=0.2")
    explorer.page.wait_for_selector(".recipe .name")
    explorer.page.keyboard.press("Space")
    explorer.page.wait_for_function(
        "() => Number(document.querySelector('.t b').textContent) > 0.25"
    )
    explorer.page.keyboard.press("Space")
    assert explorer.page.get_by_label("Play (space)").get_attribute("aria-pressed") == "false"


def test_the_theme_changes_and_stays(explorer: Explorer) -> None:
    explorer.open(PAIR)
    explorer.page.get_by_label("Dark or light").click()
    assert explorer.page.locator("#app").get_attribute("data-theme") == "light"
    explorer.page.reload()
    explorer.page.wait_for_selector("#app.ready")
    assert explorer.page.locator("#app").get_attribute("data-theme") == "light"


@pytest.mark.parametrize("width", [320, 640, 800, 1440, 2560])
def test_nothing_sticks_out(explorer: Explorer, width: int) -> None:
    explorer.page.set_viewport_size({"width": width, "height": 900})
    explorer.open(PAIR)
    explorer.page.wait_for_selector(".recipe .name")
    assert explorer.page.evaluate("document.documentElement.scrollWidth") <= width
    for selector in (".head", ".space", ".material", ".route", ".recipe", ".brdf"):
        inside = explorer.page.evaluate(
            "s => { const e = document.querySelector(s); return e.scrollWidth <= e.clientWidth + 1; }",
            selector,
        )
        assert inside, selector


@pytest.fixture
def without_webgl(explorer: Explorer) -> Explorer:
    explorer.expected = "THREE.WebGLRenderer"
    explorer.page.add_init_script(
        "const get = HTMLCanvasElement.prototype.getContext;"
        "HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {"
        " return kind.startsWith('webgl') ? null : get.call(this, kind, ...rest); };"
    )
    return explorer


def test_without_webgl_a_small_picture_stands_in(without_webgl: Explorer) -> None:
    page = without_webgl.page
    without_webgl.open(PAIR + "&compare=paper")
    page.wait_for_selector(".material[data-ready=still]")
    assert "stands in" in page.locator(".material .reason").inner_text()
    # There is one picture, and nothing beside it.
    assert page.locator(".split").count() == 0
    page.locator("[name=t]").fill("0.9")
    assert page.locator(".recipe .share").all_text_contents() == ["90 %", "10 %"]
    page.get_by_role("button", name="Picture", exact=True).click()
    with page.expect_download() as picture_file:
        page.get_by_role("button", name="Save", exact=True).click()
    with Image.open(picture_file.value.path()) as saved:
        assert saved.getextrema() != ((0, 0),) * 4


def test_without_webgl_the_materials_are_chosen_side_by_side(without_webgl: Explorer) -> None:
    without_webgl.open(PAIR)
    materials = without_webgl.page.get_by_role("group", name="Materials")
    materials.get_by_role("button", name="teflon").click()
    assert without_webgl.stops == ["cherry-235", "teflon"]
    assert materials.locator("[aria-pressed=true]").count() == 2
    without_webgl.page.locator("[name=search]").fill("gold")
    assert materials.get_by_role("button").count() == 1


def picture(explorer: Explorer) -> str:
    return explorer.page.evaluate("document.querySelector('.live').toDataURL()")
