"""Principal components of a library, one analysis per colour channel.

With N materials p_i of p cells each (only cells measured in every material count):

    C   = sum_i p_i / N              centroid      (eq. 1)
    u_i = p_i - C                    translation   (eq. 2)
    R   = sum_i u_i u_i^T            covariance    (eq. 3), p x p

R is never formed. Its eigenvalues are those of the N x N Gram matrix ``G_ij = u_i . u_j``, and with ``G = V L V^T``
the score of material i on component j is ``V_ij sqrt(L_j)``. G is a sum over cells, so it streams: one block of
columns at a time, in float64, from float32 storage.

A reconstruction from k components is a combination of the materials themselves,

    p_i,k = C + sum_j (V V^T)_ij u_j     with the first k columns of V

so components, p numbers each, are never formed either.

Reference: M. da Silva Nunes, G. F. Miranda Jr., B. Trinchão Andrade, "Using Dimensionality Reduction to Create New
Materials from Tabular BRDFs", section III.
"""

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Float64

from .._types import Table
from ..brdf import TabularBrdf
from ..errors import LibraryError
from ..tasks import Track, run, silent
from .cache import cached
from .library import Library


@dataclass(frozen=True, eq=False)
class Pca:
    """Principal components of a library, per channel; N components, of which at most N - 1 carry variance."""

    names: tuple[str, ...]
    """The materials, in the library's order."""
    eigenvalues: Float64[np.ndarray, "3 N"]
    """Of the covariance of eq. 3 (a sum, not a mean), descending, non-negative, 1/sr^2."""
    eigenvectors: Float64[np.ndarray, "3 N N"]
    """Of the Gram matrix; column j belongs to eigenvalue j, its largest entry positive."""
    squared_norms: Float64[np.ndarray, "3 N"]
    """|p_i|^2 over the cells that count, 1/sr^2."""
    n_cells: tuple[int, int, int]
    """Cells that count: measured in every material."""

    @classmethod
    def fit(cls, library: Library, *, cache: Path | None = None, track: Track = silent) -> "Pca":
        """The components of ``library``; with a ``cache`` folder, kept there under the library's checksum."""
        if len(library) < 2:
            raise LibraryError(
                f"{library.name} has {len(library)} material: a PCA takes at least 2."
            )
        key = f"gram-1-{library.checksum}"
        gram = cached(cache, key, lambda: _gram(library, track)._asdict())
        return cls._of_gram(library.names, **gram)

    @classmethod
    def _of_gram(
        cls,
        names: tuple[str, ...],
        centred: Float64[np.ndarray, "3 N N"],
        squared_norms: Float64[np.ndarray, "3 N"],
        n_cells: np.ndarray,
    ) -> "Pca":
        eigenvalues, eigenvectors = _eigen(centred)
        r, g, b = map(int, n_cells)
        return cls(names, eigenvalues, eigenvectors, squared_norms, (r, g, b))

    def scores(self, n_components: int) -> Float64[np.ndarray, "3 N k"]:
        """Coordinates of the materials on the first components, 1/sr; their mean is 0."""
        k = n_components
        return self.eigenvectors[:, :, :k] * np.sqrt(self.eigenvalues[:, None, :k])

    def joint_scores(self, n_components: int) -> Float64[np.ndarray, "N k"]:
        """Coordinates on the first components of all channels together, 1/sr: one analysis of the tables as a whole."""
        v = self.eigenvectors
        gram = np.einsum("cij,cj,ckj->ik", v, self.eigenvalues, v)
        eigenvalues, vectors = _eigen(gram)
        return vectors[:, :n_components] * np.sqrt(eigenvalues[:n_components])

    def squared_residuals(self, n_components: int) -> Float64[np.ndarray, "3 N"]:
        """|u_i - u_i,k|^2 of the k-component reconstructions."""
        tail = self.eigenvectors[:, :, n_components:] ** 2
        return np.einsum("cij,cj->ci", tail, self.eigenvalues[:, n_components:])

    def reconstruct(self, library: Library, name: str, n_components: int) -> TabularBrdf:
        """The k-component reconstruction of one material: the truncated PCA, which may be negative.

        Never a new material: that is `halfway.mix`. NaN where any material is unmeasured.
        """
        v = self.eigenvectors[:, :, :n_components]
        i = library.index(name)
        projection = np.einsum("ck,cjk->cj", v[:, i], v)
        # The weights are over p_j = C + u_j, and C counts once.
        weights = 1 / len(self.names) + projection - projection.mean(axis=1, keepdims=True)
        combine = partial(_combine, library, weights)
        values: Table = np.concatenate(list(run(combine, library.blocks())), axis=1)
        label = f"{name}, {n_components} components"
        return TabularBrdf(values.reshape(3, *library.grid.shape), library.grid, name=label)


def _eigen(
    gram: Float64[np.ndarray, "*c N N"],
) -> tuple[Float64[np.ndarray, "*c N"], Float64[np.ndarray, "*c N N"]]:
    """Eigenvalues, descending and non-negative, and eigenvectors whose largest entry is positive."""
    eigenvalues, eigenvectors = np.linalg.eigh(gram)
    eigenvectors = eigenvectors[..., ::-1]
    largest = np.abs(eigenvectors).argmax(axis=-2, keepdims=True)
    signs = np.sign(np.take_along_axis(eigenvectors, largest, axis=-2))
    return np.maximum(eigenvalues[..., ::-1], 0.0), eigenvectors * signs


class _Gram(NamedTuple):
    centred: Float64[np.ndarray, "3 N N"]
    squared_norms: Float64[np.ndarray, "3 N"]
    n_cells: np.ndarray


def _gram(library: Library, track: Track) -> _Gram:
    n = len(library)
    total = _Gram(np.zeros((3, n, n)), np.zeros((3, n)), np.zeros(3, np.int64))
    blocks = run(
        partial(_gram_block, library), library.blocks(), label="Gram matrices", track=track
    )
    for block in blocks:
        for whole, part in zip(total, block, strict=True):
            whole += part
    if not total.n_cells.all():
        raise LibraryError(
            f"{library.name} has no cell that is measured in all of its {n} materials: a PCA needs some. "
            "Build a library of materials that were measured on the same cells."
        )
    return total


def _gram_block(library: Library, columns: slice) -> _Gram:
    block = library.columns(columns)
    gram = _Gram(
        np.empty((3, len(library), len(library))),
        np.empty((3, len(library))),
        np.empty(3, np.int64),
    )
    for c, samples in enumerate(block):
        measured = ~np.isnan(samples).any(axis=0)
        u = samples.astype(np.float64)
        u[:, ~measured] = 0.0
        gram.squared_norms[c] = np.einsum("ij,ij->i", u, u)
        u -= u.mean(axis=0)
        gram.centred[c] = u @ u.T
        gram.n_cells[c] = measured.sum()
    return gram


def _combine(library: Library, weights: Float64[np.ndarray, "3 N"], columns: slice) -> np.ndarray:
    block = library.columns(columns)
    return np.stack([w @ samples for w, samples in zip(weights, block, strict=True)]).astype(
        np.float32
    )
