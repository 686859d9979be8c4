"""How a library is cut into blocks of columns, the tasks of everything that streams it.

A block of n columns is read whole, 3 x N x n float32: wide enough that a run of one material is worth a read, and as narrow
as memory asks. Sums over cells are made in pieces of it, N x w float64 of one channel at a time, that stay in a core's cache;
with many materials that would be a sliver, and a product of matrices wants a thousand columns more than the cache.

    block       n = max(16 MB / 8 N, min(4096, 64 MB / 12 N))
    piece       w = max(1.6 MB / 8 N, min(1000, 16 MB / 8 N))
"""

from .._types import Part

WORK_BYTES = 16e6
"""About how many bytes of float64 one channel of a block holds."""
BLOCK_BYTES = 64e6
"""How many bytes of float32 a block of many materials holds, at most."""
LONG_RUN = 4096
"""Samples of one material that are worth a read."""
CACHE_BYTES = 1.6e6
"""About how many bytes of float64 a core keeps near."""
LONG_PRODUCT = 1000
"""Columns of a piece that are worth a product of matrices."""


def columns_per_block(n_materials: int) -> int:
    """Columns of a block."""
    work = WORK_BYTES / (8 * n_materials)
    return max(1, int(max(work, min(LONG_RUN, BLOCK_BYTES / (12 * n_materials)))))


def columns_per_piece(n_materials: int) -> int:
    """Columns of a piece of a block."""
    most = min(LONG_PRODUCT, WORK_BYTES / (8 * n_materials))
    return max(1, int(max(CACHE_BYTES / (8 * n_materials), most)))


def ranges(stop: int, step: int) -> list[slice]:
    """[0, stop) cut into ranges of ``step``; the last may be shorter."""
    return [slice(start, min(start + step, stop)) for start in range(0, stop, step)]


def grid_parts(shape: tuple[int, ...], n_columns: int) -> list[tuple[slice, Part]]:
    """A grid's cells in ranges of about ``n_columns``, each with the part of the grid that it is.

    Whole rows of the first axis; where one row is too wide, ranges of the second axis within it.
    """
    row = 1
    for size in shape[1:]:
        row *= size
    if row <= n_columns or len(shape) == 1:
        rows = ranges(shape[0], max(1, n_columns // row))
        return [(slice(r.start * row, r.stop * row), r) for r in rows]
    line = row // shape[1]
    within = ranges(shape[1], max(1, n_columns // line))
    return [
        (slice(i * row + r.start * line, i * row + r.stop * line), (slice(i, i + 1), r))
        for i in range(shape[0])
        for r in within
    ]
