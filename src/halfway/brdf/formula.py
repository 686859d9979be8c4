"""BRDFs given by a formula in half/difference angles."""

import math
from abc import abstractmethod
from typing import ClassVar

import numpy as np

from .._types import Angle, Directions, Mask, Part, Table, Values
from ..halfdiff import Grid, HalfDiff, above_horizon, cosines, to_half_diff
from .brdf import Brdf


class IsotropicModel(Brdf):
    """A BRDF given by a formula in half/difference angles.

    A subclass writes its formula once, in `at`, over arrays that broadcast. On a grid the angles of an axis are
    then handed over unexpanded, so a factor that depends on theta_h alone is computed 90 times, not 1,458,000.
    """

    formula: ClassVar[str] = ""
    """Which formula: part of `fingerprint`, so it changes whenever the values do."""

    @property
    def about(self) -> str:
        return f"a fit ({self.formula})"

    @property
    def is_isotropic(self) -> bool:
        return True

    @abstractmethod
    def at(
        self, theta_h: Angle, theta_d: Angle, phi_d: Angle, cos_i: Angle, cos_o: Angle
    ) -> np.ndarray:
        """f_r in 1/sr, shape (3, ...), of arrays that broadcast together; both cosines are positive."""

    def eval(self, wi: Directions, wo: Directions) -> Values:
        return above_horizon(self._at_pairs, wi, wo)

    def _at_pairs(self, wi: Directions, wo: Directions) -> np.ndarray:
        theta_h, _, theta_d, phi_d = to_half_diff(wi, wo)
        return self.at(theta_h, theta_d, phi_d, wi[:, 2], wo[:, 2])

    def _sample_rows(self, grid: Grid, rows: Part) -> Table:
        return self._sample_shaped(grid, rows, (3,))

    def _sample_shaped(self, grid: Grid, rows: Part, shape: tuple[int, ...]) -> np.ndarray:
        """`sample_rows` of a formula that gives ``shape`` values for a pair of directions."""
        lit = grid.mask()[rows]
        samples = np.full((*shape, *lit.shape), np.nan, np.float32)
        n_cells = self.cells_in_cache * 3 // max(1, math.prod(shape))
        for piece, centres in self._pieces(grid, rows, n_cells):
            values = self._at_centres(centres, lit[piece])
            np.copyto(samples[(*(slice(None) for _ in shape), piece)], values, where=lit[piece])
        return samples

    def _at_centres(self, centres: HalfDiff, lit: Mask) -> np.ndarray:
        theta_h, _, theta_d, phi_d = centres
        cos_i, cos_o = cosines(theta_h, theta_d, phi_d)
        # Off the mask any positive cosine will do: the value is not kept.
        cos_i, cos_o = (np.where(lit, cosine, 1.0) for cosine in (cos_i, cos_o))
        return self.at(theta_h, theta_d, phi_d, cos_i, cos_o)

    def fingerprint(self) -> bytes:
        """Bytes that are the same for the same formula and numbers, on every machine; for a checksum."""
        numbers = (np.asarray(value, "<f8").tobytes() for value in vars(self).values())
        return b"".join([self.formula.encode(), b"\0", *numbers])
