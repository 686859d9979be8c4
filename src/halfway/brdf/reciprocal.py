"""What a table over half/difference angles can hold of a measurement: the mean over both orders of light and viewer.

Such a table is reciprocal by its coordinates, and a measurement is not quite. Where one order is unmeasured the other stands
for both, and what noise makes negative is 0.
"""

import numpy as np

from .._types import Directions, Part, Table, Values
from ..halfdiff import Grid
from .brdf import Brdf, TurnedMean


class Measurement(Brdf):
    """A material as it was measured, which need not be reciprocal."""

    def turned_mean(self) -> Brdf:
        return self if self.is_isotropic else TurnedMean(ReciprocalMean(self))

    def _sample_rows(self, grid: Grid, rows: Part) -> Table:
        return ReciprocalMean(self)._sample_rows(grid, rows)


class ReciprocalMean(Brdf):
    """A material with light and viewer exchanged half of the time."""

    def __init__(self, material: Brdf) -> None:
        self.material = material

    @property
    def is_isotropic(self) -> bool:
        return self.material.is_isotropic

    def eval(self, wi: Directions, wo: Directions) -> Values:
        there, back = self.material.eval(wi, wo), self.material.eval(wo, wi)
        mean = (np.where(np.isnan(there), back, there) + np.where(np.isnan(back), there, back)) / 2
        return np.maximum(mean, 0)

    def fingerprint(self) -> bytes:
        return b"reciprocal mean of " + self.material.fingerprint()
