"""Leading principal components without the N x N matrix, for libraries in which it no longer fits.

The Gram matrix G = U U^T of a channel (U: N materials x p cells, centred) acts on l test vectors, one block of columns at a
time,

    Y = G W = sum over blocks  U_b (U_b^T W)        N x l

which takes 4 N p l operations and 8 N l bytes, where G takes N^2 p and 8 N^2. From Y and W alone,

    G ~ Y (W^T Y)^+ Y^T

the Nyström approximation, whose leading eigenvalues are never above the true ones. W is random at first; each further pass
over the library takes an orthonormal basis of the last Y for W, which multiplies the error in eigenvalue k by about
(lambda_l / lambda_k)^2.

References: N. Halko, P. Martinsson, J. Tropp, "Finding Structure with Randomness", SIAM Review 53(2), 2011, sections 4.5
and 5.5; J. Tropp, A. Yurtsever, M. Udell, V. Cevher, "Fixed-Rank Approximation of a Positive-Semidefinite Matrix from
Streaming Data", NeurIPS 2017.
"""

from functools import partial
from typing import NamedTuple

import numpy as np
from jaxtyping import Float64, Int
from threadpoolctl import threadpool_limits

from ..library import Streamed
from ..tasks import HERE, Work
from .sums import join_channels, measured_pieces, sum_blocks

N_PASSES = 2
OVERSAMPLING = 32
"""Test vectors more than components asked for."""


class Sketch(NamedTuple):
    """Leading eigenpairs of the Gram matrices about the centroid, and the exact norms."""

    eigenvalues: Float64[np.ndarray, "n_channels K"]
    eigenvectors: Float64[np.ndarray, "n_channels N K"]
    squared_norms: Float64[np.ndarray, "n_channels N"]
    """|p_i|^2, 1/sr^2."""
    centred_norms: Float64[np.ndarray, "n_channels N"]
    """|u_i|^2, 1/sr^2."""
    n_cells: Int[np.ndarray, " n_channels"]


def sketch(
    library: Streamed, n_components: int, *, n_passes: int = N_PASSES, work: Work = HERE
) -> Sketch:
    """The first ``n_components`` eigenpairs of each channel, in ``n_passes`` over the library; raises as `Gram.of` does."""
    n = len(library)
    n_vectors = min(n_components + OVERSAMPLING, n)
    tests = np.random.default_rng(0).standard_normal((library.n_channels, n, n_vectors))
    for i in range(1, n_passes):
        label = f"Components, pass {i} of {n_passes}"
        tests = _sum(library, _orthonormal(tests), label, work).images
    tests = _orthonormal(tests)
    label = f"Components, pass {n_passes} of {n_passes}"
    total = _sum(library, tests, label, work)
    pairs = [_nystrom(w, y) for w, y in zip(tests, total.images, strict=True)]
    values, vectors = (np.stack(part) for part in zip(*pairs, strict=True))
    k = n_components
    return Sketch(values[:, :k], vectors[:, :, :k], total.norms, total.centred, total.n_cells)


def _orthonormal(
    vectors: Float64[np.ndarray, "n_channels N n_vectors"],
) -> Float64[np.ndarray, "n_channels N n_vectors"]:
    with threadpool_limits(1, "blas"):
        return np.linalg.qr(vectors)[0]


class _Sum(NamedTuple):
    images: Float64[np.ndarray, "n_channels N n_vectors"]
    norms: Float64[np.ndarray, "n_channels N"]
    centred: Float64[np.ndarray, "n_channels N"]
    n_cells: Int[np.ndarray, " n_channels"]


def _sum(library: Streamed, tests: np.ndarray, label: str, work: Work) -> _Sum:
    block = partial(sketch_block, library, tests)
    return sum_blocks(library, block, label=label, work=work)


def sketch_block(library: Streamed, tests: np.ndarray, columns: slice) -> _Sum:
    """The task of a pass: the images of the test vectors on one block."""
    block = zip(library.columns(columns), tests, strict=True)
    channels = (_channel(samples, vectors) for samples, vectors in block)
    return _Sum(*join_channels(channels, len(tests)))


def _channel(
    samples: np.ndarray, tests: Float64[np.ndarray, "N n_vectors"]
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    n = len(samples)
    images, norms, centred, n_cells = np.zeros_like(tests), np.zeros(n), np.zeros(n), 0
    for u in measured_pieces(samples):
        n_cells += u.shape[1]
        norms += np.einsum("ij,ij->i", u, u)
        u -= u.mean(axis=0)
        centred += np.einsum("ij,ij->i", u, u)
        images += u @ (u.T @ tests)
    return images, norms, centred, np.array(n_cells)


def _nystrom(
    w: Float64[np.ndarray, "N n_vectors"], y: Float64[np.ndarray, "N n_vectors"]
) -> tuple[Float64[np.ndarray, " n_vectors"], Float64[np.ndarray, "N n_vectors"]]:
    """Eigenvalues, descending, and eigenvectors of ``y (w^T y)^+ y^T``; 0 past its rank."""
    with threadpool_limits(1, "blas"):
        core = w.T @ y
        values, turn = np.linalg.eigh((core + core.T) / 2)
        # What is within rounding of 0 has no inverse.
        roots = np.where(values > len(core) * np.finfo(float).eps * values[-1], values, np.inf)
        vectors, singular, _ = np.linalg.svd(y @ (turn / np.sqrt(roots)), full_matrices=False)
    return singular**2, vectors
