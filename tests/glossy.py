"""Materials of a few parameters for tests: a matte body under a lobe of Trowbridge and Reitz (GGX)."""

import numpy as np

from halfway.brdf import TabularBrdf, fresnel
from halfway.halfdiff import Grid, cosines
from halfway.library import ProceduralLibrary

GRID = Grid.merl(24, 18, 12)


def glossy(
    body: tuple[float, float, float], strength: float, alpha: float, grid: Grid = GRID
) -> TabularBrdf:
    """A body of this albedo under a lobe of this roughness; ``strength`` 1 is the Fresnel reflectance of glass."""
    angles = grid.centres()
    cos_i, cos_o = cosines(angles.theta_h, angles.theta_d, angles.phi_d)
    tan = np.tan(angles.theta_h) / alpha
    d = 1 / (np.pi * alpha**2 * np.cos(angles.theta_h) ** 4 * (1 + tan**2) ** 2)
    # The larger of the cosines twice: passive at grazing angles, and the same near the mirror direction.
    lobe = fresnel(np.cos(angles.theta_d), 1.5) * d / (4 * np.maximum(cos_i, cos_o) ** 2)
    values = np.array(body)[:, None, None, None] / np.pi + strength * np.broadcast_to(
        lobe, grid.shape
    )
    return TabularBrdf(np.where(grid.mask(), values, np.nan).astype(np.float32), grid)


def library(n: int = 12, seed: int = 0) -> ProceduralLibrary:
    """``n`` materials, from matte to shiny, of all colours."""
    rng = np.random.default_rng(seed)
    materials = {
        f"m{i}": glossy(
            tuple(rng.uniform(0.02, 0.6, 3)), rng.uniform(0, 1), 0.05 * 8 ** rng.uniform()
        )
        for i in range(n)
    }
    return ProceduralLibrary("glossy", materials, grid=GRID)
