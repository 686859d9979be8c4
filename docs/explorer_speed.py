"""What the explorer's page takes, measured by driving it in Chromium; ``docs/explorer.py`` runs it.

speed     what the first load sends, a step of t, and how long the picture takes to settle
large     a library of thousands: until it is ready, until the grid stands, and the memory of its scripts
memory    minutes of dragging: the scripts' memory and the card's objects, at the start and at the end
numbers   a slider of a number, and of t: until recipe, point and picture follow, without and with a slowed down processor
"""

import statistics
import time
from itertools import product
from typing import Any

from playwright.sync_api import Browser, CDPSession, Page

PATIENCE = 600_000
WARM = 20
"""Seconds of dragging before memory is first read: caches fill up to their bounds."""
THROTTLED = 6
N_MOVES = 20
SLIDERS = {"numbers": ".dials [type=range]", "recipe": "[name=t]"}
"""What is beside the picture, and what is moved then."""


def speed(browser: Browser, address: str, width: int, height: int) -> None:
    """What comes over the wire until the picture is there, when something useful is on the page, a step of t, and the rest."""
    page = browser.new_page(viewport={"width": width, "height": height})
    session = page.context.new_cdp_session(page)
    session.send("Network.enable")
    sizes: list[float] = []
    session.on("Network.loadingFinished", lambda event: sizes.append(event["encodedDataLength"]))
    start = time.perf_counter()
    page.goto(address, wait_until="commit")
    page.wait_for_selector(".chip")
    useful = time.perf_counter() - start
    page.wait_for_selector(READY, timeout=PATIENCE)
    page.wait_for_load_state("networkidle")
    loaded = sum(sizes) / 1e6
    print(page.evaluate(RASTERISER))
    steps = page.evaluate(DRAG, 1)
    stopped = time.perf_counter()
    page.wait_for_selector(".material[data-settled=true]", timeout=PATIENCE)
    settled = time.perf_counter() - stopped
    print(f"first load: {loaded:.1f} MB; stops, search and light after {useful:.2f} s")
    print(
        f"a step of t: {statistics.median(steps):.0f} ms (median of {len(steps)}); settled {settled:.2f} s after the last, at {width} x {height}"
    )
    page.close()


def large(browser: Browser, address: str, width: int, height: int) -> None:
    """Of a library whose pictures were computed before: from the address until all can be used."""
    page = browser.new_page(viewport={"width": width, "height": height})
    session = page.context.new_cdp_session(page)
    # What is computed once, and kept in the cache, is not what is measured.
    _open(page, address)
    start = time.perf_counter()
    _open(page, address)
    ready = time.perf_counter() - start
    print(f"ready, with the space and a material, after {ready:.1f} s; {_memory(session):.0f} MB")
    page.get_by_role("button", name="Grid", exact=True).click()
    start = time.perf_counter()
    page.wait_for_function(PAINTED)
    shown = page.locator(".grid button").count()
    print(f"grid of {shown:,} after {time.perf_counter() - start:.2f} s; {_memory(session):.0f} MB")
    page.close()


def memory(browser: Browser, address: str, width: int, height: int, seconds: float) -> None:
    """The scripts' memory, and what of the card's objects has not been given back, before and after so long a drag."""
    page = browser.new_page(viewport={"width": width, "height": height})
    session = page.context.new_cdp_session(page)
    page.add_init_script(f"({COUNT})()")
    _open(page, address)
    for after in (WARM, seconds):
        end = time.monotonic() + after
        while time.monotonic() < end:
            page.evaluate(DRAG, 0.5)
        objects = page.evaluate("window.onCard")
        print(f"after {after:.0f} s more of dragging: {_memory(session):.1f} MB, {objects}")
    page.close()


def numbers(browser: Browser, address: str, width: int, height: int) -> None:
    """From a move of a slider until the page shows it: of gloss, and of t where the table is mixed; medians, and the slowest."""
    page = browser.new_page(viewport={"width": width, "height": height})
    session = page.context.new_cdp_session(page)
    for blend, (name, slider) in product(("linear", "lobes"), SLIDERS.items()):
        _open(page, f"{address}#space=anchored&blend={blend}&map=Scores&aside={name}")
        page.wait_for_selector(f"{slider}:enabled", timeout=PATIENCE)
        for rate in (1, THROTTLED):
            # Once there and back: the materials' tables come.
            page.evaluate(SLIDE, [slider, N_MOVES])
            session.send("Emulation.setCPUThrottlingRate", {"rate": rate})
            moves = page.evaluate(SLIDE, [slider, N_MOVES])
            session.send("Emulation.setCPUThrottlingRate", {"rate": 1})
            print(
                f"{blend}, {name}, processor slowed down by {rate}: {_in_words(moves)}", flush=True
            )
    page.close()


def _open(page: Page, address: str) -> None:
    page.goto("about:blank")
    page.goto(address, wait_until="commit")
    page.wait_for_selector(".labels", state="attached", timeout=PATIENCE)
    page.wait_for_selector(READY, timeout=PATIENCE)


def _memory(session: CDPSession) -> float:
    """MB that scripts hold, their buffers among them, after what is not needed has been collected."""
    session.send("HeapProfiler.collectGarbage")
    usage = session.send("Runtime.getHeapUsage")
    return (usage["usedSize"] + usage["backingStorageSize"]) / 1e6


def _in_words(moves: list[dict[str, Any]]) -> str:
    def one(what: str) -> str:
        times = [move[what] for move in moves if move[what] is not None]
        return f"{what} {statistics.median(times):.0f} ms ({max(times):.0f})" if times else what

    return ", ".join(map(one, ("recipe", "point", "picture")))


READY = ".material[data-ready=true]"

PAINTED = "() => [...document.querySelectorAll('.grid canvas')].some(({ width }) => width > 0)"

RASTERISER = """() => {
  const gl = document.createElement("canvas").getContext("webgl2");
  return gl.getParameter(gl.getExtension("WEBGL_debug_renderer_info").UNMASKED_RENDERER_WEBGL);
}"""

# So many times there and back over a part of the route.
DRAG = """async (extent) => {
  const input = document.querySelector("[name=t]");
  const times = [];
  for (let i = 0; i <= 100; i++) {
    const start = performance.now();
    input.value = String(0.5 + 0.1 * extent * Math.sin(i / 10));
    input.dispatchEvent(new Event("input"));
    await new Promise(requestAnimationFrame);
    times.push(performance.now() - start);
  }
  return times;
}"""

# How many objects of the card were made and not deleted.
COUNT = """() => {
  window.onCard = { Buffer: 0, Texture: 0, Framebuffer: 0, Program: 0, VertexArray: 0 };
  const own = WebGL2RenderingContext.prototype;
  for (const kind of Object.keys(window.onCard)) {
    for (const [act, by] of [["create", 1], ["delete", -1]]) {
      const before = own[act + kind];
      own[act + kind] = function (...parts) {
        window.onCard[kind] += by;
        return before.apply(this, parts);
      };
    }
  }
}"""

# Moves a slider back and forth, again and again before the page comes to rest, and looks at each frame at what has changed.
SLIDE = """async ([selector, n]) => {
  const slider = document.querySelector(selector);
  const look = {
    recipe: () => document.querySelector(".recipe ol").innerHTML,
    point: () => document.querySelector(".here").style.transform,
    picture: () => document.querySelector(".material").dataset.shown,
  };
  const moves = [];
  for (let i = 0; i < n; i++) {
    const before = Object.fromEntries(Object.entries(look).map(([key, of]) => [key, of()]));
    const times = { recipe: null, point: null, picture: null };
    const start = performance.now();
    slider.value = String(0.3 + 0.08 * Math.abs((i % 10) - 5));
    slider.dispatchEvent(new Event("input"));
    while (Object.values(times).includes(null) && performance.now() < start + 2000) {
      await new Promise(requestAnimationFrame);
      const now = performance.now() - start;
      for (const key of Object.keys(look)) if (look[key]() !== before[key]) times[key] ??= now;
    }
    moves.push(times);
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
  return moves;
}"""
