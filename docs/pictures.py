"""The pictures of the README, from the built-in library: ``make pictures``."""

from pathlib import Path

import numpy as np

import halfway
from halfway.render import BasisPictures, Renderer, pictures

FOLDER = Path(__file__).parent / "images"
ROUTES = (
    ("light-brown-fabric", "blue-fabric"),
    ("cherry-235", "tungsten-carbide"),
    ("gold-metallic-paint", "specular-maroon-phenolic"),
)
N_COLUMNS = 7


def main() -> None:
    """Write the strip at the top of the README, and the paper's space above ours for the page on navigation."""
    library = halfway.open_library("builtin:merl-abc")
    basis = BasisPictures(Renderer("teapot", size=(288, 240), spp=96, denoise=True), library.brdf)

    def row(route: halfway.Route) -> list[np.ndarray]:
        return [basis.picture(r) for r in route.recipes(route.steps(N_COLUMNS))]

    ours = [halfway.route(library, *stops) for stops in ROUTES]
    tiles = [picture for route in ours for picture in row(route)]
    pictures.write(FOLDER / "routes.webp", pictures.sheet(tiles, columns=N_COLUMNS))
    theirs = halfway.route(library, *ROUTES[1], space="paper", pace="uniform")
    labels = [
        f"{space}, {t:.2f}" for space in ("paper", "anchored") for t in theirs.steps(N_COLUMNS)
    ]
    compared = pictures.sheet([*row(theirs), *row(ours[1])], labels=labels, columns=N_COLUMNS)
    pictures.write(FOLDER / "paper-and-anchored.webp", compared)


if __name__ == "__main__":
    main()
