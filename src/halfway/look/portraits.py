"""How materials show themselves in a notebook: small lit spheres in a row, as a PNG file.

The spheres are those of `lit_sphere`, in the light in which routes are paced, over a transparent background. Direct light
is linear in the BRDF, so the portrait of a linear mix is the weighted sum of its materials' pictures: one picture is made
of each material that carries weight, and no table is mixed. Other blends mix tables.
"""

import io
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from jaxtyping import Float32, Float64, UInt8

from .._types import Table
from ..brdf import TabularBrdf
from ..colour import to_srgb
from ..halfdiff import Grid
from ..library import Library
from ..recipes import Blend, Mixer, Recipe
from ..tasks import HERE
from .lit_sphere import PACING_SCENE, SphereOperator, SphereScene

PORTRAIT_SCENE = replace(PACING_SCENE, name="portrait", size=128, n_points=2)
STRIP_SCENE = replace(PACING_SCENE, name="strip", size=80, n_points=2)
GAP = 6
"""Pixels between the spheres of a strip."""

Picture = Float32[np.ndarray, "n_pixels 3"]
"""Linear RGB of the sphere's pixels, in the order of `SphereScene.mask`."""


def table_png(table: TabularBrdf) -> bytes:
    """A PNG file of a table's sphere."""
    return to_png([portrait(table.values, table.grid)])


def recipes_png(
    library: Library,
    names: Sequence[str],
    weights: Float64[np.ndarray, "3 n_recipes n"],
    blend: Blend,
) -> bytes:
    """A PNG file of the spheres of recipes over the materials ``names`` of ``library``."""
    scene = PORTRAIT_SCENE if weights.shape[1] == 1 else STRIP_SCENE
    if blend is not Blend.LINEAR:
        recipes = [
            Recipe.from_dense(library, names, each, blend) for each in weights.swapaxes(0, 1)
        ]
        mixes = map(Mixer(library).mix, recipes)
        return to_png([portrait(mixed.values, mixed.grid, scene) for mixed in mixes], scene)
    used = np.flatnonzero(weights.any(axis=(0, 1)))
    indices = [library.index(names[int(i)]) for i in used]
    pictures = np.stack(list(HERE.run(partial(_picture, library, scene), indices)))
    mixed = np.einsum("ctn,npc->tpc", weights[..., used], pictures, optimize=True)
    return to_png(list(mixed.astype(np.float32)), scene)


def portrait(samples: Table, grid: Grid, scene: SphereScene = PORTRAIT_SCENE) -> Picture:
    """The picture of a table's ``samples``, shape (3, p) or (3, *grid.shape)."""
    return SphereOperator.of(scene, grid).picture(samples.reshape(3, -1))


def to_png(pictures: Sequence[Picture], scene: SphereScene = PORTRAIT_SCENE) -> bytes:
    """A PNG file of spheres side by side."""
    from PIL import Image

    spheres = [_coded(picture, scene) for picture in pictures]
    gap = np.zeros((scene.size, GAP, 4), np.uint8)
    parts = [part for sphere in spheres for part in (gap, sphere)][1:]
    file = io.BytesIO()
    Image.fromarray(np.concatenate(parts, axis=1)).save(file, "png")
    return file.getvalue()


def _picture(library: Library, scene: SphereScene, i: int) -> Picture:
    return portrait(library.row(i), library.grid, scene)


def _coded(picture: Picture, scene: SphereScene) -> UInt8[np.ndarray, "size size 4"]:
    """8-bit sRGB; alpha is the share of a pixel that the sphere covers."""
    coded = np.zeros((scene.size, scene.size, 4))
    coded[scene.mask(), :3] = to_srgb(picture)
    offset = np.arange(scene.size) + 0.5 - scene.size / 2
    covered = (scene.size / 2 + 0.5 - np.hypot(offset, offset[:, None])).clip(0, 1)
    coded[..., 3] = np.where(scene.mask(), covered, 0)
    return np.round(255 * coded).astype(np.uint8)
