"""Materials of ``.glb`` files as three.js draws them in Chromium: the sphere of `halfway.brdf.quality`, and a white furnace."""

from base64 import b64decode, b64encode
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from playwright.sync_api import Browser, Route

from halfway.brdf import Brdf, directional_albedo, lit_sphere, quality
from halfway.brdf.quality import LIGHTS, SIDE

THREE = Path(__file__).parents[1] / "viewer" / "node_modules" / "three"
FINE = 9
"""Pixels for one of the sphere's, of which the middle one is taken: three.js widens lobes by how fast the normal turns from pixel to pixel."""
ORIGIN = "http://three.localhost"
PAGE = """<!doctype html><link rel="icon" href="data:,"><script type="importmap">
{"imports": {"three": "/build/three.module.js", "three/addons/": "/examples/jsm/"}}</script>"""

DRAW = """async ({ files, lights, side }) => {
    const three = await import("three");
    const { GLTFLoader } = await import("three/addons/loaders/GLTFLoader.js");
    const renderer = new three.WebGLRenderer();
    const target = new three.WebGLRenderTarget(side, side, { type: three.FloatType });
    const camera = new three.OrthographicCamera(-1, 1, 1, -1, 0, 10);
    camera.position.z = 5;
    const sphere = new three.Mesh(new three.SphereGeometry(1, 512, 256));
    const lit = new three.Scene();
    for (const [direction, weight] of lights) {
        const light = new three.DirectionalLight("white", weight * Math.PI);
        light.position.set(...direction);
        lit.add(light);
    }
    const furnace = new three.Scene();
    const white = new three.Scene();
    white.background = new three.Color("white");
    furnace.environment = new three.PMREMGenerator(renderer).fromScene(white).texture;
    const drawn = (scene) => {
        scene.add(sphere);
        renderer.setRenderTarget(target);
        renderer.clear();
        renderer.render(scene, camera);
        const pixels = new Float32Array(4 * side * side);
        renderer.readRenderTargetPixels(target, 0, 0, side, side, pixels);
        let text = "";
        const bytes = new Uint8Array(pixels.buffer);
        for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
        return btoa(text);
    };
    const pictures = [];
    for (const file of files) {
        const bytes = Uint8Array.from(atob(file), (c) => c.charCodeAt(0));
        const { scene } = await new GLTFLoader().parseAsync(bytes.buffer, "");
        scene.traverse((part) => { if (part.isMesh) sphere.material = part.material; });
        pictures.push([drawn(lit), drawn(furnace)]);
    }
    return pictures;
}"""


class Pictures(NamedTuple):
    """Linear, shape (side, side, 3), the first row at the top."""

    lit: np.ndarray
    furnace: np.ndarray

    def errors(self, brdf: Brdf) -> tuple[float, float, float]:
        """Against what a BRDF shows: PSNR in dB and relative L1 of the lit sphere, the largest error of the albedo up to 74 degrees."""
        radius = np.hypot(*np.meshgrid(*[2 * (np.arange(SIDE) + 0.5) / SIDE - 1] * 2))
        found = quality(self.lit[radius**2 < 0.98], lit_sphere(brdf))
        angles = np.radians(np.arange(0, 86, 5))
        albedos = directional_albedo(brdf, angles).T
        seen = radius < 0.96
        expected = [np.interp(np.arcsin(radius[seen]), angles, albedo) for albedo in albedos]
        off = np.abs(self.furnace[seen] - np.stack(expected, axis=-1))
        return found.psnr, found.relative_l1, float(off.max())


def draw(browser: Browser, files: Sequence[Path]) -> list[Pictures]:
    """What three.js makes of the materials of these files."""
    argument = {
        "files": [b64encode(file.read_bytes()).decode() for file in files],
        "lights": LIGHTS,
        "side": SIDE * FINE,
    }
    with browser.new_context() as context:
        page = context.new_page()
        page.route(f"{ORIGIN}/**", _from_package)
        page.goto(ORIGIN)
        return [Pictures(*map(_picture, found)) for found in page.evaluate(DRAW, argument)]


def _from_package(route: Route) -> None:
    path = route.request.url.removeprefix(ORIGIN).lstrip("/")
    if path:
        route.fulfill(path=THREE / path)
    else:
        route.fulfill(body=PAGE, content_type="text/html")


def _picture(pixels: str) -> np.ndarray:
    rows = np.frombuffer(b64decode(pixels), "<f4").reshape(SIDE * FINE, SIDE * FINE, 4)
    return rows[FINE // 2 :: FINE, FINE // 2 :: FINE][::-1, :, :3].astype(np.float64)
