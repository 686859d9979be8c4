"""Who has no mouse, or no sharp eyes: the keyboard, the focus, what is read aloud, contrast."""

import numpy as np
import pytest
from conftest import Explorer  # pyright: ignore[reportMissingImports]

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
    assert panels == ["Space", "Material", "Route", "Recipe", "BRDF"]


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
