"""The task `reconstruct`: a material from k numbers.

A method is a function of the materials that it may learn from, those to reconstruct, and the k that are asked for. It gives pairs of a
k and the tables that it makes of so many numbers each; a method that has its own number of parameters gives one pair.

    def mine(train: Library, test: Library, ks: Sequence[int]) -> Iterable[tuple[int, Values]]: ...

    benchmark(reconstructions=RECONSTRUCTIONS | {"mine": mine})
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial

import numpy as np
from jaxtyping import Float, Float32
from threadpoolctl import threadpool_limits

from ..brdf import Brdf, TabularBrdf, metrics, quadrature
from ..fit import MODELS, fit
from ..library import Library
from ..tasks import Work
from .data import Values, gridded, part, values_of

Reconstruction = Callable[[Library, Library, Sequence[int]], Iterable[tuple[int, Values]]]
Mapped = Float[np.ndarray, "3 N p"]


class Linear:
    """f itself, each cell alike: the paper's analysis."""

    def __init__(self, train: Library) -> None:
        del train

    def to(self, f: Mapped) -> Mapped:
        return f

    def back(self, m: Mapped) -> Mapped:
        return m


class Root:
    """sqrt(f), cells weighed by solid angle and cosines: as `halfway.components.MappedRows` has them for the blend `root`."""

    def __init__(self, train: Library) -> None:
        self._scale = np.sqrt(quadrature.light_weights(train.grid)).astype(np.float32)

    def to(self, f: Mapped) -> Mapped:
        return np.sqrt(f) * self._scale

    def back(self, m: Mapped) -> Mapped:
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.square(np.maximum(m / self._scale, 0))


class LogRelative:
    """ln((f c + e) / (f_ref c + e)), c = max(cos_i cos_o, e), f_ref the median of all (Nielsen et al. 2015, equation 6)."""

    def __init__(self, train: Library) -> None:
        cells = quadrature.comparison_cells(train.grid)
        e = metrics.EPSILON
        self._c = np.maximum(cells.cos_i * cells.cos_o, e).ravel().astype(np.float32)
        values = values_of(train)
        median = np.median(values.reshape(-1, values.shape[-1]), axis=0)
        self._reference = np.log(median * self._c + e)

    def to(self, f: Mapped) -> Mapped:
        return np.log(f * self._c + metrics.EPSILON) - self._reference

    def back(self, m: Mapped) -> Mapped:
        return (np.exp(m + self._reference) - metrics.EPSILON) / self._c


def pca(
    mapping: Callable[[Library], "Linear | Root | LogRelative"],
    train: Library,
    test: Library,
    ks: Sequence[int],
) -> Iterator[tuple[int, Values]]:
    """The first k principal components of all channels together, in a mapping; as many as the materials have."""
    mapped = mapping(train)
    known = train.grid.mask().ravel()
    # A mirror's highlight and the last component are ten orders of magnitude apart.
    x, y = (_flat(mapped.to(values_of(each)), known).astype(np.float64) for each in (train, test))
    mean = x.mean(axis=0)
    x, y = x - mean, y - mean
    with threadpool_limits(1, "blas"):
        eigenvalues, vectors = np.linalg.eigh(x @ x.T)
        order = eigenvalues.argsort()[::-1][: min(max(ks), len(x) - 1)]
        order = order[eigenvalues[order] > 1e-14 * eigenvalues[-1]]
        components = (vectors[:, order] / np.sqrt(eigenvalues[order])).T @ x
        scores = y @ components.T
        for k in ks:
            if k <= len(order):
                near = (mean + scores[:, :k] @ components[:k]).astype(np.float32)
                yield k, mapped.back(_unflat(near, known)).astype(np.float32)


def nearest(train: Library, test: Library, ks: Sequence[int]) -> Iterator[tuple[int, Values]]:
    """The one material that is nearest, in the mapping `Root`: one number says which."""
    del ks
    mapped, known = Root(train), train.grid.mask().ravel()
    values = values_of(train)
    x, y = (_flat(mapped.to(each), known) for each in (values, values_of(test)))
    which = [int(np.square(x - row).sum(axis=1).argmin()) for row in y]
    yield 1, values[:, which]


def convex_mix(train: Library, test: Library, ks: Sequence[int]) -> Iterator[tuple[int, Values]]:
    """The nearest mix in the blend `root`; k is how many materials it takes, in the mean, a weight each."""
    from scipy.optimize import nnls

    del ks
    mapped, known = Root(train), train.grid.mask().ravel()
    x, y = (_flat(mapped.to(values_of(each)), known) for each in (train, test))
    x64 = x.astype(np.float64)
    gram = x64 @ x64.T
    sum_to_one = gram.diagonal().mean() * 1e3
    eigenvalues, vectors = np.linalg.eigh(gram + sum_to_one)
    kept = eigenvalues > 1e-12 * eigenvalues[-1]
    root = np.sqrt(eigenvalues[kept])
    products = (y @ x64.T + sum_to_one) @ vectors[:, kept] / root
    system = root[:, None] * vectors[:, kept].T
    weights = np.stack([nnls(system, row)[0] for row in products])
    weights /= weights.sum(axis=1, keepdims=True)
    n_used = round(float((weights > 1e-4).sum(axis=1).mean()))
    yield n_used, mapped.back(_unflat(weights.astype(np.float32) @ x, known))


def beside(other: Library, n_numbers: int) -> Reconstruction:
    """The materials of the same names in another library, on the grid: published fits."""

    def method(train: Library, test: Library, ks: Sequence[int]) -> Iterator[tuple[int, Values]]:
        del train, ks
        yield n_numbers, values_of(gridded(part(other, test.names), test.grid))

    return method


def fit_each(
    of_table: Callable[[TabularBrdf], Brdf], n_numbers: int, label: str, work: Work
) -> Reconstruction:
    """What is fitted to each material, of which it sees all."""

    def method(train: Library, test: Library, ks: Sequence[int]) -> Iterator[tuple[int, Values]]:
        del train, ks

        def one(name: str) -> Float32[np.ndarray, "3 p"]:
            return of_table(test.brdf(name)).sample_rows(test.grid, slice(None)).reshape(3, -1)

        rows = list(work.run(one, test.names, label=f"Fits of {label}"))
        yield n_numbers, np.stack(rows, axis=1)

    return method


def fitted(model: str, work: Work) -> Reconstruction:
    """An analytic model of `halfway.fit`, fitted to each material."""
    n_numbers = len(MODELS[model].neutral())
    return fit_each(lambda table: fit(table, model).model, n_numbers, model, work)


RECONSTRUCTIONS: Mapping[str, Reconstruction] = {
    "PCA, linear": partial(pca, Linear),
    "PCA, square root": partial(pca, Root),
    "PCA, log-relative": partial(pca, LogRelative),
    "nearest material": nearest,
    "nearest mix": convex_mix,
}
"""What learns from the training materials."""


def _flat(values: Mapped, known: np.ndarray) -> Float32[np.ndarray, "N n"]:
    """A row for each material: its channels one after another."""
    kept = values[..., known].swapaxes(0, 1)
    return np.ascontiguousarray(kept, np.float32).reshape(values.shape[1], -1)


def _unflat(rows: Float32[np.ndarray, "N n"], known: np.ndarray) -> Values:
    values = np.full((3, len(rows), len(known)), np.nan, np.float32)
    values[..., known] = rows.reshape(len(rows), 3, -1).swapaxes(0, 1)
    return values
