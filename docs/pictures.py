"""The pictures of the README, from the built-in library: ``make pictures``."""

from pathlib import Path

import numpy as np

import halfway
from halfway.recipes import Mixer
from halfway.render import Renderer, pictures

FOLDER = Path(__file__).parent / "images"
ROUTES = (
    ("light-brown-fabric", "blue-fabric"),
    ("cherry-235", "tungsten-carbide"),
    ("gold-metallic-paint", "specular-maroon-phenolic"),
)
N_COLUMNS = 7


def main() -> None:
    """Write the strip at the top of the README, and the paper's way above ours."""
    library = halfway.open_library("builtin:merl-abc")
    renderer, mixer = Renderer("teapot", size=(288, 240), spp=96, denoise=True), Mixer(library)

    def row(route: halfway.Route) -> list[np.ndarray]:
        return [renderer.picture(mixer.mix(r)) for r in route.recipes(route.steps(N_COLUMNS))]

    ours = [halfway.route(library, *stops) for stops in ROUTES]
    tiles = [picture for route in ours for picture in row(route)]
    pictures.write(FOLDER / "routes.webp", pictures.sheet(tiles, columns=N_COLUMNS))
    stops = ROUTES[1]
    ways = {
        "paper": halfway.route(library, *stops, space="paper", pace="uniform"),
        "linear": halfway.route(library, *stops, blend="linear"),
        "lobes": ours[1],
    }
    labels = [f"{name}, {i}" for name in ways for i in range(1, N_COLUMNS + 1)]
    tiles = [picture for way in ways.values() for picture in row(way)]
    compared = pictures.sheet(tiles, labels=labels, columns=N_COLUMNS)
    pictures.write(FOLDER / "paper-and-anchored.webp", compared)


if __name__ == "__main__":
    main()
