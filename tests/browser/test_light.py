"""A light of one's own, turned, and how the picture is toned."""

import numpy as np
from conftest import Explorer, to_linear  # pyright: ignore[reportMissingImports]
from patience import wait_until

SMALL = {"width": 460, "height": 560}
# Radiance's format, pixels as they are: red to the left (-x) of who looks along +y, which is the middle, and blue to the right.
RED, BLUE = bytes([128, 1, 1, 129]), bytes([1, 1, 128, 129])
SKY = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n" + (RED * 8 + BLUE * 8) * 8


def redness(explorer: Explorer) -> tuple[bool, bool]:
    """Whether more red than blue light comes from the left half of the object, and from the right one."""
    shown = explorer.drawn()
    red = to_linear(shown) @ (1, 0, -1) * (shown[..., 3] == 255)
    left, right = np.array_split(red, 2, axis=1)
    return bool(left.mean() > 0), bool(right.mean() > 0)


def test_a_light_of_one_s_own_comes_from_where_it_is_turned_to(explorer: Explorer) -> None:
    page = explorer.page
    page.set_viewport_size(SMALL)
    explorer.open("#space=linear&stops=teflon,chrome&t=0&light=points")
    explorer.drop(".material", "sky.hdr", SKY)
    page.get_by_text("/ 384 samples").wait_for()
    assert page.locator("[name=light]").input_value() == "own"
    wait_until(lambda: redness(explorer) == (True, False), explorer.pause)
    page.get_by_label("Turn the light").click()
    page.locator("[name=turn]").fill("180")
    wait_until(lambda: redness(explorer) == (False, True), explorer.pause)


def test_tones_are_chosen_linked_and_said(explorer: Explorer) -> None:
    page = explorer.page
    page.set_viewport_size(SMALL)
    explorer.open("#space=linear&stops=teflon,chrome&t=0&light=points")
    explorer.wait_until_settled()
    before = explorer.drawn()
    page.get_by_label("Turn the light").click()
    page.locator("[name=tone]").select_option("agx")
    explorer.drawn_after(before)
    page.keyboard.press("Escape")
    page.locator(".brdf [data-value=albedo]").click()
    page.wait_for_function(
        "() => location.hash.includes('tone=agx') && location.hash.includes('plot=albedo')"
    )
    page.reload()
    page.wait_for_selector(".brdf [data-value=albedo][aria-pressed=true]")
    page.wait_for_function("() => document.title === 'teflon · halfway'")
    page.get_by_role("button", name="Picture", exact=True).click()
    page.locator("[name=size]").fill("32")
    with page.expect_download() as file:
        page.get_by_role("button", name="Save", exact=True).click()
    assert file.value.suggested_filename == "teflon-agx.png"
