"""What every BRDF can do: be evaluated, and be sampled on a grid.

``f_r(wi, wo)`` is in 1/sr and does not include the cosine. Directions are those of `halfway.halfdiff`.

A material that depends on phi_h has more than a grid without that axis can hold: there the mean over turns of the surface
about its normal stands for it, and a warning says how much they differ. One that does not is the same in all cells that
differ in phi_h alone, and is computed once for them.
"""

import warnings
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any, ClassVar

import numpy as np
from jaxtyping import Float32

from .._types import Directions, Part, Table, Values
from ..halfdiff import MERL, Grid, HalfDiff, from_half_diff, turn
from .quadrature import spread_angles

N_TURNS = 16
"""About the normal, over which a material is averaged that a grid cannot hold otherwise."""
_N_PAIRS = 1000


class Brdf(ABC):
    """A reflectance function of three colour channels (linear RGB)."""

    cells_in_cache: ClassVar[int] = 32768
    """Float64 arrays of this many stay in a core's cache: the MERL grid goes two to three times faster than in one piece."""

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

    @property
    def own_grid(self) -> Grid:
        """On which it is tabulated where nobody asks for another: the MERL grid, or the usual one with phi_h."""
        return MERL if self.is_isotropic else Grid.anisotropic()

    def anisotropy(self) -> float:
        """How much the values vary as the surface turns about its normal; 0 if it is isotropic.

            sum over pairs of the standard deviation over turns / sum over pairs of the mean over turns

        of f_r cos_i cos_o, which grazing pairs do not rule; about .3 for cloth, .5 to 1 for brushed metal. The pairs are
        spread evenly over the positions of a MERL table, so that highlights count.
        """
        if self.is_isotropic:
            return 0.0
        wi, wo = from_half_diff(spread_angles(_N_PAIRS))
        values = np.stack([self.eval(turn(wi, angle), turn(wo, angle)) for angle in turns()])
        values *= np.maximum(wi[:, 2:] * wo[:, 2:], 0)
        known = np.isfinite(values).all(axis=(0, 2))
        scale = np.abs(values[:, known].mean(axis=0)).sum()
        return float(values[:, known].std(axis=0).sum() / scale) if scale > 0 else 0.0

    def turned_mean(self) -> "Brdf":
        """The mean over turns about the normal, which is isotropic; itself if it is that already."""
        return self if self.is_isotropic else TurnedMean(self)

    def scaled(self, factor: float) -> "Brdf":
        """The material with its values times a positive number."""
        return Scaled(self, factor)

    def sample_rows(self, grid: Grid, rows: Part) -> Table:
        """Samples at the cell centres of a part of the grid; NaN off the grid's mask.

        ``rows`` is a range of the first axis, or a tuple with a range of each of the leading axes.
        """
        if self.is_isotropic:
            return _lifted(self._sample_rows, grid, rows)
        if grid.is_isotropic:
            return _mean_for(self, grid).sample_rows(grid, rows)
        return self._sample_rows(grid, rows)

    @classmethod
    def sample_many(
        cls, brdfs: Sequence[Any], grid: Grid, rows: Part
    ) -> Float32[np.ndarray, "3 N *part"]:
        """`sample_rows` of each of ``brdfs``, all of this class: a formula may compute them together."""
        if all(brdf.is_isotropic for brdf in brdfs):
            return _lifted(partial(cls._sample_many, brdfs), grid, rows)
        if grid.is_isotropic:
            return np.stack([brdf.sample_rows(grid, rows) for brdf in brdfs], axis=1)
        return cls._sample_many(brdfs, grid, rows)

    def _sample_rows(self, grid: Grid, rows: Part) -> Table:
        """`sample_rows` on a grid that has the angles that the material depends on."""
        lit = grid.mask()[rows]
        samples = np.full((3, *lit.shape), np.nan, np.float32)
        for piece, centres in self._pieces(grid, rows, self.cells_in_cache):
            # An angle that is 0 along an axis still has its cells.
            pairs = from_half_diff(centres)
            wi, wo = (np.broadcast_to(d, (*lit[piece].shape, 3))[lit[piece]] for d in pairs)
            samples[:, piece][:, lit[piece]] = self.eval(wi, wo).T
        return samples

    @staticmethod
    def _pieces(grid: Grid, rows: Part, n_cells: int) -> Iterator[tuple[slice, HalfDiff]]:
        """Ranges of the first axis of a part of a grid, of about ``n_cells`` each, and the centres there."""
        shape = grid.mask()[rows].shape
        ranges = rows if isinstance(rows, tuple) else (rows,)
        first = range(grid.shape[0])[ranges[0]] if ranges else range(grid.shape[0])
        step = max(1, n_cells // max(1, int(np.prod(shape[1:]))))
        for start in range(0, len(first), step):
            of_all = slice(first.start + start, first.start + min(start + step, len(first)))
            yield slice(start, start + step), grid.centres((of_all, *ranges[1:]))

    @classmethod
    def _sample_many(
        cls, brdfs: Sequence[Any], grid: Grid, rows: Part
    ) -> Float32[np.ndarray, "3 N *part"]:
        samples = np.empty((3, len(brdfs), *grid.mask()[rows].shape), np.float32)
        for i, brdf in enumerate(brdfs):
            samples[:, i] = brdf.sample_rows(grid, rows)
        return samples


class TurnedMean(Brdf):
    """The mean of a material over `N_TURNS` turns about its normal."""

    def __init__(self, material: Brdf) -> None:
        self.material = material
        self.name = str(getattr(material, "name", ""))

    @property
    def is_isotropic(self) -> bool:
        return True  # up to what is between the turns

    @property
    def about(self) -> str:
        return f"the mean over turns of {self.material.about}"

    def eval(self, wi: Directions, wo: Directions) -> Values:
        total = np.zeros((*np.broadcast_shapes(wi.shape, wo.shape)[:-1], 3))
        for angle in turns():
            total += self.material.eval(turn(wi, angle), turn(wo, angle))
        return total / N_TURNS

    def fingerprint(self) -> bytes:
        return b"turned mean of " + self.material.fingerprint()


class Scaled(Brdf):
    """A material with its values times a number."""

    def __init__(self, material: Brdf, factor: float) -> None:
        self.material = material
        self.factor = factor
        self.name = str(getattr(material, "name", ""))

    @property
    def is_isotropic(self) -> bool:
        return self.material.is_isotropic

    @property
    def about(self) -> str:
        return f"{self.material.about}, times {self.factor:g}"

    def turned_mean(self) -> Brdf:
        return self.material.turned_mean().scaled(self.factor)

    def eval(self, wi: Directions, wo: Directions) -> Values:
        return self.factor * self.material.eval(wi, wo)

    def fingerprint(self) -> bytes:
        return f"{self.factor!r} times ".encode() + self.material.fingerprint()

    def _sample_rows(self, grid: Grid, rows: Part) -> Table:
        return np.float32(self.factor) * self.material.sample_rows(grid, rows)


def turns() -> Iterator[float]:
    """Angles, evenly over a whole turn."""
    return (2 * np.pi * i / N_TURNS for i in range(N_TURNS))


def _mean_for(brdf: Brdf, grid: Grid) -> Brdf:
    """What stands for an anisotropic material on a grid without phi_h, with a warning that says how good it is."""
    warnings.warn(
        f"{getattr(brdf, 'name', '') or 'the material'} is anisotropic: its values vary by {brdf.anisotropy():.0%} as it turns "
        f"about its normal. Its mean over turns stands for it on a grid of {grid} cells; one with phi_h, such as "
        "--grid 48x36x24x36, keeps it as it is.",
        stacklevel=4,
    )
    return brdf.turned_mean()


def _lifted(sample: Callable[[Grid, Part], np.ndarray], grid: Grid, rows: Part) -> np.ndarray:
    """Samples of what does not depend on phi_h, with what is there of that axis behind the others' samples."""
    if grid.is_isotropic:
        return sample(grid, rows)
    i = grid.axes.index(grid.axis("phi_h"))
    ranges = rows if isinstance(rows, tuple) else (rows,)
    samples = sample(grid.without("phi_h"), ranges[:i] + ranges[i + 1 :])
    of_all = range(grid.shape[i])
    n = len(of_all[ranges[i]]) if i < len(ranges) else len(of_all)
    before = samples.ndim - len(grid.axes) + 1 + i
    return np.repeat(np.expand_dims(samples, before), n, axis=before)
