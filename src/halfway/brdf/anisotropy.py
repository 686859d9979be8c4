"""How anisotropic a material is: how much its values vary as the surface turns about its normal.

    a = sum over pairs of the standard deviation over turns / sum over pairs of the mean over turns

of f_r cos_i cos_o, which grazing pairs do not rule. 0 for what is isotropic; about .3 for cloth, .5 to 1 for brushed metal. The pairs are
spread evenly over the positions of a MERL table, so that highlights count.
"""

import numpy as np

from ..halfdiff import from_half_diff, turn
from .brdf import Brdf, turns
from .quadrature import spread_angles

_N_PAIRS = 1000


def anisotropy(brdf: Brdf) -> float:
    """How much the values of a BRDF vary as it turns: standard deviation over mean; 0 if it is isotropic."""
    if brdf.is_isotropic:
        return 0.0
    wi, wo = from_half_diff(spread_angles(_N_PAIRS))
    values = np.stack([brdf.eval(turn(wi, angle), turn(wo, angle)) for angle in turns()])
    values *= np.maximum(wi[:, 2:] * wo[:, 2:], 0)
    known = np.isfinite(values).all(axis=(0, 2))
    scale = np.abs(values[:, known].mean(axis=0)).sum()
    return float(values[:, known].std(axis=0).sum() / scale) if scale > 0 else 0.0
