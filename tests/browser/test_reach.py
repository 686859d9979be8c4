"""Who has no mouse, or no sharp eyes: the keyboard, the focus, what is read aloud, contrast."""

import numpy as np
import pytest
from conftest import Explorer  # pyright: ignore[reportMissingImports]
from playwright.sync_api import expect

THREE = "#space=linear&stops=cherry-235,teflon,gold-paint&light=points"
FOCUSED = "() => document.activeElement.textContent || document.activeElement.ariaLabel"


def test_the_focus_stays_at_the_stops(explorer: Explorer) -> None:
    explorer.open(THREE)
    page = explorer.page
    page.locator(".chip button").first.focus()
    page.keyboard.press("Enter")
    assert page.evaluate(FOCUSED) == "cherry-235"
    page.keyboard.press("Alt+ArrowRight")
    page.keyboard.press("Alt+ArrowRight")
    assert explorer.stops == ["teflon", "gold-paint", "cherry-235"]
    assert page.evaluate(FOCUSED) == "cherry-235"
    page.keyboard.press("Alt+ArrowRight")
    assert page.evaluate(FOCUSED) == "cherry-235"
    page.get_by_label("Remove teflon").press("Enter")
    assert page.evaluate(FOCUSED) == "cherry-235"
    page.get_by_label("Add a stop").press("Enter")
    assert page.evaluate(FOCUSED).startswith("choose a material")


def wait_for_orbit(explorer: Explorer, expected: list[float], within: float) -> None:
    """Until the link says azimuth, elevation and zoom."""
    explorer.page.wait_for_function(
        """([expected, within]) => {
          const orbit = new URLSearchParams(location.hash.slice(1)).get("orbit")?.split(",") ?? [];
          return expected.every((x, i) => Math.abs(x - orbit[i]) <= within);
        }""",
        arg=[expected, within],
    )


def test_the_object_is_turned_by_key(explorer: Explorer) -> None:
    explorer.open(THREE)
    explorer.page.locator(".live").focus()
    t = explorer.page.locator(".t b").inner_text()
    for key in ("ArrowLeft", "ArrowLeft", "ArrowUp"):
        explorer.page.keyboard.press(f"Alt+{key}")
    wait_for_orbit(explorer, [0.2, 0.1, 1], within=1e-6)
    assert explorer.page.locator(".t b").inner_text() == t


def test_the_space_is_turned_by_key(explorer: Explorer) -> None:
    explorer.open(THREE)
    here = explorer.page.locator(".here")
    here.wait_for()
    before = here.get_attribute("style")
    assert before is not None
    explorer.page.locator(".cloud").press("Alt+ArrowLeft")
    expect(here).not_to_have_attribute("style", before)


def test_two_fingers_bring_the_object_nearer_and_do_not_turn_it(explorer: Explorer) -> None:
    explorer.open(THREE)
    box = explorer.page.locator(".live").bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 3
    session = explorer.page.context.new_cdp_session(explorer.page)
    for kind, apart in (("touchStart", 20), ("touchMove", 30), ("touchMove", 40)):
        points = [{"x": x + side * apart, "y": y, "id": i} for i, side in enumerate((-1, 1))]
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
    session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    wait_for_orbit(explorer, [0, 0, 2], within=0.01)


def test_the_search_says_which_material_is_marked(explorer: Explorer) -> None:
    explorer.open(THREE)
    search = explorer.page.locator("[name=search]")
    search.fill("paint")
    search.press("ArrowDown")
    marked = search.get_attribute("aria-activedescendant")
    assert explorer.page.locator(f"[id='{marked}']").inner_text() == "pearl-paint"
    assert explorer.page.locator(f"[id='{marked}']").get_attribute("aria-selected") == "true"


def test_the_route_is_reached_before_the_panels_beside_it(explorer: Explorer) -> None:
    explorer.open(THREE)
    panels = explorer.page.locator("section.panel").evaluate_all("all => all.map(e => e.ariaLabel)")
    assert panels == ["Space", "Material", "Route", "Shortlist", "Recipe", "BRDF"]


@pytest.mark.parametrize("scheme", ["dark", "light"])
def test_text_stands_out_from_its_ground(explorer: Explorer, scheme: str) -> None:
    """4.5 for text, 3 for what is no text: WCAG 2.2, AA."""
    explorer.page.emulate_media(color_scheme=scheme)  # pyright: ignore[reportArgumentType]
    explorer.open(THREE)
    found = explorer.page.evaluate(
        """() => ["#app", ".stage"].map((selector) => {
          const style = getComputedStyle(document.querySelector(selector));
          const names = ["panel", "stage-out", "text", "quiet", "accent", "red", "green", "blue", "problem"];
          return Object.fromEntries(names.map((name) => [name, style.getPropertyValue(`--${name}`)]));
        })"""
    )
    page, stage = found
    for name in ("text", "quiet", "accent", "red", "green", "blue", "problem"):
        assert contrast(page[name], page["panel"]) >= 4.5, name
    assert contrast(stage["quiet"], stage["stage-out"]) >= 4.5
    assert contrast(stage["accent"], stage["stage-out"]) >= 3


def contrast(a: str, b: str) -> float:
    """Of two colours as #rrggbb: WCAG 2.2, contrast ratio."""
    light, dark = sorted((luminance(a), luminance(b)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


def luminance(colour: str) -> float:
    if len(colour) == 4:
        colour = "#" + "".join(2 * digit for digit in colour[1:])
    coded = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255
    linear = np.where(coded <= 0.04045, coded / 12.92, ((coded + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])
