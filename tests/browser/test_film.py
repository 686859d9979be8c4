"""Films of a route, and of an object that turns."""

import numpy as np
import pytest
from conftest import Explorer, frames  # pyright: ignore[reportMissingImports]

SMALL = {"width": 460, "height": 560}
PAIR = "#space=linear&pace=uniform&stops=cherry-235,gold-paint&t=0.5&light=points&shape="


@pytest.fixture(scope="module")
def scale() -> float:
    """So that in a large window the picture is not done before the film."""
    return 0.25


def test_a_film_of_a_route_goes_evenly_from_one_stop_to_the_next(explorer: Explorer) -> None:
    explorer.page.set_viewport_size(SMALL)
    explorer.open(PAIR + "sphere")
    name, content = explorer.film(film_as="frames (zip of PNG)")
    assert name == "cherry-235-to-gold-paint-frames.zip"
    first, *_, last = pictures = frames(content)
    assert np.abs(last - first).mean() > 0.01
    # Pictures mix as materials do, at every frame of an even pace; what is brighter than the screen is cut.
    dark = np.max([first, last], axis=0) < 0.9
    for i, picture in enumerate(pictures):
        mixed = (1 - i / 4) * first + i / 4 * last
        # Half a step of 8 bits in each, where sRGB is steepest for what is bright.
        np.testing.assert_allclose(picture[dark], mixed[dark], atol=2.5 / 255)


def test_an_object_turns_once_and_only_then(explorer: Explorer) -> None:
    explorer.page.set_viewport_size(SMALL)
    explorer.open(PAIR + "teapot")
    name, content = explorer.film(motion="turntable", film_as="frames (zip of PNG)")
    assert name == "cherry-235-to-gold-paint-0.500-turning-frames.zip"
    pictures = frames(content)
    for one, other in zip(pictures, [*pictures[1:], pictures[0]], strict=True):
        assert np.abs(one - other).mean() > 0.001


def test_a_video_has_all_frames(explorer: Explorer) -> None:
    explorer.page.set_viewport_size(SMALL)
    explorer.open(PAIR + "sphere")
    name, content = explorer.film()
    assert name.removeprefix("cherry-235-to-gold-paint") in (".mp4", ".webm")
    play = """async (data) => {
      const video = document.createElement("video");
      video.src = URL.createObjectURL(new Blob([Uint8Array.from(data)]));
      await new Promise((resolve, reject) => {
        video.onloadeddata = resolve;
        video.onerror = () => reject(video.error);
      });
      return [video.videoWidth, video.videoHeight, video.duration];
    }"""
    # The explorer itself may show no videos.
    elsewhere = explorer.page.context.new_page()
    width, height, seconds = elsewhere.evaluate(play, list(content))
    assert (width, height) == (48, 48)
    np.testing.assert_allclose(seconds, 0.2, atol=0.001)


def test_the_live_picture_rests_while_a_film_is_drawn(explorer: Explorer) -> None:
    page = explorer.page
    page.set_viewport_size({"width": 1440, "height": 900})
    explorer.open(PAIR.replace("points", "studio") + "sphere")
    explorer.wait_for_picture(1)
    page.get_by_role("button", name="Film").click()
    page.locator("[name=film-size]").fill("16")
    page.locator("[name=motion]").select_option("turntable")
    page.locator("[name=quality]").select_option("draft")
    page.get_by_role("button", name="Save", exact=True).click()
    samples = "document.querySelector('.material').dataset.samples"
    drawn = "(n) => Number(/frame ([0-9]+) of 100/.exec(document.querySelector('.running').title)?.[1]) >= n"
    page.wait_for_function(drawn, arg=2)
    before = page.evaluate(samples)
    # Its window may be closed meanwhile: the button says how far it is.
    page.keyboard.press("Escape")
    page.wait_for_function(drawn, arg=6)
    assert page.evaluate(samples) == before
    page.get_by_role("button", name="Film").click()
    page.get_by_role("button", name="Stop", exact=True).click()
    explorer.wait_for_picture(int(before) + 1)
