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


def sum_blocks(
    library: Streamed,
    of_block: Callable[[slice], S],
    *,
    label: str,
    work: Work,
) -> S:
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
            "Build a library of materials that were measured on the same cells."
        )
    return total


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
