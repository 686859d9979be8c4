"""A fit beside its material, as a picture of two rows: the table, the fit, and the difference.

Above, the lit sphere on which routes are paced, without noise. Below, Mitsuba in the studio: the exact table, and for the model
``principled`` Mitsuba's own plugin with the fitted parameters; for a model that Mitsuba lacks, or one whose tangent is turned, the table of the fit. The
difference is CIEDE2000 of what a display shows, from black (none) to white (`WHITE` and more).
"""

from dataclasses import replace
from typing import TypeGuard

import numpy as np
from jaxtyping import UInt8

from ..brdf import TabularBrdf, tabulate
from ..colour import ciede2000
from ..fit import AnalyticModel, Fit, Principled
from ..look import PACING_SCENE, appearance, portrait
from .denoise import denoiser_available
from .pictures import sheet
from .renderer import Renderer
from .scenes import Material

WHITE = 10.0
"""The difference that is drawn white; 1 is just noticeable side by side."""
SPP = 64


def fit_sheet(table: TabularBrdf, fit: Fit, *, size: int = 256) -> UInt8[np.ndarray, "h w 3"]:
    """The picture, 8-bit, of tiles ``size`` pixels wide."""
    fitted = tabulate(fit.model, table.grid, name=fit.name)
    spheres = [_sphere(brdf, size) for brdf in (table, fitted)]
    plugin = to_plugin(fit.model) if _is_plugin(fit.model) else None
    renderer = Renderer("teapot", size=(size, size), spp=SPP, denoise=denoiser_available())
    scenes = [renderer.picture(worn) for worn in (table, plugin or fitted)]
    difference = f"difference, 0 to {WHITE:g} CIEDE2000"
    labels = (fit.name, fit.model.formula, difference, "Mitsuba: the table")
    labels += (f"Mitsuba: {'its plugin' if plugin else 'the fit as a table'}", difference)
    rows = [[*pair, _difference(*pair)] for pair in (spheres, scenes)]
    return sheet([tile for row in rows for tile in row], labels=labels, columns=3)


def to_plugin(model: Principled) -> Material:
    """The model as Mitsuba's ``principled``, for ``mitsuba.load_dict``."""
    parameters = model.parameters()
    del parameters["tangent_rotation"]  # Mitsuba's is that of the mesh
    colour = {"type": "rgb", "value": parameters.pop("base_color")}
    return {"type": "principled", "base_color": colour, **parameters}


def _is_plugin(model: AnalyticModel) -> TypeGuard[Principled]:
    """Whether Mitsuba has just this."""
    return isinstance(model, Principled) and not model.tangent_rotation


def _sphere(table: TabularBrdf, size: int) -> np.ndarray:
    scene = replace(PACING_SCENE, name="fit", size=size, n_points=2)
    picture = np.zeros((size, size, 3), np.float32)
    picture[scene.mask()] = portrait(table.values, table.grid, scene)
    return picture


def _difference(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """CIEDE2000 of two pictures, as greys."""
    difference = ciede2000(_lab(a), _lab(b)) / WHITE
    grey = np.round(255 * np.clip(difference, 0, 1)).astype(np.uint8)
    return np.repeat(grey[..., None], 3, axis=-1)


def _lab(picture: np.ndarray) -> np.ndarray:
    return appearance(picture.astype(np.float32))
