"""Quiet pictures from few samples, through Intel's Open Image Denoise (``mitsuba-oidn``)."""

from importlib.util import find_spec

import numpy as np

from ..errors import RenderError
from .exposure import Layer

MARGIN = 32
"""Pixels added on every side: the denoiser's network tints the border of what it is given."""


def denoiser_available() -> bool:
    """Whether the denoiser is installed."""
    return find_spec("mitsuba_oidn") is not None


def require_denoiser() -> None:
    """Refuse where it is not.

    Raises
    ------
    RenderError
        Says what to install.
    """
    if not denoiser_available():
        raise RenderError(
            "denoising needs the package mitsuba-oidn, which is not installed. "
            "Run pip install mitsuba-oidn, or render with more samples and without denoising."
        )


def denoised(layer: Layer) -> np.ndarray:
    """The layer's radiance without its noise, led by its guides; float32, shape (height, width, 3)."""
    import mitsuba_oidn

    height, width = layer.radiance.shape[:2]
    images = (layer.radiance, layer.albedo, layer.normal)
    color, albedo, normal = (_framed(image) for image in images)
    result = np.array(mitsuba_oidn.denoise(color, albedo, normal, hdr=True))
    return result[MARGIN : MARGIN + height, MARGIN : MARGIN + width].copy()


def _framed(image: np.ndarray) -> np.ndarray:
    """The image in a margin of its own mirror image."""
    margins = ((MARGIN, MARGIN), (MARGIN, MARGIN), (0, 0))
    return np.ascontiguousarray(np.pad(image, margins, mode="symmetric"), np.float32)
