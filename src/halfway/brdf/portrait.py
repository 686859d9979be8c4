"""How a material shows itself in a notebook: a small lit sphere, as a PNG file.

The sphere is that of `sphere`, in the light in which routes are paced, over a transparent background. Direct light
is linear in the BRDF, so the portrait of a recipe is the weighted sum of its materials' pictures.
"""

import io
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np
from jaxtyping import Float32, UInt8

from .._types import Table
from ..halfdiff import Grid
from .sphere import PACING_SCENE, BasisScene, SphereOperator

PORTRAIT_SCENE = replace(PACING_SCENE, name="portrait", size=128, n_points=2)
STRIP_SCENE = replace(PACING_SCENE, name="strip", size=80, n_points=2)
GAP = 6
"""Pixels between the spheres of a strip."""

Picture = Float32[np.ndarray, "n_pixels 3"]
"""Linear RGB of the sphere's pixels, in the order of `BasisScene.mask`."""


def portrait(samples: Table, grid: Grid, scene: BasisScene = PORTRAIT_SCENE) -> Picture:
    """The picture of a table's ``samples``, shape (3, p) or (3, *grid.shape)."""
    return _operator(scene, grid).picture(samples.reshape(3, -1))


def to_png(pictures: Sequence[Picture], scene: BasisScene = PORTRAIT_SCENE) -> bytes:
    """A PNG file of spheres side by side."""
    from PIL import Image

    spheres = [_coded(picture, scene) for picture in pictures]
    gap = np.zeros((scene.size, GAP, 4), np.uint8)
    parts = [part for sphere in spheres for part in (gap, sphere)][1:]
    file = io.BytesIO()
    Image.fromarray(np.concatenate(parts, axis=1)).save(file, "png")
    return file.getvalue()


def _coded(picture: Picture, scene: BasisScene) -> UInt8[np.ndarray, "size size 4"]:
    """The sRGB coding (IEC 61966-2-1), clipped at white; alpha is the share of a pixel that the sphere covers."""
    v = picture.clip(0, 1)
    srgb = np.where(v <= 0.0031308, 12.92 * v, 1.055 * v ** (1 / 2.4) - 0.055)
    coded = np.zeros((scene.size, scene.size, 4))
    coded[scene.mask(), :3] = srgb
    offset = np.arange(scene.size) + 0.5 - scene.size / 2
    covered = (scene.size / 2 + 0.5 - np.hypot(offset, offset[:, None])).clip(0, 1)
    coded[..., 3] = np.where(scene.mask(), covered, 0)
    return np.round(255 * coded).astype(np.uint8)


# An operator takes .1 s to make and 30 MB on the MERL grid.
@lru_cache(maxsize=2)
def _operator(scene: BasisScene, grid: Grid) -> SphereOperator:
    return SphereOperator.of(scene, grid)
