"""Materials where numbers put them: axes and colours by attributes."""

import json

from conftest import Explorer  # pyright: ignore[reportMissingImports]
from playwright.sync_api import expect

SIZE = {"width": 1280, "height": 900}
NUMBERS = "#space=linear&pace=uniform&stops=gold-paint,chrome&t=0.5&light=points&map=Numbers"


def test_axes_and_colours_are_chosen_among_what_instruments_read(explorer: Explorer) -> None:
    page = explorer.page
    page.set_viewport_size(SIZE)
    explorer.open(NUMBERS)
    ticks = page.locator(".tick")
    expect(ticks.filter(has_text="Gloss, 60° (GU)")).to_have_count(1)
    page.locator("[name=axis-2]").select_option("haze")
    expect(ticks.filter(has_text="Haze (HU)")).to_have_count(1)
    for width in (390, 800, 1280):
        page.set_viewport_size({"width": width, "height": SIZE["height"]})
        page.wait_for_timeout(300)
        assert not overlapping(explorer)
    before = seen(explorer)
    page.locator("[name=tint]").select_option("gloss60")
    expect(page.get_by_role("img", name="Colours stand for Gloss, 60° (GU)")).to_be_visible()
    page.wait_for_timeout(500)
    assert seen(explorer) != before
    # The link has both, and colours stay on another map.
    page.reload()
    expect(page.locator("[name=axis-2]")).to_have_value("haze")
    page.get_by_role("button", name="Looks", exact=True).click()
    expect(page.locator("[name=axis-2]")).to_be_hidden()
    expect(page.locator(".legend")).to_be_visible()


def test_the_present_material_stands_where_its_own_numbers_are(explorer: Explorer) -> None:
    page = explorer.page
    page.set_viewport_size(SIZE)
    explorer.open(NUMBERS + "&axes=albedo,gloss60,L")
    here = page.locator(".here")
    expect(here).to_be_visible()
    # It goes with t, and cannot be dragged to numbers: the sliders do that.
    expect(here).to_be_disabled()
    before = here.get_attribute("style")
    explorer.set_t(0.9)
    expect(here).not_to_have_attribute("style", before or "")


def test_small_pictures_that_do_not_come_are_said_and_asked_for_again(explorer: Explorer) -> None:
    page = explorer.page
    explorer.expected = "Failed to load resource"
    answer = {"status": 500, "body": json.dumps({"error": "no room is left."})}
    page.route(
        "**/api/thumbnails",
        lambda route: (
            route.fulfill(**answer) if route.request.method == "POST" else route.fallback()
        ),
    )
    explorer.open("#space=anchored&blend=lobes&stops=gold-paint,chrome&light=points")
    said = page.locator(".route .problem", has_text="no room is left")
    expect(said).to_be_visible()
    page.unroute_all()
    expect(said).to_be_hidden()


def overlapping(explorer: Explorer) -> list[str]:
    """Texts at the axes that cover another one, or a name."""
    return explorer.page.evaluate("""() => {
      const [ticks, names] = [".tick", ".labels .label"].map((each) => [...document.querySelectorAll(each)]);
      const box = (element) => element.getBoundingClientRect();
      const cover = (a, b) => a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1;
      return ticks.filter((tick, i) => [...ticks.slice(0, i), ...names].some((other) => cover(box(tick), box(other))))
        .map((tick) => tick.textContent);
    }""")


def seen(explorer: Explorer) -> bytes:
    return explorer.page.locator(".cloud").screenshot()
