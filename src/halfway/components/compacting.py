"""Making a compact library: components of the coded rows, cut to a precision, and what that loses.

Two passes over the library, and one over the result: the Gram matrix of the coded rows gives eigenvectors V and eigenvalues L;
the components ``V^T u / sqrt(L)`` are combinations of the rows, made block by block, and never all at once in more than
their stored precision. A component is cut to a precision in runs of `RUN` measured cells, each with a step of its own,
because highlights and the rest differ by orders of magnitude.
"""

import hashlib
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np
from jaxtyping import Float32, Float64

from ..brdf import metrics, quadrature
from ..errors import LibraryError
from ..library import Coding, CompactLibrary, Library, Precision, Streamed, compact_file, ranges
from ..locations import Location, absolute
from ..tasks import HERE, Work
from .pca import Pca

RUN = 1024
"""Measured cells that share a step."""
N_COMPONENTS = 36


def compact_library(
    library: Library,
    path: Location,
    *,
    n_components: int = N_COMPONENTS,
    coding: Coding = Coding(),  # noqa: B008 (frozen)
    work: Work = HERE,
) -> CompactLibrary:
    """Write the compact library of ``library`` at ``path``, and measure it; its components are kept in the cache.

    Raises
    ------
    LibraryError
        With fewer than one component, or no fewer than there are rows; or no cell measured in every material; or where
        ``path`` is not called NAME.brdfc, or is that of the library itself.
    OutputError
        When ``path`` cannot be written.
    """
    if path.suffix != compact_file.SUFFIX:
        raise LibraryError(
            f"{path} is no name of a compact library: expected NAME{compact_file.SUFFIX}, by which it is opened. Name it so."
        )
    if library.address == str(absolute(path)):
        raise LibraryError(
            f"{path} is the library itself, which is read until the last: expected another file. Choose another name."
        )
    rows = CodedRows(library, coding)
    if not 1 <= n_components < len(rows):
        advice = f"Choose -k 1 to {len(rows) - 1}." if len(rows) > 1 else "Take the library itself."
        raise LibraryError(
            f"{library.name} cannot be kept in {n_components} components: it has {len(rows)} rows, and fewer are "
            f"expected, at least 1. {advice}"
        )
    pca = Pca.fit(rows, n_components=n_components, work=work)
    arrays = _arrays(rows, pca, work)
    origin = replace(library.origin, description=_description(library, n_components))
    header = compact_file.Header(
        library.grid, library.names, origin, coding, n_components, library.checksum
    )
    header = replace(header, checksum=compact_file.checksum(header, arrays))
    compact_file.write(path, header, arrays)
    error = measured_error(library, CompactLibrary(path), work=work)
    compact_file.write(path, replace(header, error=error), arrays)
    return CompactLibrary(path)


class CodedRows(Streamed):
    """The coded rows of a library: what a compact library takes the components of."""

    def __init__(self, library: Library, coding: Coding) -> None:
        self.library, self.coding = library, coding
        self.name, self.grid = library.name, library.grid
        per_material = 3 // coding.n_bases
        self.names = tuple(f"{name} {i}" for i in range(per_material) for name in library.names)
        self.n_channels = coding.n_bases
        what = library.checksum, coding.mapping, coding.shared
        self.checksum = hashlib.sha256(repr(what).encode()).hexdigest()
        # Which cells count depends on all materials: nothing of them is kept for another library.
        self.material_checksums = tuple(f"{self.checksum} {name}" for name in self.names)

    def columns(self, columns: slice) -> Float32[np.ndarray, "n_bases n_rows n"]:
        samples = self.library.columns(columns)
        # A cell counts in all channels or in none.
        samples[:, :, np.isnan(samples.sum(axis=(0, 1)))] = np.nan
        return self.coding.to_coded(samples, self.grid, columns)

    def blocks(self) -> list[slice]:
        return self.library.blocks()


class _Cut(NamedTuple):
    cells: np.ndarray  # (n,) bool
    lengths: np.ndarray  # of the runs
    mean: Float32[np.ndarray, "n_bases m"]
    steps: Float32[np.ndarray, "n_bases k n_runs"]
    components: np.ndarray  # (n_bases, k, m)


def _arrays(rows: CodedRows, pca: Pca, work: Work) -> compact_file.Arrays:
    # A component within rounding of nothing is nothing.
    least = len(rows) * np.finfo(float).eps * pca.eigenvalues[:, :1]
    roots = np.sqrt(np.where(pca.eigenvalues > least, pca.eigenvalues, np.inf))
    project = np.swapaxes(pca.eigenvectors / roots[:, None], 1, 2)
    cut = partial(_cut, rows, project, rows.coding.precision)
    parts = list(work.run(cut, rows.blocks(), label="Components"))
    lengths = np.concatenate([part.lengths for part in parts])
    return compact_file.Arrays(
        np.packbits(np.concatenate([part.cells for part in parts])),
        np.append(0, np.cumsum(lengths)).astype(np.uint64),
        np.concatenate([part.mean for part in parts], axis=-1),
        np.concatenate([part.steps for part in parts], axis=-1),
        np.concatenate([part.components for part in parts], axis=-1),
        pca.scores(pca.eigenvalues.shape[1]).astype(np.float32),
    )


def _cut(
    rows: CodedRows, project: Float64[np.ndarray, "n_bases k R"], precision: Precision, block: slice
) -> _Cut:
    coded = rows.columns(block)
    cells = ~np.isnan(coded[0, 0])
    coded = coded[:, :, cells].astype(np.float64)
    mean = coded.mean(axis=1, keepdims=True)
    components = project @ (coded - mean)
    runs = ranges(components.shape[-1], RUN)
    pieces = [_stored(components[..., r], precision) for r in runs]
    steps = [step for step, _ in pieces]
    empty = components[..., :0]
    return _Cut(
        cells,
        np.array([r.stop - r.start for r in runs], np.int64),
        mean[:, 0].astype(np.float32),
        np.stack(steps, axis=-1) if steps else empty.astype(np.float32),
        np.concatenate([stored for _, stored in pieces] or [empty.astype(precision)], axis=-1),
    )


def _stored(
    components: Float64[np.ndarray, "n_bases k n"], precision: Precision
) -> tuple[Float32[np.ndarray, "n_bases k"], np.ndarray]:
    """The step of each component on a run, and the component in steps: at most 127 of them, or 1."""
    largest = np.abs(components).max(axis=-1)
    step = (largest / (127 if precision == "int8" else 1)).astype(np.float32)
    # The smallest step that is a number: a component that is 0 stays 0.
    step = np.maximum(step, np.finfo(np.float32).tiny)
    in_steps = components / step[..., None]
    if precision == "int8":
        in_steps = np.clip(np.round(in_steps), -127, 127)
    return step, in_steps.astype(precision)


def measured_error(library: Library, compact: Library, *, work: Work = HERE) -> dict[str, float]:
    """What a library loses in ``compact``, over the cells that it keeps.

    ``mean_relative_error`` is Table I's, the mean over materials and channels of |p_i - q_i| / |p_i - C|; ``log_relative``
    the metric of this name (`halfway.brdf.metrics`) below grazing angles, by solid angle.
    """
    compare = partial(_compared, library, compact)
    total = _Compared(np.zeros((3, len(library))), np.zeros((3, len(library))), np.zeros(2))
    for part in work.run(compare, library.blocks(), label="Errors"):
        for whole, piece in zip(total, part, strict=True):
            whole += piece
    relative = np.sqrt(total.squared / np.where(total.centred > 0, total.centred, 1.0))
    return {
        "mean_relative_error": float(relative.mean()),
        "log_relative": float(np.sqrt(total.log[0] / total.log[1])),
    }


class _Compared(NamedTuple):
    squared: Float64[np.ndarray, "3 N"]
    centred: Float64[np.ndarray, "3 N"]
    log: Float64[np.ndarray, " 2"]  # weighted sum of squares, and of weights


def _compared(library: Library, compact: Library, block: slice) -> _Compared:
    p, q = library.columns(block), compact.columns(block)
    kept = ~np.isnan(q[0, 0])
    p, q = p[..., kept].astype(np.float64), q[..., kept].astype(np.float64)
    centred = p - p.mean(axis=1, keepdims=True)
    solid_angle, cos_i, cos_o, grazing = (
        part.ravel()[block][kept] for part in quadrature.comparison_cells(library.grid)
    )
    weights = np.where(grazing, 0.0, solid_angle)
    relative = metrics.MAPPINGS["log-relative"]
    apart = relative(p, cos_i, cos_o) - relative(q, cos_i, cos_o)
    log = np.array([(apart**2 @ weights).sum(), 3 * p.shape[1] * weights.sum()])
    return _Compared(((p - q) ** 2).sum(axis=-1), (centred**2).sum(axis=-1), log)


def _description(library: Library, n_components: int) -> str:
    what = library.origin.description or library.name
    return f"{what}; reconstructed from {n_components} principal components"
