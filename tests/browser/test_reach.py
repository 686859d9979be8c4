"""Who has no mouse, or no sharp eyes: the keyboard, the focus, what is read aloud, contrast."""

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
