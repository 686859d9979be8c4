"""How well a file stands for a BRDF: the same lit sphere with both, without noise.

An orthographic view of a sphere under five distant lights, from frontal to grazing and behind; a white diffuse sphere
facing a light of weight 1 would show 1. The tangent runs around the vertical axis.

    PSNR         -10 log10 of the mean squared difference of the sRGB-encoded pictures, clipped to [0, 1], over the sphere
    relative L1  sum |a - b| / sum |b| of the linear, unclipped pictures
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from .._types import Values
from ..colour import to_srgb
from ..errors import FormatError
from .brdf import Brdf

SIDE = 96
# x to the right, y up, z to the viewer; and the weight.
LIGHTS = (
    ((0.5, 0.6, 0.7), 0.6),
    ((-0.8, 0.2, 0.35), 0.5),
    ((0.3, -0.9, -0.2), 0.5),
    ((0.05, 0.1, 1.0), 0.3),
    ((-0.3, 0.8, -0.4), 0.5),
)


@dataclass(frozen=True)
class Quality:
    """How close a file's picture is to its BRDF's."""

    psnr: float
    """In dB, of the display picture; capped at 120."""
    relative_l1: float
    """Of the linear picture."""


def lit_sphere(brdf: Brdf) -> Values:
    """Linear radiance of the sphere's pixels, shape (n, 3); unmeasured counts as 0.

    Raises
    ------
    FormatError
        When nothing that the sphere shows is measured.
    """
    wo = _frames() @ np.array([0.0, 0.0, 1.0])
    total = np.zeros_like(wo)
    n_known = 0
    for direction, weight in LIGHTS:
        wi = _frames() @ (np.array(direction) / np.linalg.norm(direction))
        values, cosine = brdf.eval(wi, wo), np.maximum(wi[:, 2:], 0)
        n_known += np.count_nonzero(np.isfinite(values) & (cosine > 0))
        total += weight * np.pi * np.nan_to_num(values, nan=0.0) * cosine
    if not n_known:
        raise FormatError(
            f"{getattr(brdf, 'name', '') or 'the material'} is measured nowhere on a lit sphere: expected a table of a whole "
            "material. `halfway check` says what is in it."
        )
    return total


def quality(picture: Values, expected: Values) -> Quality:
    """How close one `lit_sphere` is to another."""
    error = np.mean((to_srgb(picture) - to_srgb(expected)) ** 2)
    scale = np.abs(expected).sum()
    return Quality(
        psnr=float(-10 * np.log10(max(error, 1e-12))),
        relative_l1=float(np.abs(picture - expected).sum() / scale) if scale > 0 else 0.0,
    )


@cache
def _frames() -> np.ndarray:
    """Rotations from the scene to the surface's frame at each pixel, shape (n, 3, 3)."""
    across = 2 * (np.arange(SIDE) + 0.5) / SIDE - 1
    x, y = (v.ravel() for v in np.meshgrid(across, -across))
    inside = x**2 + y**2 < 0.98
    x, y = x[inside], y[inside]
    normal = np.stack([x, y, np.sqrt(1 - x**2 - y**2)], axis=-1)
    tangent = np.cross([0.0, 1.0, 0.0], normal)
    tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
    return np.stack([tangent, np.cross(normal, tangent), normal], axis=1)
