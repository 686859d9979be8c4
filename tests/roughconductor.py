"""Tables made of Mitsuba's own `roughconductor`, for tests: the truth is at hand in the same renderer."""

from functools import cache

import numpy as np

from halfway.brdf import TabularBrdf
from halfway.halfdiff import Grid
from halfway.render import register

register()

import drjit as dr  # noqa: E402
import mitsuba as mi  # noqa: E402

CHUNK = 1 << 20


def plugin(alpha_u: float, alpha_v: float) -> dict:
    """The dict of a coppery conductor; its tangent is u."""
    return {
        "type": "roughconductor",
        "distribution": "ggx",
        "alpha_u": alpha_u,
        "alpha_v": alpha_v,
        "eta": {"type": "rgb", "value": [0.25, 0.6, 1.1]},
        "k": {"type": "rgb", "value": [3.6, 2.6, 2.3]},
    }


def table(description: dict, grid: Grid, name: str = "") -> TabularBrdf:
    """The f_r of a plugin at the cell centres."""
    bsdf = mi.load_dict(description)
    wi, wo = (v.reshape(-1, 3) for v in grid.directions())
    mask = grid.mask().ravel()
    values = np.full((grid.size, 3), np.nan, np.float32)
    values[mask] = f_r(bsdf, wi[mask], wo[mask])
    return TabularBrdf(np.ascontiguousarray(values.T).reshape(3, *grid.shape), grid, name=name)


def f_r(bsdf, wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
    """In 1/sr, shape (n, 3), of pairs above the horizon."""
    found = [np.zeros((0, 3), np.float32)]
    for start in range(0, len(wi), CHUNK):
        part = slice(start, start + CHUNK)
        si = dr.zeros(mi.SurfaceInteraction3f, len(wi[part]))
        si.wi = vectors(wo[part])
        values = bsdf.eval(mi.BSDFContext(), si, vectors(wi[part]))
        found.append(np.array(values).T / wi[part, 2:])
    return np.concatenate(found)


def vectors(v: np.ndarray):
    return mi.Vector3f(np.ascontiguousarray(v.T, np.float32))


@cache
def anisotropic(alpha_u: float, alpha_v: float) -> TabularBrdf:
    """On a grid of half a turn: both sides of a groove are alike."""
    return table(plugin(alpha_u, alpha_v), Grid.anisotropic(64, 36, 24, 36, period=np.pi))
