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

import numpy as np
from jaxtyping import Float64
from threadpoolctl import threadpool_limits

from .._types import Table
from ..brdf import TabularBrdf
from ..errors import LibraryError
from ..library import Library, Streamed
from ..tasks import HERE, Work
from .gram import Gram
from .gram_cache import kept_gram
from .sketch import N_PASSES, sketch

N_KEPT = 256
"""Components of a library of more materials that are kept, unless more are asked for."""
MOST_EXACT = 2500
"""Materials up to which the Gram matrices are formed: 25 MB of products each a task, and 75 MB in the cache."""


@dataclass(frozen=True, eq=False)
class Pca:
    """Principal components of a library, per channel; K of them, of which at most N - 1 carry variance."""

    names: tuple[str, ...]
    """The materials, in the library's order."""
    eigenvalues: Float64[np.ndarray, "n_channels K"]
    """Of the covariance of eq. 3 (a sum, not a mean), descending, non-negative, 1/sr^2."""
    eigenvectors: Float64[np.ndarray, "n_channels N K"]
    """Of the Gram matrix; column j belongs to eigenvalue j, its largest entry positive."""
    squared_norms: Float64[np.ndarray, "n_channels N"]
    """|p_i|^2 over the cells that count, 1/sr^2."""
    rest: Float64[np.ndarray, "n_channels N"]
    """|u_i|^2 that all K components leave, 1/sr^2."""
    n_cells: tuple[int, ...]
    """Cells that count: measured in every material."""

    @classmethod
    def fit(cls, library: Streamed, *, n_components: int | None = None, work: Work = HERE) -> "Pca":
        """The components of ``library``: all, or the leading ``n_components`` (`N_KEPT` of a library of more materials).

        Exact up to `MOST_EXACT` materials, and by `halfway.components.sketch` beyond. With a cache folder, what was read of
        the samples is kept there; a library that grew is then only completed by its new materials.

        Raises
        ------
        LibraryError
            With fewer than 2 materials, or none of the cells measured in all of them.
        """
        n = len(library)
        if n < 2:
            raise LibraryError(f"{library.name} has {n} material: a PCA takes at least 2.")
        k = min(n_components or N_KEPT, n)

        def compute() -> dict[str, np.ndarray]:
            if n > MOST_EXACT:
                return sketch(library, k, work=work)._asdict()
            return _components(kept_gram(library, work=work), k)

        method = "exact" if n <= MOST_EXACT else f"sketch-{N_PASSES}"
        arrays = work.cached(f"components-1-{method}-{k}-{library.checksum}", compute)
        return cls._of(library.names, **arrays)

    @classmethod
    def _of(
        cls,
        names: tuple[str, ...],
        eigenvalues: Float64[np.ndarray, "n_channels K"],
        eigenvectors: Float64[np.ndarray, "n_channels N K"],
        squared_norms: Float64[np.ndarray, "n_channels N"],
        centred_norms: Float64[np.ndarray, "n_channels N"],
        n_cells: np.ndarray,
    ) -> "Pca":
        eigenvectors = _signed(eigenvectors)
        kept = np.einsum("cij,cj->ci", eigenvectors**2, eigenvalues)
        is_all = eigenvalues.shape[1] == len(names)
        rest = np.zeros_like(kept) if is_all else np.maximum(centred_norms - kept, 0)
        cells = tuple(map(int, n_cells))
        return cls(names, eigenvalues, eigenvectors, squared_norms, rest, cells)

    def scores(self, n_components: int) -> Float64[np.ndarray, "n_channels N k"]:
        """Coordinates of the materials on the first components, 1/sr; their mean is 0."""
        k = n_components
        return self.eigenvectors[:, :, :k] * np.sqrt(self.eigenvalues[:, None, :k])

    def joint_scores(self, n_components: int) -> Float64[np.ndarray, "N k"]:
        """Coordinates on the first components of all channels together, 1/sr: one analysis of the tables as a whole.

        As many as there are: at most N, and those of all channels.
        """
        scores = np.concatenate(list(self.scores(self.eigenvalues.shape[1])), axis=1)
        with threadpool_limits(1, "blas"):
            if scores.shape[1] < len(scores):
                # The smaller of the two products; a score on a component is what the scores have along it.
                _, directions = _eigen(scores.T @ scores, min(n_components, scores.shape[1]))
                joint = scores @ directions
            else:
                eigenvalues, vectors = _eigen(scores @ scores.T, min(n_components, len(scores)))
                joint = vectors * np.sqrt(eigenvalues)
        return _signed(joint)

    def squared_residuals(self, n_components: int) -> Float64[np.ndarray, "n_channels N"]:
        """|u_i - u_i,k|^2 of the k-component reconstructions, k at most K."""
        tail = self.eigenvectors[:, :, n_components:] ** 2
        return np.einsum("cij,cj->ci", tail, self.eigenvalues[:, n_components:]) + self.rest

    def reconstruct(self, library: Library, name: str, n_components: int) -> TabularBrdf:
        """The k-component reconstruction of one material: the truncated PCA, which may be negative.

        Never a new material: that is `halfway.mix`. NaN where any material is unmeasured.

        Raises
        ------
        LibraryError
            When there are not as many components.
        """
        n_known = self.eigenvectors.shape[2]
        if not 0 <= n_components <= n_known:
            raise LibraryError(
                f"{n_components} components cannot be taken of {n_known}: expected 0 to {n_known}."
            )
        v = self.eigenvectors[:, :, :n_components]
        i = library.index(name)
        projection = np.einsum("ck,cjk->cj", v[:, i], v)
        # The weights are over p_j = C + u_j, and C counts once.
        weights = 1 / len(self.names) + projection - projection.mean(axis=1, keepdims=True)
        combine = partial(_combine, library, weights)
        values: Table = np.concatenate(list(HERE.run(combine, library.blocks())), axis=1)
        label = f"{name}, {n_components} components"
        return TabularBrdf(values.reshape(3, *library.grid.shape), library.grid, name=label)


def _components(gram: Gram, k: int) -> dict[str, np.ndarray]:
    """The leading k eigenpairs of Gram matrices, and the norms."""
    channels = range(len(gram.products))
    centred_norms = np.empty_like(gram.squared_norms)
    eigenvalues = np.empty((len(channels), k))
    eigenvectors = np.empty((len(channels), len(gram.materials), k))
    for channel in channels:
        centred = gram.centred(channel)
        centred_norms[channel] = centred.diagonal()
        eigenvalues[channel], eigenvectors[channel] = _eigen(centred, k)
    return {
        "eigenvalues": eigenvalues,
        "eigenvectors": eigenvectors,
        "squared_norms": gram.squared_norms,
        "centred_norms": centred_norms,
        "n_cells": gram.n_cells,
    }


def _eigen(
    gram: Float64[np.ndarray, "N N"], k: int
) -> tuple[Float64[np.ndarray, " k"], Float64[np.ndarray, "N k"]]:
    """The k largest eigenvalues, descending and non-negative, and their eigenvectors."""
    n = len(gram)
    if k == n:
        decompose = np.linalg.eigh
    else:
        from scipy.linalg import eigh  # a second to load

        # It refuses to find none.
        decompose = partial(eigh, subset_by_index=(n - max(k, 1), n - 1), check_finite=False)
    # More than one thread of BLAS waits for itself on a busy machine: ten times the time, and more. The limit binds those
    # that are loaded, and scipy has one of its own.
    with threadpool_limits(1, "blas"):
        eigenvalues, vectors = decompose(gram)
    return np.maximum(eigenvalues[::-1][:k], 0.0), vectors[:, ::-1][:, :k]


def _signed(vectors: Float64[np.ndarray, "*c N k"]) -> Float64[np.ndarray, "*c N k"]:
    """Each column with the sign that makes its largest entry positive."""
    largest = np.abs(vectors).argmax(axis=-2, keepdims=True)
    return vectors * np.sign(np.take_along_axis(vectors, largest, axis=-2))


def _combine(
    library: Library, weights: Float64[np.ndarray, "n_channels N"], columns: slice
) -> np.ndarray:
    block = library.columns(columns)
    return np.stack([w @ samples for w, samples in zip(weights, block, strict=True)]).astype(
        np.float32
    )
