"""What every BRDF can do: be evaluated, and be sampled on a grid.

``f_r(wi, wo)`` is in 1/sr and does not include the cosine. Directions are those of `halfway.halfdiff`.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
from jaxtyping import Float32

from .._types import Angle, Directions, Mask, Part, Table, Values
from ..errors import AnisotropyError
from ..halfdiff import Grid, HalfDiff, cosines, to_half_diff


class Brdf(ABC):
    """A reflectance function of three colour channels (linear RGB)."""

    @property
    @abstractmethod
    def is_isotropic(self) -> bool:
        """Whether turning the surface about its normal changes nothing: then values do not depend on phi_h."""

    @abstractmethod
    def eval(self, wi: Directions, wo: Directions) -> Values:
        """f_r in 1/sr, shape (..., 3): 0 where a direction is below the horizon, NaN where unmeasured."""

    @abstractmethod
    def fingerprint(self) -> bytes:
        """Bytes that change when any value of the BRDF does: the material's part of a library's checksum."""

    @property
    def about(self) -> str:
        """What it is, in a few words for people."""
        return f"a formula ({type(self).__name__})"

    def sample_rows(self, grid: Grid, rows: Part) -> Table:
        """Samples at the cell centres of a part of the grid; NaN off the grid's mask.

        ``rows`` is a range of the first axis, or a tuple with a range of each of the leading axes.
        """
        wi, wo = (directions[rows] for directions in grid.directions())
        values = np.moveaxis(self.eval(wi, wo), -1, 0)
        return np.where(grid.mask()[rows], values, np.nan).astype(np.float32)

    @classmethod
    def sample_many(
        cls, brdfs: Sequence[Any], grid: Grid, rows: Part
    ) -> Float32[np.ndarray, "3 N *part"]:
        """`sample_rows` of each of ``brdfs``, all of this class: a formula may compute them together."""
        samples = np.empty((3, len(brdfs), *grid.mask()[rows].shape), np.float32)
        for i, brdf in enumerate(brdfs):
            samples[:, i] = brdf.sample_rows(grid, rows)
        return samples


def require_isotropic(what: Brdf | Grid, quantity: str, *, name: str = "") -> None:
    """Refuse what depends on phi_h where one azimuth would stand for all; ``quantity`` is what would be wrong.

    Raises
    ------
    AnisotropyError
        When a BRDF, or tables on a grid, may depend on phi_h.
    """
    if not what.is_isotropic:
        name = name or str(getattr(what, "name", "")) or "the material"
        raise AnisotropyError(
            f"{name} depends on phi_h (it is anisotropic): {quantity} is worked out for isotropic materials only. "
            "Choose one, or the mean of this one over turns about its normal."
        )


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

    cells_in_cache: ClassVar[int] = 32768
    """Float64 arrays of this many stay in a core's cache: the MERL grid goes two to three times faster than in one piece."""

    @property
    def is_isotropic(self) -> bool:
        return True

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

    def sample_rows(self, grid: Grid, rows: Part) -> Table:
        return self._sample_rows(grid, rows, (3,))

    def _sample_rows(self, grid: Grid, rows: Part, shape: tuple[int, ...]) -> np.ndarray:
        """`sample_rows` of a formula that gives ``shape`` values for a pair of directions."""
        lit = grid.mask()[rows]
        samples = np.full((*shape, *lit.shape), np.nan, np.float32)
        centres = _cut(grid.centres(), rows)
        n_values = lit.size * math.prod(shape) // 3
        n_rows = max(1, self.cells_in_cache * len(lit) // max(n_values, 1))
        for start in range(0, len(lit), n_rows):
            part = slice(start, start + n_rows)
            values = self._at_centres(_cut(centres, part), lit[part])
            np.copyto(samples[(*(slice(None) for _ in shape), part)], values, where=lit[part])
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


def _cut(centres: HalfDiff, part: Part) -> HalfDiff:
    """The angles on a part of the grid; an axis along which one does not vary stays as it is."""
    ranges = part if isinstance(part, tuple) else (part,)
    return HalfDiff(*(_cut_one(np.asarray(angle), ranges) for angle in centres))


def _cut_one(angle: np.ndarray, ranges: tuple[slice, ...]) -> np.ndarray:
    sizes = angle.shape[: len(ranges)]
    return angle[tuple(slice(None) if n == 1 else r for n, r in zip(sizes, ranges, strict=True))]
