"""A library as an instrument would have measured it: what can be known about recovering before any material is measured.

The samples of all materials at some pairs of directions (a *setup*) say how much weight each would give to the others, how far that misses, and
so how to weigh (eta, width). It costs one pass over the library, on some thousand of whose cells leave-one-out is taken; a material that
was measured there is then one small product.
"""

from dataclasses import dataclass, field
from functools import cached_property, partial
from itertools import product
from typing import Literal

import numpy as np
from jaxtyping import Float, Float32, Float64, Int

from .._types import Directions
from ..errors import LibraryError
from ..library import Library
from ..tasks import HERE, Work
from .library_samples import measured_in_all, spread_pairs, values_at
from .log_relative import Cosines, mapped, unmapped
from .regression import ETAS, WIDTHS, Regression

Channels = Literal["apart", "together"]
N_PROBES = 2048
"""Pairs of directions on which leave-one-out is taken."""


@dataclass(frozen=True, eq=False)
class Probes:
    """A library at pairs of directions that stand for all: where leave-one-out is taken."""

    values: Float32[np.ndarray, "3 N n_pairs"]
    """f_r in 1/sr."""
    cosines: Cosines

    @classmethod
    def of(cls, library: Library, *, work: Work = HERE) -> "Probes":
        """The pairs at which all materials are measured, of `N_PROBES` spread evenly over a table."""
        wi, wo = spread_pairs(N_PROBES, isotropic=library.grid.is_isotropic)
        values = values_at(library, wi, wo, work).astype(np.float32)
        used = measured_in_all(values)
        cos_i, cos_o = (v[used, 2].astype(np.float32) for v in (wi, wo))
        return cls(values[..., used], (cos_i, cos_o))

    def batches(self, channels: Channels) -> Float32[np.ndarray, "b n_rows n_pairs"]:
        """Log-relative values."""
        return as_batches(mapped(self.values, self.cosines), channels)

    def errors(
        self, left_out: Float64[np.ndarray, "n_rows n_rows"], channels: Channels
    ) -> Float32[np.ndarray, "b n_rows n_pairs"]:
        """By how much the rows are missed in the mapping."""
        batches = self.batches(channels)
        return left_out.astype(np.float32) @ batches - batches

    def seen(self, channels: Channels) -> Float32[np.ndarray, "b n_rows n_pairs"]:
        """``ln(1 + f cos_i)``, in which errors count."""
        return as_batches(np.log1p(self.values * self.cosines[0]), channels)


@dataclass(frozen=True, eq=False)
class Setup:
    """The materials of a library at some pairs of directions, and how others are recovered from there."""

    library: Library
    wi: Directions
    wo: Directions
    used: Int[np.ndarray, " n_used"]
    """Which of the directions count: those at which all materials are measured."""
    values: Float64[np.ndarray, "3 N n_used"]
    """Of the materials, f_r in 1/sr."""
    channels: Channels
    regression: Regression
    best_error: float
    """Of leave-one-out: the mean of ``|ln(1 + f cos_i) - ln(1 + g cos_i)|`` over a table's cells."""
    probes: Probes = field(repr=False)

    @classmethod
    def of(
        cls,
        library: Library,
        wi: Directions,
        wo: Directions,
        *,
        weights: Float64[np.ndarray, " n"] | None = None,
        channels: Channels = "apart",
        probes: Probes | None = None,
        work: Work = HERE,
    ) -> "Setup":
        """The setup with the smallest leave-one-out error.

        Parameters
        ----------
        wi, wo : float array, shape (n, 3)
            Unit vectors above the horizon.
        weights : float array, shape (n,)
            How much each pair counts; all alike without.
        channels : {"apart", "together"}
            Whether each channel is recovered from those of all materials by itself, or one weight holds for a material's three.
        probes : Probes, optional
            Of the library, where many setups share them.

        Raises
        ------
        LibraryError
            When the library is measured at none of the directions in all materials, or has fewer than two.
        """
        if len(library) < 2:
            raise LibraryError(
                f"{library.name} has one material: expected two or more to recover another from."
            )
        probes = probes or Probes.of(library, work=work)
        values = values_at(library, wi, wo, work)
        used = np.flatnonzero(measured_in_all(values))
        if not len(used):
            raise LibraryError(
                f"{library.name} is measured at none of {len(wi)} pairs of directions in all materials: expected one or more. "
                "Give pairs further from grazing."
            )
        values = values[..., used]
        share = np.ones(len(used)) if weights is None else weights[used]
        known = as_rows(mapped(values, (wi[used, 2], wo[used, 2])), channels)
        best, error = _best(known - known.mean(axis=0), share, probes, channels, work)
        return cls(library, wi, wo, used, values, channels, best, error, probes)

    @property
    def cosines(self) -> Cosines:
        """Of the directions that count."""
        return self.wi[self.used, 2], self.wo[self.used, 2]

    def weights(self, values: Float64[np.ndarray, "n 3"]) -> Float64[np.ndarray, "m n_rows"]:
        """Of the materials' rows, for one that has these values at the directions."""
        known, measured = (
            as_rows(mapped(each, self.cosines), self.channels)
            for each in (self.values, values[self.used].T[:, None])
        )
        return self.regression.weights(measured - known.mean(axis=0))

    @cached_property
    def left_out(self) -> Float64[np.ndarray, "n_rows n_rows"]:
        """The weights of each row on those of other materials."""
        return self.regression.left_out()

    @cached_property
    def ratios(self) -> Float32[np.ndarray, " n_ratios"]:
        """How far the library's own materials are missed when they are left out, over the root mean square of that on each cell."""
        errors = self.probes.errors(self.left_out, self.channels)
        return np.sort(np.abs(errors / spread(errors)[:, None]).ravel())

    def half_width(self, level: float) -> float:
        """Of an interval, in root mean squares: the library's own materials lie in it on a share ``level`` of the cells."""
        return float(np.quantile(self.ratios, level))


def as_rows(values: Float[np.ndarray, "3 m n"], channels: Channels) -> Float[np.ndarray, "..."]:
    """What the regression takes for rows: each channel of each material, or the three of a material after each other."""
    m = values.shape[1]
    return (
        values.reshape(3 * m, -1) if channels == "apart" else values.swapaxes(0, 1).reshape(m, -1)
    )


def as_batches(values: Float[np.ndarray, "3 m n"], channels: Channels) -> Float[np.ndarray, "..."]:
    """The same rows where weights on them are applied: all at once, or the rows of each channel by themselves."""
    return values.reshape(1, -1, values.shape[-1]) if channels == "apart" else values


def spread(errors: Float[np.ndarray, "b n_rows n"]) -> Float[np.ndarray, "b n"]:
    """The root mean square over rows."""
    return np.sqrt(np.einsum("brn,brn->bn", errors, errors) / errors.shape[1])


def _best(
    known: Float64[np.ndarray, "n_rows n"],
    shares: Float64[np.ndarray, " n_used"],
    probes: Probes,
    channels: Channels,
    work: Work,
) -> tuple[Regression, float]:
    """The regression with the smallest leave-one-out error, and that."""
    materials = np.arange(len(known)) % probes.values.shape[1]
    shares = np.tile(shares, known.shape[1] // len(shares))
    tried = [
        Regression(known, materials, shares / shares.sum(), width, eta)
        for width, eta in product(WIDTHS, ETAS)
    ]
    error = partial(_seen_error, probes.batches(channels), probes.seen(channels), probes.cosines)
    errors = list(work.run(error, tried, label="Leave one out"))
    best = int(np.argmin(errors))
    return tried[best], errors[best]


def _seen_error(
    batches: Float32[np.ndarray, "b n_rows n_pairs"],
    seen: Float32[np.ndarray, "b n_rows n_pairs"],
    cosines: Cosines,
    regression: Regression,
) -> float:
    """The mean over pairs and rows of ``|ln(1 + f cos_i) - ln(1 + g cos_i)|``, each row recovered without its material."""
    recovered = regression.left_out().astype(np.float32) @ batches
    return float(np.abs(np.log1p(unmapped(recovered, cosines) * cosines[0]) - seen).mean())
