"""``plan``: which directions to measure, so that the rest of a material is known best.

The rows x_r of a library (its materials, channel by channel, in the log-relative mapping, about their mean) say how materials vary: like sums of them with
independent weights of variance 1 / n_rows. What is measured at directions j with an error of `NOISE` leaves those weights with the covariance C,

    C = C - C x_j x_j^T C / (x_j^T C x_j + eta)        eta = n_rows NOISE^2, starting from 1

and the cells with a variance that sums to tr(G C), G = sum over cells of x x^T. Each direction is the one that takes the most off that sum,

    x_j^T C G C x_j / (x_j^T C x_j + eta)

and then each is exchanged for a better one, given all others, until none is better. Without exchange and error this is the simultaneous orthogonal matching pursuit
of FROST; the exchange is Nielsen's, whose criterion is another: the condition number of the rows at the directions. Directions so chosen come nearer than both
(docs/recovery.md).
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float64

from .._types import Directions
from ..brdf import quadrature
from ..errors import LibraryError
from ..library import Library, open_library
from ..measurements import Measurements
from ..tasks import HERE, Work
from .library_samples import measured_in_all, spread_pairs, values_at
from .log_relative import mapped
from .setup import as_rows

NOISE = 0.1
"""Error of a measurement that is planned for, natural logarithms: about 10 %."""
N_PAIRS = 6000
"""Pairs of directions that stand for all, and of which a plan is chosen."""
N_SWEEPS = 5
_HELD = 1e-6
"""Of what varies, the share that is not followed."""


Rows = Float64[np.ndarray, "n_rows _"]


@dataclass(frozen=True, eq=False)
class Plan:
    """Pairs of directions to measure, the most telling first."""

    wi: Directions
    wo: Directions
    left: Float64[np.ndarray, " n"]
    """Root mean square over cells of what is still unknown after each, natural logarithms."""
    unknown: float
    """The same before any."""


def plan(
    library: Library | str,
    n: int,
    *,
    max_theta: float = quadrature.GRAZING_DEGREES,
    in_plane: bool = False,
    given: Measurements | None = None,
    work: Work = HERE,
) -> Plan:
    """Which ``n`` pairs of directions to measure of a material that is like those of a library.

    Parameters
    ----------
    library : Library or str
        Open, or as `open_library` takes it.
    max_theta : float
        How far the instrument reaches from the normal, in degrees.
    in_plane : bool
        Whether it keeps the light, the viewer and the normal in one plane.
    given : Measurements, optional
        What is measured already: the directions count.

    Examples
    --------
    >>> import halfway
    >>> halfway.plan("builtin:merl-abc", 3, max_theta=75).wi.shape
    (3, 3)

    Raises
    ------
    LibraryError
        When no directions are within reach, or fewer than ``n``.
    """
    opened = open_library(library)
    cells = _Pairs.of(opened, *spread_pairs(N_PAIRS, isotropic=opened.grid.is_isotropic), work)
    free = cells
    if in_plane:
        pairs = spread_pairs(N_PAIRS, isotropic=opened.grid.is_isotropic, in_plane=True)
        free = _Pairs.of(opened, *pairs, work)
    free = free.within(max_theta)
    if len(free.wi) < n:
        raise LibraryError(
            f"{len(free.wi)} pairs of directions of {opened.name} are within {max_theta:g} degrees of the normal: "
            f"expected {n} or more. Plan fewer, or reach further."
        )
    known = free.rows[:, :0] if given is None else _Pairs.of(opened, given.wi, given.wo, work).rows
    design = _Design.of(cells.rows, known, free.rows)
    chosen = design.in_order(design.exchanged(design.grown([], n)))
    left = [design.left(chosen[:i]) for i in range(n + 1)]
    return Plan(free.wi[chosen], free.wo[chosen], np.array(left[1:]), left[0])


class _Pairs(NamedTuple):
    """Pairs of directions at which all materials of a library are measured, and its rows there."""

    wi: Directions
    wo: Directions
    rows: Float64[np.ndarray, "n_rows n"]
    """Log-relative, about their mean."""

    @classmethod
    def of(cls, library: Library, wi: Directions, wo: Directions, work: Work) -> "_Pairs":
        values = values_at(library, wi, wo, work)
        used = measured_in_all(values)
        rows = as_rows(mapped(values[..., used], (wi[used, 2], wo[used, 2])), "apart")
        return cls(wi[used], wo[used], rows - rows.mean(axis=0))

    def within(self, max_theta: float) -> "_Pairs":
        """Those of which neither direction is further than so many degrees from the normal."""
        near = np.minimum(self.wi[:, 2], self.wo[:, 2]) >= np.cos(np.radians(max_theta))
        return _Pairs(self.wi[near], self.wo[near], self.rows[:, near])


@dataclass(frozen=True, eq=False)
class _Design:
    """What each candidate would tell, in principal components of what varies."""

    free: Float64[np.ndarray, "k n"]
    """Of the candidates."""
    given: Float64[np.ndarray, "k n_given"]
    """Of what is measured already."""
    variances: Float64[np.ndarray, " k"]
    """What each component brings to the mean over cells."""
    eta: float

    @classmethod
    def of(cls, cells: Rows, given: Rows, free: Rows) -> "_Design":
        variances, axes = np.linalg.eigh(cells @ cells.T / cells.size)
        axes = axes[:, kept := variances > _HELD * variances[-1]]
        return cls(axes.T @ free, axes.T @ given, variances[kept], len(cells) * NOISE**2)

    def grown(self, chosen: list[int], n: int) -> list[int]:
        """``n`` more, each the best after those before it."""
        for _ in range(n):
            chosen = [*chosen, self._best(chosen)]
        return chosen

    def exchanged(self, chosen: list[int]) -> list[int]:
        """Each exchanged for the best beside the others, until all are."""
        for _ in range(N_SWEEPS):
            before = chosen
            for i in range(len(chosen)):
                others = chosen[:i] + chosen[i + 1 :]
                chosen = [*chosen[:i], self._best(others), *chosen[i + 1 :]]
            if chosen == before:
                break
        return chosen

    def in_order(self, chosen: list[int]) -> list[int]:
        """The same, each the best of those that are left after those before it."""
        ordered: list[int] = []
        while len(ordered) < len(chosen):
            gains = self._gains(ordered)
            ordered.append(max(set(chosen) - set(ordered), key=lambda j: gains[j]))
        return ordered

    def left(self, chosen: list[int]) -> float:
        """Root mean square over cells of what is unknown."""
        return float(np.sqrt(np.diag(self._covariance(chosen)) @ self.variances))

    def _best(self, chosen: list[int]) -> int:
        gains = self._gains(chosen)
        gains[chosen] = -np.inf
        return int(np.argmax(gains))

    def _gains(self, chosen: list[int]) -> Float64[np.ndarray, " n"]:
        """What each candidate takes off the sum of variances."""
        unknown = self._covariance(chosen) @ self.free
        taken = self.variances @ unknown**2
        return taken / (np.einsum("kn,kn->n", self.free, unknown) + self.eta)

    def _covariance(self, chosen: list[int]) -> Float64[np.ndarray, "k k"]:
        known = np.concatenate([self.given, self.free[:, chosen]], axis=1)
        noisy = known.T @ known + self.eta * np.eye(known.shape[1])
        return np.eye(len(known)) - known @ np.linalg.solve(noisy, known.T)
