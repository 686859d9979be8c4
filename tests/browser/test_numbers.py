"""Materials by numbers: the sliders, what they find, and what they say when no mix has it."""

import json
import re

from conftest import Explorer  # pyright: ignore[reportMissingImports]
from numpy.testing import assert_allclose
from patience import wait_until
from playwright.sync_api import expect

from halfway import attributes, mix
from halfway.colour import to_hex
from halfway.library import ProceduralLibrary
from halfway.people import Perception
from halfway.recipes import Recipe

SIZE = {"width": 1280, "height": 900}
HALFWAY = "#space=linear&pace=uniform&stops=gold-paint,cherry-235&t=0.5&light=points&aside=numbers"


def taken(explorer: Explorer) -> Recipe:
    """The recipe that is shown, as it is taken home."""
    explorer.page.wait_for_selector(".numbers:not(.behind)", state="attached")
    with explorer.page.expect_download() as file:
        explorer.page.get_by_role("button", name="Recipe", exact=True).click()
    return Recipe.from_json(json.loads(file.value.path().read_text()))


def test_a_slider_finds_the_material_that_has_it(
    explorer: Explorer, library: ProceduralLibrary
) -> None:
    page = explorer.page
    page.set_viewport_size(SIZE)
    explorer.open(HALFWAY)
    expect(page.locator("[name=gloss60]")).to_be_enabled()
    before = attributes(mix(library, taken(explorer)))
    assert_allclose(float(page.locator("[name=L]").input_value()), before["L"], rtol=0.005)
    explorer.ask("gloss60", "20")
    found = taken(explorer)
    assert found.names != ("cherry-235", "gold-paint")
    # Warmer, and as glossy as it was asked for: one number is held while another moves.
    explorer.ask("b", "25")
    warmer = taken(explorer)
    has = attributes(mix(library, warmer))
    assert_allclose([has["gloss60"], has["b"]], [20, 25], rtol=1e-4)
    # The lightness that b* is read beside came along.
    assert_allclose(has["L"], attributes(mix(library, found))["L"], atol=0.1)
    explorer.wait_for_picture(1)
    page.reload()
    page.wait_for_selector("#app.ready")
    expect(page.get_by_role("button", name="Back to route")).to_be_visible()
    again = taken(explorer)
    assert again.names == warmer.names
    assert_allclose(again.weights, warmer.weights, atol=1e-3)
    page.get_by_role("button", name="Back to route").click()
    assert taken(explorer).names == ("cherry-235", "gold-paint")


def test_what_no_mix_has_is_said_and_the_nearest_is_shown(explorer: Explorer) -> None:
    page = explorer.page
    page.set_viewport_size(SIZE)
    explorer.open(HALFWAY)
    expect(page.locator("[name=gloss60]")).to_be_enabled()
    explorer.ask("gloss60", "9999")
    expect(page.locator(".missing")).to_contain_text("No mix has all of these: Gloss, 60° ")
    # Of all that there are, chrome is the glossiest.
    assert taken(explorer).names == ("chrome",)
    slider = page.locator("[type=range][aria-label^='Specular gloss, 60']")
    slider.dblclick(position={"x": 3, "y": 5})
    expect(page.locator("[data-asked=true]")).to_have_count(0)
    expect(page.locator(".missing")).to_be_empty()
    assert taken(explorer).names == ("cherry-235", "gold-paint")


def test_another_body_colour_is_asked_for_and_got_side_by_side(
    explorer: Explorer, library: ProceduralLibrary
) -> None:
    """By a scaled body, where no mix has it and the highlight; in the picture, the recipe, the link and the shortlist."""
    page = explorer.page
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    explorer.open("#space=linear&pace=uniform&stops=pink-felt,blue-fabric&t=0&light=points")
    explorer.wait_for_picture(1)
    redness = explorer.drawn()[..., 0].mean()
    page.get_by_label("Body colour", exact=True).fill("#203050")
    expect(page.locator(".answer .note")).to_contain_text(
        "the body alone is scaled. Given up: Gloss"
    )
    expect(page.locator(".answer .swatch")).to_have_text(["asked #203050", "got #203050"])
    expect(page.locator(".answer")).to_contain_text("ΔE 0.0")
    found = taken(explorer)
    assert found.is_recoloured
    red, green, blue = (f"{scale:#.2g}" for scale in found.body_scale)
    said = f"^Its body alone: red . {red}, green . {green}, blue . {blue}$"
    expect(page.locator(".scaled")).to_have_text(re.compile(said))
    assert to_hex(attributes(mix(library, found))["body"]) == "#203050"
    wait_until(lambda: explorer.drawn()[..., 0].mean() < 0.9 * redness, explorer.pause)
    page.get_by_label("Copy the command").click()
    page.get_by_text("Copied").wait_for()
    command = page.evaluate("navigator.clipboard.readText()")
    assert "find browser --like pink-felt --set 'body=#203050'" in command
    page.get_by_role("button", name="Pin", exact=True).click()
    # The link has it, and so has what was kept.
    page.wait_for_function("() => location.hash.includes('asked=')")
    page.reload()
    page.wait_for_selector(".scaled:visible")
    assert taken(explorer).to_json() == found.to_json()
    page.get_by_role("button", name="Back to route").click()
    expect(page.locator(".scaled")).to_be_hidden()
    page.locator(".kept li button").first.click()
    expect(page.locator(".scaled")).to_be_visible()
    # Undo leads back to what was asked for before; what need not stay is let go of.
    page.get_by_label("Undo").click()
    page.get_by_label("keep the highlight").uncheck()
    expect(page.locator(".answer .note")).not_to_contain_text("Given up")


def test_how_people_would_perceive_it_is_a_switch_away_and_can_be_asked_for(
    explorer: Explorer, library: ProceduralLibrary
) -> None:
    page = explorer.page
    page.set_viewport_size(SIZE)
    explorer.open(HALFWAY)
    rows = page.locator(".perceived li")
    expect(rows).to_have_count(0)
    page.locator(".perceived summary").click()
    metallic = rows.filter(has_text="metallic")
    expect(metallic).to_have_attribute("data-trust", re.compile("high|fair|low"))
    field = metallic.get_by_role("spinbutton")
    before = field.input_value()
    # It is that of what is shown.
    explorer.set_t(0)
    expect(field).not_to_have_value(before)
    explorer.ask("metallic", "0.6")
    found = Perception.of(library).perceived(mix(library, taken(explorer)))["metallic"]
    assert_allclose(found.value, 0.6, atol=0.01)
    expect(metallic).to_contain_text(found.trust)


def test_another_blend_has_it_too(explorer: Explorer, library: ProceduralLibrary) -> None:
    explorer.page.set_viewport_size(SIZE)
    explorer.open(HALFWAY.replace("linear", "anchored"))
    expect(explorer.page.locator("[name=gloss60]")).to_be_enabled()
    explorer.ask("gloss60", "15")
    found = taken(explorer)
    assert str(found.blend) == "lobes"
    assert_allclose(attributes(mix(library, found))["gloss60"], 15, atol=0.11)
