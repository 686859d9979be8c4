"""Quiet pictures from few samples, through Intel's Open Image Denoise (``mitsuba-oidn``)."""

from importlib.util import find_spec

import numpy as np

from ..errors import RenderError

MARGIN = 8
"""Pixels added on every side: the denoiser's network tints the border of what it is given."""


def denoiser_available() -> bool:
    """Whether the denoiser is installed."""
    return find_spec("mitsuba_oidn") is not None


def require_denoiser() -> None:
    """Refuse where it is not, and say what to install."""
    if not denoiser_available():
        raise RenderError(
            "denoising needs the package mitsuba-oidn, which is not installed. "
            "Run pip install mitsuba-oidn, or render with more samples and without denoising."
        )


def denoised(radiance: np.ndarray) -> np.ndarray:
    """Radiance without its noise, float32, shape (height, width, 3).

    Albedo and normals as guides would cost as much again as the samples, and help less than these would.
    """
    import mitsuba_oidn

    height, width = radiance.shape[:2]
    margins = ((MARGIN, MARGIN), (MARGIN, MARGIN), (0, 0))
    framed = np.ascontiguousarray(np.pad(radiance, margins, mode="symmetric"), np.float32)
    result = np.array(mitsuba_oidn.denoise(framed, hdr=True))
    return result[MARGIN : MARGIN + height, MARGIN : MARGIN + width].copy()
