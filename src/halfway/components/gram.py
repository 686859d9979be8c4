"""Gram matrices of a library: the inner products of its materials, per channel, kept exactly and extended exactly.

With one of the materials, p_0, as the origin,

    D_ij = (p_i - p_0) . (p_j - p_0)        over the cells measured in every material

a sum over cells, so it streams: one block of columns at a time, in float64, from float32 storage. The Gram matrix about
the centroid, which principal components are made of, is algebra:

    G = J D J        J = 1 - 1 1^T / N

An origin among the materials costs no digits: |p_0 - C|^2 is at most the trace of G. (About the origin of space, a
library whose materials differ little would lose those it has.) And it does not move when materials are added: the
products of the old stay, and only those of the new with all are read from the samples.

Where a new material is unmeasured on cells that counted, the old products are of other cells, and nothing of them can be
kept: the matrix is then made anew.
"""

from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
from jaxtyping import Float64, Int

from ..errors import LibraryError
from ..library import Streamed
from ..tasks import HERE, Work
from .sums import join_channels, measured_pieces, sum_blocks

Products = Float64[np.ndarray, "n_channels n_pairs"]
"""Of a symmetric matrix per channel, the lower triangle row by row."""


@dataclass(frozen=True, eq=False)
class Gram:
    """Inner products of the N materials of a library, per channel, about one of them."""

    materials: tuple[str, ...]
    """The checksum of each, in the library's order."""
    origin: int
    """The material that is the origin."""
    products: Products
    """1/sr^2."""
    squared_norms: Float64[np.ndarray, "n_channels N"]
    """|p_i|^2, 1/sr^2."""
    n_cells: Int[np.ndarray, " n_channels"]
    """Cells that count: measured in every material."""

    @classmethod
    def of(cls, library: Streamed, *, work: Work = HERE) -> "Gram":
        """The products of all materials of ``library``, in one pass.

        Raises
        ------
        LibraryError
            When no cell is measured in every material.
        """
        n = len(library)
        total = _sum(library, Pass(np.arange(n), 0), work)
        return cls(library.material_checksums, 0, total.products, total.norms, total.n_cells)

    def extended(self, library: Streamed, *, work: Work = HERE) -> "Gram":
        """The products of all materials of ``library``, which has those of this matrix among others.

        One pass that computes the products of the new materials with all; as exact as `Gram.of`.

        Raises
        ------
        LibraryError
            When ``library`` lacks a material of this matrix, or no cell is measured in every one.
        """
        position = {checksum: i for i, checksum in enumerate(library.material_checksums)}
        if not position.keys() >= set(self.materials):
            raise LibraryError(
                f"{library.name} lacks some of the {len(self.materials)} materials that are to be completed: "
                "expected all of them and more. Fit it by itself."
            )
        known = np.array([position[checksum] for checksum in self.materials])
        new = np.setdiff1d(np.arange(len(library)), known)
        total = _sum(library, Pass(new, int(known[self.origin])), work)
        if (total.n_cells != self.n_cells).any():
            return Gram.of(library, work=work)
        norms = np.empty((library.n_channels, len(library)))
        norms[:, known], norms[:, new] = self.squared_norms, total.norms
        products = [
            pack(_joined(unpack(old, len(known)), rows.reshape(len(new), len(library)), known, new))
            for old, rows in zip(self.products, total.products, strict=True)
        ]
        return Gram(
            library.material_checksums,
            int(known[self.origin]),
            np.stack(products),
            norms,
            self.n_cells,
        )

    def centred(self, channel: int) -> Float64[np.ndarray, "N N"]:
        """The Gram matrix of one channel about the centroid, 1/sr^2."""
        gram = unpack(self.products[channel], len(self.materials))
        mean = gram.mean(axis=0)
        gram -= mean
        gram -= mean[:, None]
        gram += mean.mean()
        return gram


def pack(symmetric: Float64[np.ndarray, "N N"]) -> Float64[np.ndarray, " n_pairs"]:
    """The lower triangle of a symmetric matrix, row by row."""
    return symmetric[np.tri(len(symmetric), dtype=bool)]


def unpack(triangle: Float64[np.ndarray, " n_pairs"], n: int) -> Float64[np.ndarray, "n n"]:
    """The symmetric matrix of a lower triangle."""
    lower = np.tri(n, dtype=bool)
    symmetric = np.empty((n, n))
    symmetric[lower] = triangle
    symmetric.T[lower] = triangle
    return symmetric


class Pass(NamedTuple):
    """Which products a pass computes: of the materials ``rows`` with all, or among themselves where that is all."""

    rows: Int[np.ndarray, " n_rows"]
    origin: int


class _Sum(NamedTuple):
    products: Float64[np.ndarray, "n_channels n_products"]
    norms: Float64[np.ndarray, "n_channels n_rows"]
    n_cells: Int[np.ndarray, " n_channels"]


def _sum(library: Streamed, which: Pass, work: Work) -> _Sum:
    block = partial(gram_block, library, which)
    return sum_blocks(library, block, label="Gram matrices", work=work)


def gram_block(library: Streamed, which: Pass, columns: slice) -> _Sum:
    """The task of a pass: the products on one block."""
    channels = (_channel(samples, which) for samples in library.columns(columns))
    return _Sum(*join_channels(channels, library.n_channels))


def _channel(samples: np.ndarray, which: Pass) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The products of one channel of a block."""
    n, rows = len(samples), which.rows
    whole = len(rows) == n
    products, norms, n_cells = np.zeros((len(rows), n)), np.zeros(len(rows)), 0
    for u in measured_pieces(samples):
        n_cells += u.shape[1]
        own = u if whole else u[rows]
        norms += np.einsum("ij,ij->i", own, own)
        u -= u[which.origin].copy()
        # Of a matrix with its own transpose, numpy has BLAS do half the work.
        products += (u if whole else u[rows]) @ u.T
    return (pack(products) if whole else products.ravel()), norms, np.array(n_cells)


def _joined(
    old: Float64[np.ndarray, "n_old n_old"],
    rows: Float64[np.ndarray, "n_new N"],
    known: Int[np.ndarray, " n_old"],
    new: Int[np.ndarray, " n_new"],
) -> Float64[np.ndarray, "N N"]:
    whole = np.empty((rows.shape[1], rows.shape[1]))
    whole[np.ix_(known, known)] = old
    whole[new] = rows
    whole[:, new] = rows.T
    return whole
