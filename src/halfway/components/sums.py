"""Sums over the cells that are measured in every material of a library, in float64, a block of columns at a time."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TypeVar

import numpy as np
from jaxtyping import Float64

from ..errors import LibraryError
from ..library import Streamed, columns_per_piece, ranges
from ..tasks import Work

S = TypeVar("S", bound=tuple[np.ndarray, ...])
"""Arrays that add up; the last counts the cells of each channel."""


def sum_blocks(library: Streamed, of_block: Callable[[slice], S], *, label: str, work: Work) -> S:
    """What ``of_block`` finds on each block, added up in their order.

    Raises
    ------
    LibraryError
        When no cell is measured in every material.
    """
    blocks = iter(work.run(of_block, library.blocks(), label=label))
    total = next(blocks)
    for block in blocks:
        for whole, part in zip(total, block, strict=True):
            whole += part
    if not total[-1].all():
        raise LibraryError(
            f"{library.name} has no cell that is measured in all of its {len(library)} materials: a PCA needs some. "
            f"{_culprit(library)}. Build a library without it."
        )
    return total


def _culprit(library: Streamed) -> str:
    """The material that stands in the way of the most samples by itself; where none does, the one with the fewest."""
    n_alone, n_measured = np.zeros((2, len(library)), int)
    for block in library.blocks():
        missing = np.isnan(library.columns(block))
        n_alone += (missing & (missing.sum(axis=1, keepdims=True) == 1)).sum(axis=(0, 2))
        n_measured += (~missing).sum(axis=(0, 2))
    i = int(n_alone.argmax() if n_alone.any() else n_measured.argmin())
    n_samples = library.n_channels * library.grid.size
    return (
        f"{library.names[i]} measures {n_measured[i]:,} of {n_samples:,} samples, and {n_alone[i]:,} are measured in all "
        "others"
    )


def measured_pieces(samples: np.ndarray) -> Iterator[Float64[np.ndarray, "N n_measured"]]:
    """One channel of a block, (N, n), without the columns that have a NaN, a piece at a time in memory of its own."""
    n, n_columns = samples.shape
    for piece in ranges(n_columns, columns_per_piece(n)):
        columns = samples[:, piece]
        # One pass: a sum is NaN where any of its terms is.
        measured = ~np.isnan(columns.sum(axis=0))
        if measured.any():
            yield (columns if measured.all() else columns[:, measured]).astype(np.float64)


def join_channels(channels: Iterable[Sequence[np.ndarray]], n_channels: int) -> list[np.ndarray]:
    """What was channels of each channel, stacked, without holding all of it twice."""
    whole: list[np.ndarray] = []
    for channel, parts in enumerate(channels):
        if not whole:
            whole = [np.empty((n_channels, *np.shape(part)), part.dtype) for part in parts]
        for total, part in zip(whole, parts, strict=True):
            total[channel] = part
    return whole
