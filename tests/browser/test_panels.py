"""What the panels show: numbers of the BRDF, a person's own mesh, what is compared, places outside the hull."""

import json
from io import BytesIO

import numpy as np
import pytest
from conftest import Explorer  # pyright: ignore[reportMissingImports]
from patience import wait_until
from PIL import Image
from playwright.sync_api import Request, Route

from halfway.brdf import directional_albedo
from halfway.library import ProceduralLibrary
from halfway.recipes import Recipe, mix

PYRAMID = b"v 0 2 0\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nv -1 0 1\nf 1 2 3\nf 1 3 4\nf 1 4 5\nf 1 5 2\nf 5 4 3 2\n"
NEXT_FRAME = (
    "() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)))"
)
SMALL = {"width": 460, "height": 560}
# What lies on top: while a picture of another size is made, it is what was shown before.
DRAWN = """() => {
  const canvas = document.querySelector(".hold:not([hidden])") ?? document.querySelector(".live");
  const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
  copy.drawImage(canvas, 0, 0);
  const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
  let covered = 0;
  for (let i = 3; i < data.length; i += 4) covered += data[i] === 255;
  return covered / (canvas.width * canvas.height);
}"""


COUNT_BUFFERS = """{
  const { createBuffer, deleteBuffer } = WebGL2RenderingContext.prototype;
  window.buffers = 0;
  WebGL2RenderingContext.prototype.createBuffer = function () {
    window.buffers++;
    return createBuffer.call(this);
  };
  WebGL2RenderingContext.prototype.deleteBuffer = function (buffer) {
    window.buffers--;
    deleteBuffer.call(this, buffer);
  };
}"""


def numbers_at(explorer: Explorer, view: str, x: float, y: float) -> list[str]:
    """What the BRDF panel says under the pointer, at shares of the plot."""
    explorer.page.locator(f".brdf [data-value={view}]").click()
    plot = explorer.page.locator(".brdf canvas")
    # Until the samples are made there is nothing to read.
    explorer.page.wait_for_function(
        "() => document.querySelector('.reading').textContent.startsWith('point')"
    )
    plot.scroll_into_view_if_needed()
    box = plot.bounding_box()
    assert box is not None
    explorer.page.mouse.move(box["x"] + x * box["width"], box["y"] + y * box["height"])
    explorer.page.wait_for_selector(".reading .r")
    return explorer.page.locator(".reading span span").all_text_contents()


def test_the_albedo_under_the_pointer_is_that_of_the_mixed_table(
    explorer: Explorer, library: ProceduralLibrary
) -> None:
    explorer.open("#space=linear&pace=uniform&stops=cherry-235,gold-paint&t=0.25&light=points")
    explorer.wait_for_picture(1)
    angle, *shown = numbers_at(explorer, "albedo", 0.6, 0.5)
    recipe = Recipe.of("browser", {"cherry-235": 0.75, "gold-paint": 0.25})
    theta_i = np.radians(float(angle.removeprefix("θi ").removesuffix("°")))
    expected = directional_albedo(mix(library, recipe), theta_i)
    # Half floats and three digits; the page takes fewer nodes in azimuth.
    np.testing.assert_allclose([float(x) for x in shown], expected, rtol=0.005)


@pytest.mark.parametrize("view", ["lobes", "slice"])
def test_numbers_are_under_the_pointer_in_every_scale(explorer: Explorer, view: str) -> None:
    explorer.open("#space=linear&stops=cherry-235,gold-paint&t=0&light=points")
    explorer.wait_for_picture(1)
    first = numbers_at(explorer, view, 0.55, 0.5)
    assert first[0].startswith("θ")
    for scale in ("log", "linear", "cube root"):
        explorer.page.get_by_label("Scale").select_option(scale)
        plot = explorer.page.locator(".brdf canvas").bounding_box()
        assert plot is not None
        explorer.page.mouse.move(plot["x"] + 0.55 * plot["width"], plot["y"] + 0.5 * plot["height"])
        explorer.page.wait_for_selector(".reading .r")
        assert explorer.page.locator(".reading span span").all_text_contents() == first


def test_a_mesh_of_one_s_own_is_lit(explorer: Explorer) -> None:
    explorer.page.set_viewport_size(SMALL)
    explorer.open("#space=linear&stops=teflon,chrome&t=0&light=points")
    explorer.wait_for_picture(1)
    with explorer.page.expect_file_chooser() as chooser:
        explorer.page.locator("[data-value=mesh]").click()
    chooser.value.set_files({"name": "pyramid.obj", "mimeType": "text/plain", "buffer": PYRAMID})
    explorer.page.wait_for_selector("[data-value=mesh][aria-pressed=true]")
    explorer.wait_until_settled()
    assert 0.05 < explorer.page.evaluate(DRAWN) < 0.5
    explorer.page.locator("input[type=file]").set_input_files(
        {"name": "notes.obj", "mimeType": "text/plain", "buffer": b"nothing"}
    )
    explorer.page.wait_for_selector(".material .problem")
    said = explorer.page.locator(".material .problem").inner_text()
    assert said.startswith("notes.obj has no triangles: expected a mesh.")


def test_a_stop_is_compared_with(explorer: Explorer) -> None:
    explorer.page.set_viewport_size(SMALL)
    explorer.open("#space=linear&stops=teflon,chrome&t=0&light=points&compare=stop:chrome")
    explorer.wait_until_settled()
    assert explorer.page.locator(".split").inner_text().split() == ["teflon", "chrome"]
    beside = explorer.drawn()
    explorer.page.locator("[name=compare]").select_option("")
    teflon = explorer.drawn_after(beside)
    explorer.set_t(1)
    chrome = explorer.drawn_after(teflon)
    # The same samples, weighed by 0 and 1: not a byte differs.
    middle = (beside.shape[1] + 1) // 2
    np.testing.assert_array_equal(beside[:, :middle], teflon[:, :middle])
    np.testing.assert_array_equal(beside[:, middle:], chrome[:, middle:])
    assert (teflon != chrome).any(axis=-1).mean() > 0.2


def test_a_point_outside_the_hull_is_marked_beside_a_mix_nearby(explorer: Explorer) -> None:
    far = [1e6, 0.0, 0.0] * 3
    point = ",".join(map(str, far))
    explorer.open(f"#space=paper&stops=cherry-235,teflon&t=0.5&light=points&point={point}")
    explorer.page.get_by_role("button", name="Back to route").wait_for()
    assert "this is one nearby" in explorer.page.locator(".adjustment").inner_text()
    explorer.page.locator(".maps [data-value=R]").click()
    explorer.page.wait_for_selector(".asked")
    assert "nearby" in explorer.page.locator(".space .note").inner_text()


def test_a_free_place_is_undone_and_redone(explorer: Explorer) -> None:
    explorer.open(
        "#space=anchored&stops=cherry-235,gold-paint&t=0.5&light=points&map=Body%20colour"
    )
    explorer.page.wait_for_selector(".recipe .name")
    on_route = explorer.recipe
    explorer.page.get_by_label("to leave the route").press("ArrowRight")
    back = explorer.page.get_by_role("button", name="Back to route")
    back.wait_for()
    left = explorer.recipe
    explorer.page.get_by_label("Undo").click()
    back.wait_for(state="hidden")
    assert explorer.recipe == on_route
    explorer.page.get_by_label("Redo").click()
    back.wait_for()
    assert explorer.recipe == left


def test_the_paper_s_recipe_has_weights_for_each_channel(explorer: Explorer) -> None:
    explorer.open("#space=paper&pace=uniform&stops=cherry-235,pink-felt&t=0.5&light=points")
    explorer.page.wait_for_selector(".recipe .name")
    shares = explorer.page.locator(".recipe .share").all_text_contents()
    # One number stands for three that are equal.
    split = [share.removesuffix(" %").split(" · ") for share in shares]
    channels = [row if len(row) == 3 else 3 * row for row in split]
    assert any(len(row) == 3 for row in split)
    sums = [
        sum(0.5 if w == "<1" else float(w) for w in column)
        for column in zip(*channels, strict=True)
    ]
    assert sums == pytest.approx([100, 100, 100], abs=len(shares))


def test_crossing_into_the_next_simplex_never_blanks_the_picture(explorer: Explorer) -> None:
    explorer.open("#space=paper&pace=uniform&stops=cherry-235,pink-felt&t=0&light=points")
    explorer.wait_for_picture(4)
    explorer.page.route(
        "**/api/tables/*",
        lambda route: (explorer.page.wait_for_timeout(150), route.continue_())[1],
    )
    seen = explorer.page.evaluate(
        f"""async () => {{
          const drawn = {DRAWN};
          const input = document.querySelector("[name=t]");
          const covered = [];
          const recipes = new Set();
          for (let i = 0; i <= 60; i++) {{
            input.value = String(i / 60);
            input.dispatchEvent(new Event("input"));
            await new Promise(requestAnimationFrame);
            covered.push(drawn());
            recipes.add([...document.querySelectorAll(".recipe .name")].map((e) => e.textContent).sort().join());
          }}
          return {{ covered, recipes: recipes.size }};
        }}"""
    )
    assert seen["recipes"] > 2
    # A picture of few pixels has more of them at the edge.
    assert min(seen["covered"]) > 0.8 * max(seen["covered"]), json.dumps(seen)


def test_until_the_route_has_come_the_picture_is_empty(explorer: Explorer) -> None:
    held: list[Route] = []
    tables: list[Request] = []
    explorer.page.on(
        "requestfinished", lambda r: tables.append(r) if "/api/tables/" in r.url else None
    )
    explorer.page.route("**/api/legs/**", lambda route: held.append(route))
    explorer.open("#space=linear&stops=cherry-235,gold-paint&t=0.5&light=points")
    # The tables of the stops beside t are here, and no one knows yet how they are mixed.
    explorer.page.wait_for_function(
        "() => document.querySelector('.material .note').textContent === '0 / 128 samples'"
    )
    wait_until(lambda: len(tables) == 2, explorer.pause)
    explorer.page.evaluate(NEXT_FRAME)
    assert explorer.page.evaluate(DRAWN) == 0
    held[0].continue_()
    explorer.wait_for_picture()
    assert explorer.page.evaluate(DRAWN) > 0.1


def test_few_tables_are_asked_for_at_a_time(explorer: Explorer) -> None:
    asked: list[str] = []

    def on_request(request: Request) -> None:
        if "/api/tables/" in request.url:
            asked.append(request.url)

    explorer.page.set_viewport_size(SMALL)
    explorer.page.on("request", on_request)
    explorer.open(
        "#space=paper&pace=uniform&stops=cherry-235,chrome,teflon,pink-felt&t=0&light=points"
    )
    explorer.wait_until_settled()
    # What is shown, at most four that come next, and the other stop beside t, guessed before the route was known.
    assert len(set(asked)) <= len(explorer.recipe) + 4 + 1


def test_the_space_shows_where_the_route_crosses_into_another_simplex(explorer: Explorer) -> None:
    explorer.page.set_viewport_size(SMALL)
    # So little of a third material that the line stays where it is.
    rows = [[1 - t, 0.0, t] for t in (0.0, 0.3, 0.6, 1.0)]
    leg = {"names": ["cherry-235", "gold-paint", "teflon"], "knots": [0.0, 0.3, 0.6, 1.0]}
    explorer.page.route(
        "**/api/legs/**",
        lambda route: route.fulfill(
            json={**route.fetch().json(), **leg, "weights": dict.fromkeys("rgb", rows)}
        ),
    )
    open_the_space(explorer)
    without = still_cloud(explorer)
    rows[1][1] = 1e-9
    open_the_space(explorer)
    wait_until(lambda: cloud(explorer) != without, explorer.pause)


def test_pictures_come_again_when_the_card_was_lost(explorer: Explorer) -> None:
    explorer.page.set_viewport_size(SMALL)
    explorer.open("#space=linear&stops=cherry-235,teflon&t=0&light=points")
    explorer.wait_until_settled()
    before = explorer.drawn()
    space = pixels(still_cloud(explorer))
    explorer.page.evaluate(
        """async () => {
          const lose = [".live", ".cloud"].map((name) =>
            document.querySelector(name).getContext("webgl2").getExtension("WEBGL_lose_context"));
          const lost = [".live", ".cloud"].map((name) => new Promise((resolve) =>
            document.querySelector(name).addEventListener("webglcontextlost", resolve)));
          for (const each of lose) each.loseContext();
          await Promise.all(lost);
          // Not within the event: what is lost is restored only once it has been told of.
          await new Promise((resolve) => setTimeout(resolve));
          for (const each of lose) each.restoreContext();
        }"""
    )
    explorer.page.wait_for_selector(".material[data-settled=false]")
    explorer.wait_until_settled()
    np.testing.assert_array_equal(explorer.drawn(), before)
    # Edges may be smoothed otherwise by a level or two.
    wait_until(lambda: np.abs(pixels(cloud(explorer)) - space).max() < 8, explorer.pause)


def test_the_card_holds_no_more_after_a_minute_of_dragging(explorer: Explorer) -> None:
    explorer.page.set_viewport_size(SMALL)
    explorer.page.add_init_script(COUNT_BUFFERS)
    explorer.open("#space=paper&stops=cherry-235,teflon,gold-paint&t=0&light=points")
    explorer.page.wait_for_selector(".here")
    before = buffers_after_drag(explorer)
    assert 0 < buffers_after_drag(explorer) <= before


def buffers_after_drag(explorer: Explorer) -> int:
    """Buffers on the card after t went all the way and the space was turned and shown in another map."""
    for i in range(25):
        explorer.set_t(i / 24)
        # The space is drawn every 60 ms; on a slow machine, not at every step.
        explorer.page.wait_for_timeout(70)
    explorer.page.locator(".cloud").press("Alt+ArrowLeft")
    for shown in ("G", "Looks"):
        explorer.page.locator(f".maps [data-value={shown}]").click()
        still_cloud(explorer)
    return explorer.page.evaluate("window.buffers")


def pixels(png: bytes) -> np.ndarray:
    return np.asarray(Image.open(BytesIO(png)).convert("RGB"), float)


def open_the_space(explorer: Explorer) -> None:
    explorer.open("#space=linear&stops=cherry-235,teflon&t=0&light=points")
    explorer.page.wait_for_selector(".here")


def cloud(explorer: Explorer) -> bytes:
    return explorer.page.locator(".cloud").screenshot()


def still_cloud(explorer: Explorer) -> bytes:
    """The picture of the space, once it stays as it is."""
    wait_until(lambda: cloud(explorer) == cloud(explorer), explorer.pause)
    return cloud(explorer)
