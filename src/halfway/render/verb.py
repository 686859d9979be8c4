"""One picture of one material, in one call."""

from pathlib import Path

import numpy as np

from ..brdf import TabularBrdf
from ..errors import RenderError
from . import pictures
from .renderer import QUALITY, Renderer
from .variant import Device


def picture(
    table: TabularBrdf,
    path: Path | str | None = None,
    *,
    scene: str = "teapot",
    size: int | tuple[int, int] = 384,
    quality: str = "normal",
    exposure: float = 0.0,
    device: Device = "auto",
) -> np.ndarray:
    """The picture of a material in a scene: linear RGB radiance, float32, shape (height, width, 3).

    Parameters
    ----------
    table : TabularBrdf
        The material.
    path : path, optional
        Where to write it as well: ``.png``, ``.jpg``, ``.webp``, or ``.exr``, which takes no exposure.
    scene : str
        ``teapot``, ``spheres``, ``sphere``, ``trio`` or ``brushed``.
    size : int or (int, int)
        Width and height in pixels.
    quality : str
        ``preview``, ``normal`` or ``final``: 16, 64 or 256 samples a pixel.
    exposure : float
        In stops, of what is written.
    device : {"auto", "cpu", "gpu"}
        Where to render.

    Examples
    --------
    >>> import halfway
    >>> table = halfway.mix("builtin:merl-abc", "gold-paint=0.7, teflon=0.3")
    >>> halfway.picture(table, "mix.png", size=48, quality="preview").shape
    (48, 48, 3)

    Raises
    ------
    RenderError
        When there is no such scene, quality or device, or Mitsuba cannot render here.
    OutputError
        When the file cannot be written.
    """
    if quality not in QUALITY:
        raise RenderError(f"there is no quality {quality!r}: expected one of {', '.join(QUALITY)}.")
    sides = (size, size) if isinstance(size, int) else size
    renderer = Renderer(scene, size=sides, spp=QUALITY[quality], device=device)
    image = renderer.picture(table)
    if path is not None:
        pictures.write(path, image, exposure=exposure)
    return image
