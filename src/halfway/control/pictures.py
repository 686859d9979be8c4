"""A picture of a lit sphere, as something that a recipe may be like.

The picture is square and the sphere fills it, in the light of a scene (`halfway.look.SphereScene`): that in which routes are paced
and halfway's own spheres are drawn, or the one that the picture was taken in. Its exposure is free: it is the one at which some mix of the library's materials is nearest,

    min over v >= 0 of |P v - picture|^2        w = v / sum v,   exposure = sum v

with the parts of the materials' pictures in the columns of P, each difference as a share of the picture's own brightness.
"""

from pathlib import Path

import numpy as np
from jaxtyping import Float64

from ..colour import from_srgb
from ..errors import ControlError
from .nearness import DARK, part_means, parts_of

PICTURES = (".png", ".jpg", ".jpeg", ".webp")
LEAST_SIZE = 24
"""Pixels along a side: four for each part."""


def picture_numbers(
    picture: Path | np.ndarray, materials: Float64[np.ndarray, "N n_picture"]
) -> Float64[np.ndarray, " n_picture"]:
    """The means of the parts of a picture, a file or in linear light, exposed as ``materials`` are, of which it is taken to be a mix.

    Raises
    ------
    ControlError
        When it is no picture of a sphere.
    """
    from scipy.optimize import nnls

    name = str(picture) if isinstance(picture, Path) else "the picture"
    linear = _square(_read(picture) if isinstance(picture, Path) else picture, name)
    n = len(linear)
    across = (np.arange(n) + 0.5) * 2 / n - 1
    sphere = np.hypot(across, across[:, None]) < 1
    means = part_means(linear[sphere][None], parts_of(sphere))[0]
    scale = (means + DARK) ** (2 / 3)
    v, _ = nnls((materials / scale).T, means / scale)
    if not v.any():
        raise ControlError(f"{name} is black where the sphere would be: expected a lit one.")
    return means / v.sum()


def _square(linear: np.ndarray, name: str) -> Float64[np.ndarray, "n n 3"]:
    height, width, *_ = linear.shape
    if height != width or height < LEAST_SIZE:
        raise ControlError(
            f"{name} is {width} x {height} pixels: expected a square, of {LEAST_SIZE} or more, that a sphere fills. Crop it."
        )
    return linear.astype(np.float64)


def _read(path: Path) -> Float64[np.ndarray, "h w 3"]:
    from PIL import Image, UnidentifiedImageError

    try:
        with Image.open(path) as image:
            pixels = np.asarray(image.convert("RGB"))
    except UnidentifiedImageError:
        raise ControlError(f"{path} is no picture: expected {', '.join(PICTURES)}.") from None
    except FileNotFoundError:
        raise ControlError(
            f"{path} is not there: expected a picture of a sphere. Check its name."
        ) from None
    return from_srgb(pixels / 255)
