"""The materials of a library at pairs of directions, and pairs that stand for all.

Half and difference angles spread evenly over the positions of a MERL table, so that a mean over them is one over its cells: highlights count as finely as
the table resolves them.
"""

from functools import partial

import numpy as np
from jaxtyping import Float, Float64

from .._types import Directions
from ..brdf import quadrature
from ..halfdiff import from_half_diff
from ..library import Library
from ..measurements import Angles
from ..tasks import HERE, Work

_GOLDEN = (5**0.5 - 1) / 2


def spread_pairs(
    n: int, *, isotropic: bool, in_plane: bool = False
) -> tuple[Directions, Directions]:
    """About ``n`` pairs above the horizon, of any azimuth where that tells something; or with the normal in their plane."""
    angles = quadrature.spread_angles(
        4 * n // 3
    )  # of a table's cells, three in four are above the horizon
    turns = 2 * np.pi * (_GOLDEN * np.arange(np.size(angles.phi_d)) % 1)
    angles = angles._replace(
        phi_h=angles.phi_h if isotropic else turns,
        phi_d=np.zeros_like(turns) if in_plane else angles.phi_d,
    )
    wi, wo = from_half_diff(angles)
    lit = np.minimum(wi[:, 2], wo[:, 2]) > 0
    if not isotropic:
        return wi[lit], wo[lit]
    seen = Angles.of(wi[lit], wo[lit])
    # As an instrument is set: the light stays in one plane.
    turned = np.mod(np.asarray(seen.phi_o) - seen.phi_i, 2 * np.pi)
    return seen._replace(phi_i=np.zeros(lit.sum()), phi_o=turned).directions()


def values_at(
    library: Library, wi: Directions, wo: Directions, work: Work = HERE
) -> Float64[np.ndarray, "3 N n"]:
    """f_r of all materials at pairs of directions, 1/sr; NaN where unmeasured."""
    rows = work.run(partial(_at, library, wi, wo), range(len(library)), label="Samples")
    return np.stack(list(rows), axis=1)


def measured_in_all(values: Float[np.ndarray, "3 N n"]) -> np.ndarray:
    """Whether each pair of directions is measured in all materials."""
    return np.asarray(np.isfinite(values).all(axis=(0, 1)))


def _at(library: Library, wi: Directions, wo: Directions, i: int) -> Float64[np.ndarray, "3 n"]:
    return library.material(library.names[i]).eval(wi, wo).T
