"""A mix whose body has another colour: its highlight stays.

    f' = f + (s - 1) body          per channel, s >= 0

where the body of the mix is what `halfway.brdf.gloss` says. It is read off each theta_d and phi_d by itself, and is never more
than f, so what is non-negative and reciprocal stays so. Where the mix would reflect more than 1, and more than it did
from there, s is as large as it may be.
"""

import numpy as np

from .._types import Table
from ..brdf import TabularBrdf, albedos, gloss
from ..halfdiff import Grid

LIMITED_AT = np.radians([0.0, 20.0, 40.0, 60.0, 70.0, 80.0])
"""Angles of the light from which a mix that was changed reflects no more than it may."""
BodyScale = tuple[float, float, float]
UNSCALED: BodyScale = (1.0, 1.0, 1.0)


def with_body(values: Table, scale: BodyScale, grid: Grid) -> Table:
    """A table, shape (3, p), whose body is multiplied by ``scale``, or by as much as keeps it passive."""
    if scale == UNSCALED:
        return values
    body = gloss.Gloss.of(values, grid).body.reshape(values.shape)
    more = np.array(scale) - 1
    if (more > 0).any():
        own, its_body = (_albedos(each, grid) for each in (values, body))
        room = np.maximum(1, own) - own
        more = np.minimum(more, (room / np.maximum(its_body, 1e-30)).min(axis=0))
    return values + more.astype(np.float32)[:, None] * body


def _albedos(values: Table, grid: Grid) -> np.ndarray:
    return albedos(TabularBrdf(values.reshape(3, *grid.shape), grid), LIMITED_AT)
