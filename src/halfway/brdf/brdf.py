"""What every BRDF can do: be evaluated, and be sampled on a grid.

``f_r(wi, wo)`` is in 1/sr and does not include the cosine. Directions are those of `halfway.halfdiff`.
"""

from abc import ABC, abstractmethod

import numpy as np

from .._types import Angle, Directions, Table, Values
from ..halfdiff import Grid, cosines, to_half_diff


class Brdf(ABC):
    """A reflectance function of three colour channels (linear RGB)."""

    @abstractmethod
    def eval(self, wi: Directions, wo: Directions) -> Values:
        """f_r in 1/sr, shape (..., 3): 0 where a direction is below the horizon, NaN where unmeasured."""

    @abstractmethod
    def fingerprint(self) -> bytes:
        """Bytes that change when any value of the BRDF does: the material's part of a library's checksum."""

    def sample_rows(self, grid: Grid, rows: slice) -> Table:
        """Samples at the cell centres of the rows ``rows`` of the grid's first axis; NaN off the grid's mask."""
        wi, wo = (directions[rows] for directions in grid.directions())
        values = np.moveaxis(self.eval(wi, wo), -1, 0)
        return np.where(grid.mask()[rows], values, np.nan).astype(np.float32)


class IsotropicModel(Brdf):
    """A BRDF given by a formula in half/difference angles.

    A subclass writes its formula once, in `at`, over arrays that broadcast. On a grid the angles of an axis are
    then handed over unexpanded, so a factor that depends on theta_h alone is computed 90 times, not 1,458,000.
    """

    @abstractmethod
    def at(
        self, theta_h: Angle, theta_d: Angle, phi_d: Angle, cos_i: Angle, cos_o: Angle
    ) -> np.ndarray:
        """f_r in 1/sr, shape (3, ...), of arrays that broadcast together; both cosines are positive."""

    def eval(self, wi: Directions, wo: Directions) -> Values:
        cos_i, cos_o = wi[..., 2], wo[..., 2]
        lit = (cos_i > 0) & (cos_o > 0)
        angles = to_half_diff(wi[lit], wo[lit])
        values = np.zeros((*lit.shape, 3))
        values[lit] = self.at(
            angles.theta_h, angles.theta_d, angles.phi_d, cos_i[lit], cos_o[lit]
        ).T
        return values

    def sample_rows(self, grid: Grid, rows: slice) -> Table:
        theta_h, _, theta_d, phi_d = grid.centres()
        theta_h = theta_h[rows]
        cos_i, cos_o = cosines(theta_h, theta_d, phi_d)
        lit = (cos_i > 0) & (cos_o > 0)
        # Off the mask any positive cosine will do: the value is not kept.
        cos_i, cos_o = (np.where(lit, cosine, 1.0) for cosine in (cos_i, cos_o))
        values = self.at(theta_h, theta_d, phi_d, cos_i, cos_o)
        return np.where(lit, values, np.nan).astype(np.float32)
