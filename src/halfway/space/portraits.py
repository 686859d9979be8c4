"""How recipes and routes show themselves in a notebook: lit spheres in a row, as a PNG file.

One picture of each material that carries weight, of which every sphere is a weighted sum (see `halfway.brdf.portrait`).
"""

from collections.abc import Sequence
from functools import partial

import numpy as np
from jaxtyping import Float64

from ..brdf.portrait import PORTRAIT_SCENE, STRIP_SCENE, Picture, portrait, to_png
from ..brdf.sphere import BasisScene
from ..errors import HalfwayError
from ..library import Library, library_called
from ..tasks import run

N_SPHERES = 9
"""Places along a route, its ends among them."""


def picture_recipes(
    library: str, names: Sequence[str], weights: Float64[np.ndarray, "3 n_recipes n"]
) -> bytes | None:
    """Spheres of recipes over the materials ``names``; None, for text alone, where their library is out of reach."""
    used = np.flatnonzero(weights.any(axis=(0, 1)))
    scene = PORTRAIT_SCENE if weights.shape[1] == 1 else STRIP_SCENE
    try:
        found = library_called(library)
        indices = [found.index(names[int(i)]) for i in used]
    except (HalfwayError, OSError):
        return None
    pictures = np.stack(list(run(partial(_picture, found, scene), indices)))
    mixed = np.einsum("ctn,npc->tpc", weights[..., used], pictures, optimize=True)
    return to_png(list(mixed.astype(np.float32)), scene)


def _picture(library: Library, scene: BasisScene, i: int) -> Picture:
    return portrait(library.row(i), library.grid, scene)
