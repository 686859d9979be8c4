"""Basis samples: the values of a library's materials on a few thousand cells, and their body colours.

Table metrics between mixes cost seconds on whole tables and milliseconds on a sample of the cells. Cells are drawn with a
probability q_j, half by solid angle and half evenly (the MERL grid is dense where highlights are), systematically
along the grid, and weigh (solid angle)_j / q_j, so that sums over the sample estimate the integrals of
`halfway.brdf.metrics` (16,384 of the MERL grid's 1,458,000 to 1 %, the log metric to .2 %). Weighing 1 / q_j instead
estimates sums over cells, in which highlights count as much as the grid resolves them. Only cells that are measured in every material and within 80 degrees of the normal are drawn.

The **body colour** of a material is its mean over the cells with theta_h > 25 and theta_d < 50 degrees, beside the
highlight and away from grazing: a linear functional, so the body colour of a mix is the mix of the body colours.
"""

from dataclasses import dataclass
from functools import partial
from typing import Literal, NamedTuple

import numpy as np
from jaxtyping import Float, Float32, Float64, Int

from .._types import Mask
from ..brdf import metrics, quadrature
from ..errors import LibraryError
from ..halfdiff import Grid
from ..library import Library
from ..recipes import Blend
from ..tasks import HERE, Work

BODY_THETA_H_DEGREES = 25.0
BODY_THETA_D_DEGREES = 50.0
N_CELLS = 16384

Measure = Literal["solid angle", "cell"]


@dataclass(frozen=True, eq=False)
class CellSamples:
    """The values of all materials of a library on a sample of its cells."""

    names: tuple[str, ...]
    """The materials, in the library's order."""
    cells: Int[np.ndarray, " n_cells"]
    """Of the grid, flat."""
    values: Float32[np.ndarray, "3 N n_cells"]
    """f_r in 1/sr."""
    weights: Float64[np.ndarray, " n_cells"]
    """Share of each cell in an integral over pairs of directions; they sum to 1."""
    cell_weights: Float64[np.ndarray, " n_cells"]
    """Share of each cell in a sum over the cells of the grid; they sum to 1."""
    cosines: Float64[np.ndarray, "2 n_cells"]
    """Of the angles that wi and wo make with the normal."""
    body: Float64[np.ndarray, "N 3"]
    """Body colours, 1/sr."""

    @classmethod
    def fit(
        cls, library: Library, *, n_cells: int = N_CELLS, seed: int = 0, work: Work = HERE
    ) -> "CellSamples":
        """Samples of ``library`` on about ``n_cells`` cells; kept in the cache under its checksum.

        Raises
        ------
        LibraryError
            As `body_colours`.
        """
        key = f"samples-1-{n_cells}-{seed}-{library.checksum}"
        drawn = _draw_cells(library.grid, n_cells, seed)
        arrays = work.cached(key, lambda: _read(library, drawn.cells, work))
        values = arrays["values"]
        kept = ~np.isnan(values).any(axis=(0, 1))
        return cls(
            library.names,
            drawn.cells[kept],
            np.ascontiguousarray(values[..., kept]),
            _shares(drawn.weights[kept]),
            _shares(drawn.cell_weights[kept]),
            drawn.cosines[:, kept],
            arrays["body"],
        )

    def mix(self, weights: Float[np.ndarray, "3 *k N"]) -> Float32[np.ndarray, "3 *k n_cells"]:
        """Values of linear mixes, given by their weights over all materials."""
        few = weights.astype(np.float32)
        return np.stack([w @ values for w, values in zip(few, self.values, strict=True)])

    def body_colour(self, weights: Float[np.ndarray, "3 *k N"]) -> Float64[np.ndarray, "*k 3"]:
        """Body colours of linear mixes, 1/sr."""
        sums = [w @ body for w, body in zip(weights, self.body.T, strict=True)]
        return np.stack(sums, axis=-1)

    def features(
        self,
        values: Float32[np.ndarray, "3 *k n_cells"],
        metric: metrics.Metric = "log",
        *,
        by: Measure = "solid angle",
    ) -> Float32[np.ndarray, "*k n_features"]:
        """Vectors whose Euclidean distances are the differences in a metric (not ``relative``).

        ``by`` says what a sum over cells weighs them by: their solid angle, as the metrics do, or nothing.
        """
        cos_i, cos_o = self.cosines.astype(np.float32)
        weights = self.weights if by == "solid angle" else self.cell_weights
        scale = np.sqrt(weights / 3).astype(np.float32)
        mapped = metrics.MAPPINGS[metric](values, cos_i, cos_o) * scale
        return np.concatenate(list(mapped), axis=-1)


def body_mask(grid: Grid) -> Mask:
    """The cells that a body colour is the mean of."""
    angles = grid.centres()
    beside = angles.theta_h > np.radians(BODY_THETA_H_DEGREES)
    steep = angles.theta_d < np.radians(BODY_THETA_D_DEGREES)
    return grid.mask() & beside & steep


def body_colours(
    library: Library, *, blend: Blend = Blend.LINEAR, work: Work = HERE
) -> Float64[np.ndarray, "N 3"]:
    """The body colours of all materials of ``library``, in the mapping of a blend; kept in the cache under its checksum.

    Raises
    ------
    LibraryError
        When a material is measured on none of the cells of `body_mask`.
    """

    def read() -> dict[str, np.ndarray]:
        cells = np.flatnonzero(body_mask(library.grid))
        tasks, label = range(len(library)), "Body colours"
        rows = work.run(partial(_body, library, cells, blend), tasks, label=label)
        return {"body": np.stack(list(rows))}

    return work.cached(f"body-1-{blend.mapping.name}-{library.checksum}", read)["body"]


class _Drawn(NamedTuple):
    cells: Int[np.ndarray, " n_cells"]
    weights: Float64[np.ndarray, " n_cells"]
    cell_weights: Float64[np.ndarray, " n_cells"]
    cosines: Float64[np.ndarray, "2 n_cells"]


def _draw_cells(grid: Grid, n_cells: int, seed: int) -> _Drawn:
    """Systematic sampling: evenly spaced along the cumulative probability, from a random start."""
    setting = quadrature.comparison_cells(grid)
    allowed = np.flatnonzero(grid.mask() & ~setting.grazing)
    solid_angle = setting.solid_angle.ravel()[allowed]
    probability = (solid_angle / solid_angle.sum() + 1 / len(allowed)) / 2
    start = np.random.default_rng(seed).random()
    nth = np.searchsorted(np.cumsum(probability) * n_cells, np.arange(n_cells) + start)
    drawn, times = np.unique(np.minimum(nth, len(allowed) - 1), return_counts=True)
    cells = allowed[drawn]
    cosines = np.stack([setting.cos_i.ravel()[cells], setting.cos_o.ravel()[cells]])
    once = times / probability[drawn]
    return _Drawn(cells, once * solid_angle[drawn], once, cosines)


def _shares(weights: Float64[np.ndarray, " n"]) -> Float64[np.ndarray, " n"]:
    return weights / weights.sum()


def _read(
    library: Library, cells: Int[np.ndarray, " n_cells"], work: Work
) -> dict[str, np.ndarray]:
    read = partial(_read_one, library, cells, np.flatnonzero(body_mask(library.grid)))
    rows = list(work.run(read, range(len(library)), label="Basis samples"))
    values, body = zip(*rows, strict=True)
    return {"values": np.stack(values, axis=1), "body": np.stack(body)}


def _read_one(
    library: Library, cells: Int[np.ndarray, " n_cells"], body: Int[np.ndarray, " n_body"], i: int
) -> tuple[Float32[np.ndarray, "3 n_cells"], Float64[np.ndarray, " 3"]]:
    row = library.row(i)
    return row[:, cells], _body_colour(library, row, body, i)


def _body(
    library: Library, cells: Int[np.ndarray, " n_body"], blend: Blend, i: int
) -> Float64[np.ndarray, " 3"]:
    return _body_colour(library, library.row(i), cells, i, blend)


def _body_colour(
    library: Library,
    row: Float32[np.ndarray, "3 p"],
    cells: Int[np.ndarray, " n_body"],
    i: int,
    blend: Blend = Blend.LINEAR,
) -> Float64[np.ndarray, " 3"]:
    body = blend.mapping.to(row[:, cells])
    if np.isnan(body).all(axis=1).any():
        raise LibraryError(
            f"{library.names[i]} of {library.name} has no measured cell with theta_h above {BODY_THETA_H_DEGREES:g} and "
            f"theta_d below {BODY_THETA_D_DEGREES:g} degrees: a body colour is the mean of those. Build a library "
            "without it or on a finer grid, or take --space linear."
        )
    return np.asarray(np.nanmean(body, axis=1, dtype=np.float64))
