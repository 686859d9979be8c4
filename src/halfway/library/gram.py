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
from ..tasks import THREADS, Engine, Track, run, silent
from .blocks import columns_per_piece, ranges
from .library import Library

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
    def of(cls, library: Library, *, track: Track = silent, engine: Engine = THREADS) -> "Gram":
        """The products of all materials of ``library``, in one pass.

        Raises
        ------
        LibraryError
            When no cell is measured in every material.
        """
        n = len(library)
        total = _sum(library, Part(np.arange(n), 0), track, engine)
        return cls(library.material_checksums, 0, total.products, total.norms, total.n_cells)

    def extended(
        self, library: Library, *, track: Track = silent, engine: Engine = THREADS
    ) -> "Gram":
        """The products of all materials of ``library``, which has those of this matrix among others.

        One pass that computes the products of the new materials with all; as exact as `Gram.of`.

        Raises
        ------
        LibraryError
            When ``library`` lacks a material of this matrix, or no cell is measured in every one.
        """
        place = {checksum: i for i, checksum in enumerate(library.material_checksums)}
        if not place.keys() >= set(self.materials):
            raise LibraryError(
                f"{library.name} lacks some of the {len(self.materials)} materials that are to be completed: "
                "expected all of them and more. Fit it by itself."
            )
        known = np.array([place[checksum] for checksum in self.materials])
        new = np.setdiff1d(np.arange(len(library)), known)
        total = _sum(library, Part(new, int(known[self.origin])), track, engine)
        if (total.n_cells != self.n_cells).any():
            return Gram.of(library, track=track, engine=engine)
        norms = np.empty((library.n_channels, len(library)))
        norms[:, known], norms[:, new] = self.squared_norms, total.norms
        products = [
            pack(_joined(unpack(old, len(known)), rows.reshape(len(new), -1), known, new))
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


class Part(NamedTuple):
    """Which products a pass computes: of the materials ``rows`` with all, or among themselves where that is all."""

    rows: Int[np.ndarray, " n_rows"]
    origin: int


class _Sum(NamedTuple):
    products: Float64[np.ndarray, "n_channels n_products"]
    norms: Float64[np.ndarray, "n_channels n_rows"]
    n_cells: Int[np.ndarray, " n_channels"]


def _sum(library: Library, part: Part, track: Track, engine: Engine) -> _Sum:
    # Scipy has a BLAS of its own: the limit of one thread a task binds those that are loaded when the tasks begin.
    import scipy.linalg.blas  # noqa: F401  # pyright: ignore[reportUnusedImport]

    n, total = len(library), _zeros(library, part)
    blocks = run(
        partial(gram_block, library, part),
        library.blocks(),
        label="Gram matrices",
        track=track,
        engine=engine,
    )
    for block in blocks:
        for whole, piece in zip(total, block, strict=True):
            whole += piece
    if not total.n_cells.all():
        raise LibraryError(
            f"{library.name} has no cell that is measured in all of its {n} materials: a PCA needs some. "
            "Build a library of materials that were measured on the same cells."
        )
    return total


def _zeros(library: Library, part: Part) -> _Sum:
    c, n, n_rows = library.n_channels, len(library), len(part.rows)
    n_products = n * (n + 1) // 2 if n_rows == n else n * n_rows
    return _Sum(np.zeros((c, n_products)), np.zeros((c, n_rows)), np.zeros(c, np.int64))


def gram_block(library: Library, part: Part, columns: slice) -> _Sum:
    """The task of a pass: the products on one block."""
    total = _zeros(library, part)
    for channel, samples in enumerate(library.columns(columns)):
        total.products[channel], total.norms[channel], total.n_cells[channel] = _channel(
            samples, part
        )
    return total


def _channel(samples: np.ndarray, part: Part) -> tuple[np.ndarray, np.ndarray, int]:
    """The products of one channel of a block, a piece of it at a time that stays in a core's cache."""
    n, n_columns = samples.shape
    whole = len(part.rows) == n
    products = np.zeros((n, n) if whole else (len(part.rows), n), order="F")
    norms, n_cells = np.zeros(len(part.rows)), 0
    for piece in ranges(n_columns, columns_per_piece(n)):
        u = measured_everywhere(samples[:, piece])
        if not u.size:
            continue
        n_cells += u.shape[1]
        rows = u if whole else u[part.rows]
        norms += np.einsum("ij,ij->i", rows, rows)
        u -= u[part.origin].copy()
        products = _add_products(products, u, None if whole else part.rows)
    return (pack(products) if whole else products.ravel()), norms, n_cells


def measured_everywhere(samples: np.ndarray) -> Float64[np.ndarray, "N n_measured"]:
    """The columns of ``samples`` without a NaN, in float64."""
    # One pass: a sum is NaN where any of its terms is.
    measured = ~np.isnan(samples.sum(axis=0))
    return (samples if measured.all() else samples[:, measured]).astype(np.float64)


def _add_products(
    total: np.ndarray, u: Float64[np.ndarray, "N n"], rows: Int[np.ndarray, " n_rows"] | None
) -> np.ndarray:
    """``total + u[rows] u^T`` in place; where ``rows`` are all, half the work and the lower triangle alone."""
    if rows is not None:
        total += u[rows] @ u.T
        return total
    from scipy.linalg import blas  # a second to load

    syrk = blas.dsyrk  # pyright: ignore[reportAttributeAccessIssue] (made at run time)
    return syrk(1.0, u.T, beta=1.0, c=total, trans=1, lower=1, overwrite_c=1)


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
