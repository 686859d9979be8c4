"""The pictures and figures of the page on rendering: ``python docs/rendering.py [LIB]``."""

import sys
import time
from pathlib import Path

import numpy as np

import halfway
from halfway import Library, mix, open_library
from halfway.render import QUALITY, BasisPictures, Renderer, pictures

FOLDER = Path(__file__).parent / "images"
SHOWN = {
    "teapot": ["gold-metallic-paint"],
    "trio": ["cherry-235", "teflon", "tungsten-carbide"],
    "spheres": ["green-acrylic"],
    "sphere": ["alum-bronze"],
}
BRUSHED = "hairline-steel", "shot-silk"
"""Of the library of anisotropic models, each as it is and turned by a right angle."""
TEN = ("teflon", "pink-felt", "light-brown-fabric", "blue-fabric", "cherry-235", "alum-bronze",
       "gold-metallic-paint", "green-acrylic", "tungsten-carbide", "chrome")  # fmt: skip
STOPS = "cherry-235", "tungsten-carbide"
N_FRAMES = 51


def main(where: str = "builtin:merl-abc") -> None:
    """Write the pictures, print the figures."""
    library = open_library(where)
    scenes(library)
    brushed()
    qualities(library)
    lookups(library)
    route(library)


def scenes(library: Library) -> None:
    """Every scene, once."""
    tiles = [
        Renderer(name, size=(360, 270), spp=256, denoise=True).picture(
            [library.brdf(material) for material in SHOWN[name]]
        )
        for name in SHOWN
    ]
    pictures.write(FOLDER / "scenes.webp", pictures.sheet(tiles, labels=list(SHOWN), columns=2))


def brushed() -> None:
    """The scene for anisotropic materials."""
    library = open_library("builtin:anisotropic")
    tiles, labels = [], []
    for name in BRUSHED:
        for turn in (0, 90):
            renderer = Renderer(
                "brushed", size=(400, 250), spp=256, denoise=True, turn_degrees=turn
            )
            tiles.append(renderer.picture(library.brdf(name)))
            labels.append(f"{name}, turned by {turn}°" if turn else name)
    pictures.write(FOLDER / "brushed.webp", pictures.sheet(tiles, labels=labels, columns=2))


def qualities(library: Library) -> None:
    """The same picture at every quality, and how far each is from one of 4,096 samples."""
    brdf = library.brdf("light-brown-fabric")
    best = Renderer("teapot", size=(360, 270), spp=4096, seed=1).picture(brdf)
    tiles, labels = [], []
    for name, spp in QUALITY.items():
        renderer = Renderer("teapot", size=(360, 270), spp=spp, denoise=True)
        plain = Renderer("teapot", size=(360, 270), spp=spp).picture(brdf)
        renderer.picture(brdf)
        start = time.process_time()
        tiles.append(renderer.picture(brdf))
        seconds = time.process_time() - start
        labels.append(f"{name}: {spp} spp")
        print(
            f"{labels[-1]:20s} {seconds:5.2f} s of CPU  off by {_rms(tiles[-1], best):.2f} of 255 (rms), "
            f"{_rms(plain, best):.2f} with its noise"
        )
    pictures.write(FOLDER / "qualities.webp", pictures.strip(tiles, labels=labels))


def lookups(library: Library) -> None:
    """The mean of a point-lit sphere by the floor lookup, over that by interpolation."""
    x, y = np.meshgrid(*2 * [(np.arange(768) + 0.5) / 384 - 1])
    inside = x**2 + y**2 < 1
    normal = np.stack([x, y, np.sqrt(np.maximum(1 - x**2 - y**2, 0))], axis=-1)[inside]
    tangent = np.cross(normal, [0.3, 0.5, 0.8])
    tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
    frame = np.stack([tangent, np.cross(normal, tangent), normal], axis=-2)
    light = np.array([-0.48, 0.36, 0.8])
    wi, wo = frame @ light, frame @ np.array([0.0, 0.0, 1.0])
    cosine = np.maximum(wi[:, 2], 0)
    for name in TEN:
        brdf = library.brdf(name)
        floor, between = (
            np.nansum(brdf.eval(wi, wo, interpolation=how) * cosine[:, None])
            for how in ("floor", "trilinear")
        )
        print(f"{name:24s} floor / interpolated: {floor / between - 1:+.2%}")


def route(library: Library) -> None:
    """A route's frames against the renders of the measured materials it touches, at 512 x 512."""
    way = halfway.route(library, *STOPS)
    recipes = way.recipes(way.steps(N_FRAMES))
    names = sorted({name for recipe in recipes for name in recipe.names})
    renderer = Renderer("teapot", size=(512, 512), spp=64)
    renderer.picture(library.brdf(names[0]))  # compiles, and renders the backdrop
    basis = BasisPictures(renderer, library.brdf)
    start = time.perf_counter()
    basis.render(names)
    middle = time.perf_counter()
    frames = [basis.picture(recipe) for recipe in recipes]
    end = time.perf_counter()
    half = recipes[N_FRAMES // 2]
    full, again = (
        Renderer("teapot", size=(512, 512), spp=64, seed=seed).picture(mix(library, half))
        for seed in (0, 1)
    )
    print(
        f"{N_FRAMES} frames of 512 x 512 from {len(names)} materials: {middle - start:.1f} s for those, "
        f"{(end - middle) / N_FRAMES * 1000:.0f} ms a frame; the middle one differs from its own render by "
        f"{_rms(frames[N_FRAMES // 2], full):.2f} of 255, that from one with another seed by {_rms(full, again):.2f}"
    )


def _rms(a: np.ndarray, b: np.ndarray) -> float:
    difference = pictures.to_8_bit(a).astype(float) - pictures.to_8_bit(b)
    return float(np.sqrt(np.mean(difference**2)))


if __name__ == "__main__":
    main(*sys.argv[1:])
