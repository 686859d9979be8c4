"""The explorer's times, in a headless Chromium that draws in software.

    start      from the command to an interactive page, the library's cache filled; Chromium runs already
    picture    from the last table of the first recipe to the first picture, by the page's own clock: to the frame after the one
               that drew it
    route      how much of that was a wait for the route, which says what the recipe is
    drag       a frame while t moves inside a simplex, the material at about 400 x 400

``pytest benchmarks/bench_explorer.py -s --benchmark-only`` prints them; `make bench` runs it too.
"""

import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Generator, Iterator
from contextlib import contextmanager

import pytest
from playwright.sync_api import Browser, sync_playwright

FLAGS = ["--no-sandbox", "--disable-gpu", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
VIEWPORT = {"width": 1190, "height": 700}
"""Makes the material's panel about 400 x 400."""
N_FRAMES = 120
WATCH = """
new MutationObserver((_, watcher) => {
  if (document.querySelector(".material[data-ready=true]") === null) return;
  watcher.disconnect();
  requestAnimationFrame(() => performance.mark("picture"));
}).observe(document, { subtree: true, childList: true, attributes: true });
"""
TIMES = """() => {
  const ends = (parts) => performance.getEntriesByType("resource")
    .filter(({ name }) => parts.test(name)).map(({ responseEnd }) => responseEnd).sort((a, b) => a - b);
  return {
    tables: ends(/\\/api\\/(tables|mix)/),
    route: ends(/\\/api\\/legs/)[0],
    picture: performance.getEntriesByName("picture")[0].startTime,
  };
}"""
DRAG = """async (n) => {
  const input = document.querySelector("[name=t]");
  const frame = () => new Promise(requestAnimationFrame);
  const times = [];
  let last = await frame();
  for (let i = 0; i < n; i++) {
    input.value = String(0.5 + 0.2 * Math.sin(i / 15));
    input.dispatchEvent(new Event("input"));
    const now = await frame();
    times.push(now - last);
    last = now;
  }
  const { width, height } = document.querySelector(".live");
  return { times: times.sort((a, b) => a - b), width, height };
}"""


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        yield browser
        browser.close()


@contextmanager
def viewing() -> Generator[tuple[str, float]]:
    """`halfway view` as a person starts it: its address, and when it was started."""
    start = time.perf_counter()
    command = [sys.executable, "-m", "halfway", "view", "--no-browser", "--port", "0"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        address = next(line.split()[1] for line in process.stderr if "http://" in line)
        try:
            yield address, start
        finally:
            process.send_signal(signal.SIGINT)


def measure(browser: Browser, light: str) -> dict[str, float]:
    """Seconds, and milliseconds a frame."""
    page = browser.new_page(viewport=VIEWPORT)  # pyright: ignore[reportArgumentType]
    page.add_init_script(WATCH)
    with viewing() as (address, start):
        page.goto(f"{address}#stops=cherry-235,gold-metallic-paint&t=0.5&light={light}")
        page.wait_for_selector("#app.ready .recipe .name")
        ready = time.perf_counter()
        page.wait_for_selector(".material[data-ready=true]")
        page.wait_for_function("() => performance.getEntriesByName('picture').length > 0")
        needed = len(page.locator(".recipe .name").all())
        # With all its pixels, which a slow machine gives it when nothing moves.
        page.wait_for_selector(".material[data-settled=true]", timeout=300_000)
        drag = page.evaluate(DRAG, N_FRAMES)
        times = page.evaluate(TIMES)
    page.close()
    tables = times["tables"][min(needed, len(times["tables"])) - 1]
    frames = drag["times"]
    return {
        "start, s": ready - start,
        "picture, s": (times["picture"] - tables) / 1000,
        "route, s": max(0.0, times["route"] - tables) / 1000,
        "drag, ms": frames[len(frames) // 2],
        "drag, 90th percentile, ms": frames[int(0.9 * len(frames))],
        "width": drag["width"],
        "height": drag["height"],
    }


@pytest.mark.parametrize("light", ["points", "studio"])
def test_explorer(benchmark, browser: Browser, light: str) -> None:
    # Once before, so that the library's cache is filled.
    with viewing() as (address, _):
        page = browser.new_page()
        page.goto(address)
        page.wait_for_selector("#app.ready .recipe .name")
        page.close()
    found = benchmark.pedantic(measure, (browser, light), rounds=1)
    print(f"\n\n{light}")
    for name, value in found.items():
        print(f"{name:28s} {value:8.2f}")
