"""MERL tables: the files of the MERL BRDF database.

    3 x int32     n_theta_h, n_theta_d, n_phi_d                          90, 90, 180 in the database
    float64       [channel][theta_h][theta_d][phi_d]                     red, green, blue

little endian; 34,992,012 bytes in the database. A sample is stored divided by its channel's scale,

    f_r = sample x (1, 1.15, 1.66) / 1500   in 1/sr,

and a negative one is unmeasured: NaN in our tables, -1 in the files that we write. Any grid is read, so that tests and
experiments may use small ones. Of the header the database's reader looks at the product alone, and other programs write
its sizes in other orders, or phi_d over the whole turn: a table has the grid whose horizon its unmeasured cells draw (see
`halfway.brdf.layout`), and a `MerlFile` keeps what the header states.

Source: W. Matusik, H. Pfister, M. Brand, L. McMillan, "A Data-Driven Reflectance Model", SIGGRAPH 2003, and the
reader that comes with the database.
"""

import warnings
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from io import BufferedIOBase
from itertools import cycle
from pathlib import Path

import numpy as np

from .._types import Samples, Table
from ..brdf import TabularBrdf, layout_of
from ..errors import FormatError, OutputError
from ..files import replacing
from ..halfdiff import MERL, Grid
from .content import (
    HEAD_BYTES,
    LARGEST_AXIS,
    MERL_HEADER,
    MERL_SAMPLES,
    description,
    merl_bytes,
    merl_like,
)
from .sources import FileSource, Source

SCALES = np.array([1.0, 1.15, 1.66]) / 1500
"""1/sr of a sample of 1, per channel."""
UNMEASURED = -1.0
"""The sample that we write where nothing was measured."""

_BLOCK = 1 << 16  # samples decoded at once: half a megabyte stays in a cache
_BLOCK_WRITTEN = 1 << 18  # samples encoded at once: two megabytes are worth handing to a thread
_LARGEST_LOOK = 1 << 28  # bytes
_CHUNK = 1 << 24  # bytes read at once: a zip's stream makes a copy of each


@dataclass(frozen=True, eq=False)
class MerlFile:
    """What a MERL file holds, exactly: reading and writing it again gives the same bytes.

    Parameters
    ----------
    grid : Grid
        The grid that the header states.
    samples : float64 array, shape (3, *grid.shape)
        As in the file: unscaled, negative where unmeasured. Finite.
    """

    grid: Grid
    samples: Samples

    @classmethod
    def read(cls, path: str | Path) -> "MerlFile":
        """The contents of the file.

        Raises
        ------
        FormatError
            When it is no MERL file, is truncated or too long, or holds a NaN or an infinite sample.
        """
        return cls.read_source(FileSource(Path(path)))

    @classmethod
    def read_source(cls, source: Source) -> "MerlFile":
        """The contents of a file or of a member of a zip; raises as `read` does."""
        grid = read_grid(source)  # the size is right: memory may be taken
        samples = np.empty((3, *grid.shape), "<f8")
        with source.open() as stream:
            stream.read(MERL_HEADER.size)
            _fill(samples.data.cast("B"), stream, source.label)
        _require_finite(samples, source.label)
        return cls(grid, samples)

    @classmethod
    def from_table(cls, table: TabularBrdf) -> "MerlFile":
        """The table as a MERL file holds it.

        Raises
        ------
        OutputError
            When a MERL file cannot hold it: a negative or infinite value, or another kind of grid.
        """
        require_merl_shaped(table.grid, table.name)
        _require_storable(table)
        samples = np.empty(table.values.shape, np.float64)
        for values, scale, encoded in zip(table.values, SCALES, samples, strict=True):
            _encode(values, scale, encoded)
        return cls(table.grid, samples)

    def to_table(self, name: str = "") -> TabularBrdf:
        """The samples in 1/sr, NaN where unmeasured, on the grid that they draw."""
        values = np.empty(self.samples.shape, np.float32)
        for channel, scale in enumerate(SCALES):
            with np.errstate(over="ignore"):
                np.multiply(self.samples[channel], scale, out=values[channel], casting="same_kind")
        if np.isinf(values.max()):
            raise FormatError(
                f"{name or 'the table'} has a sample of {self.samples.max():.3g}: a table holds float32, "
                "up to 3.4e38. It is probably damaged; compare it with the original download."
            )
        values[self.samples < 0] = np.nan
        return _table(values, self.grid, name)

    def write(self, path: str | Path) -> None:
        """Write the file; whole or not at all.

        Raises
        ------
        OutputError
            When the file cannot be written.
        """
        header = encode_header(self.grid)
        body = np.ascontiguousarray(self.samples, "<f8")
        with replacing(Path(path)) as temporary, temporary.open("wb") as file:
            file.write(header)
            file.write(body.data.cast("B"))


def read_merl(path: str | Path) -> TabularBrdf:
    """The table in a MERL file, named after the file; raises as `MerlFile.read` does."""
    return read_merl_source(FileSource(Path(path)))


def read_merl_source(source: Source) -> TabularBrdf:
    """The table in a MERL file or in a member of a zip; raises as `MerlFile.read` does."""
    table = _decoded(source)
    if table is None:  # read whole, to say what is wrong with it
        return MerlFile.read_source(source).to_table(source.name)
    return table


def _decoded(source: Source) -> TabularBrdf | None:
    """The table, decoded in blocks that stay in a cache; None where a sample is none or too large, or the file is short."""
    grid = read_grid(source)
    values = np.empty((3, grid.size), np.float32)
    block = np.empty(_BLOCK, "<f8")
    with source.open() as stream, np.errstate(over="ignore"):
        stream.read(MERL_HEADER.size)
        for channel, scale in zip(values, SCALES, strict=True):
            for start in range(0, grid.size, _BLOCK):
                decoded = channel[start : start + _BLOCK]
                samples = block[: len(decoded)]
                if stream.readinto(samples.data.cast("B")) < samples.nbytes:
                    return None
                np.multiply(samples, scale, out=decoded, casting="same_kind")
                if not np.isfinite(decoded).all():
                    return None
                decoded[samples < 0] = np.nan
    return _table(values.reshape(3, *grid.shape), grid, source.name)


def _table(values: Table, stated: Grid, name: str) -> TabularBrdf:
    """The table of samples that lie in a file whose header states this grid."""
    layout = layout_of(values, stated)
    if stated.size == MERL.size and layout.grid != MERL and not np.isnan(values).any():
        warnings.warn(
            f"{name or 'the table'} states {stated}, as many cells as the database's {MERL}, and none is unmeasured, which "
            f"would tell their order: taken as stated. If it is the database's, write {MERL} into its header.",
            stacklevel=2,
        )
    return TabularBrdf(layout.of(values), layout.grid, name=name)


def write_merl(path: str | Path, table: TabularBrdf) -> None:
    """Write a table as a MERL file; raises as `MerlFile.from_table` and `MerlFile.write` do."""
    require_merl_shaped(table.grid, table.name)
    header = encode_header(table.grid)
    with (
        replacing(Path(path)) as temporary,
        temporary.open("wb") as file,
        ThreadPoolExecutor(1) as writer,
    ):
        writing = writer.submit(file.write, header)
        # One block is written while the next is encoded.
        for block in _encoded_blocks(table):
            writing.result()
            writing = writer.submit(file.write, block.data)
        writing.result()


def _encoded_blocks(table: TabularBrdf) -> Iterator[np.ndarray]:
    """The samples of a file in order, each block overwritten by the next but one; raises as `_require_storable`."""
    buffers = cycle(np.empty((2, _BLOCK_WRITTEN), "<f8"))
    for channel, scale in zip(table.values.reshape(3, -1), SCALES, strict=True):
        for start in range(0, len(channel), _BLOCK_WRITTEN):
            values = channel[start : start + _BLOCK_WRITTEN]
            # A block that is in the cache is looked at for next to nothing; what is wrong is said of the whole table.
            if not _is_storable(values):
                _require_storable(table)
            samples = next(buffers)[: len(values)]
            _encode(values, scale, samples)
            yield samples


def _encode(values: np.ndarray, scale: float, samples: np.ndarray) -> None:
    """Values of one channel as samples of a file. None is negative, so the maximum with -1 changes the NaN alone."""
    np.divide(values, scale, out=samples, dtype=np.float64)
    np.fmax(samples, UNMEASURED, out=samples)


def encode_header(grid: Grid) -> bytes:
    """The 12 bytes before the samples."""
    require_merl_shaped(grid)
    return MERL_HEADER.pack(*grid.shape)


def require_merl_shaped(grid: Grid, name: str = "") -> None:
    """Refuse a grid that a MERL file's header cannot state.

    Raises
    ------
    OutputError
        When the grid is not over theta_h, theta_d and phi_d, spaced as in the database.
    """
    if len(grid.axes) != 3 or grid != Grid.merl(*grid.shape):
        axes = ", ".join(axis.angle for axis in grid.axes)
        raise OutputError(
            f"{name or 'the table'} has a grid of {grid} cells over {axes}: a MERL file holds theta_h (square-root "
            "spaced), theta_d and phi_d. Sample it on such a grid first: `halfway convert IN OUT.binary --grid 90x90x180`."
        )


def read_grid(source: Source) -> Grid:
    """The grid that the header states; raises where the file cannot hold a table on it."""
    head, n_bytes, label = source.head(HEAD_BYTES), source.n_bytes, source.label
    what = description(head)
    if what is not None:
        raise FormatError(
            f"{label} {what}: expected a MERL table, 12 bytes of sizes and then samples."
        )
    if len(head) < MERL_HEADER.size:
        raise FormatError(
            f"{label} is {n_bytes} bytes long: a MERL table begins with three sizes, 12 bytes. "
            "It is truncated, or no MERL table."
        )
    samples = merl_like(head, n_bytes)
    if samples not in (None, MERL_SAMPLES):
        raise FormatError(
            f"{label} is a MERL table of {samples}: expected {MERL_SAMPLES}, as in the database. "
            "Convert it with the program that wrote it."
        )
    sizes = MERL_HEADER.unpack_from(head)
    _require_plausible(sizes, n_bytes, label)
    return Grid.merl(*sizes)


def table_grid(source: Source) -> Grid:
    """The grid of the table; where the header states another than the database's, a look at its samples decides. Raises as `read_grid` does."""
    stated = read_grid(source)
    looked_at = stated != MERL and source.n_bytes <= _LARGEST_LOOK
    return read_merl_source(source).grid if looked_at else stated


def _require_plausible(sizes: tuple[int, ...], n_bytes: int, label: str) -> None:
    stated = " x ".join(map(str, sizes))
    if min(sizes) <= 0:
        sign = "a negative" if min(sizes) < 0 else "a zero"
        raise FormatError(
            f"{label} states {sign} size, {stated}: expected three positive sizes, 90 x 90 x 180 in the database. "
            "It is damaged, or no MERL table."
        )
    expected = merl_bytes(sizes)
    if n_bytes == expected:
        return
    if max(sizes) > LARGEST_AXIS:
        raise FormatError(
            f"{label} states an absurd size, {stated}: that takes {expected:,} bytes, this file has {n_bytes:,}. "
            "It is no MERL table, or not in little-endian order."
        )
    difference = (
        f"{abs(n_bytes - expected):,} bytes {'shorter' if n_bytes < expected else 'longer'}"
    )
    guess = "truncated" if n_bytes < expected else "damaged, or holds something else as well"
    raise FormatError(
        f"{label} is {difference} than its header says: a {stated} RGB table takes {expected:,} bytes, "
        f"this file has {n_bytes:,}. It is probably {guess}; compare it with the original download."
    )


def _fill(buffer: memoryview, stream: BufferedIOBase, label: str) -> None:
    for start in range(0, len(buffer), _CHUNK):
        part = buffer[start : start + _CHUNK]
        n_bytes = stream.readinto(part)
        if n_bytes < len(part):
            raise FormatError(
                f"{label} ended after {start + n_bytes:,} of {len(buffer):,} bytes of samples: it changed while it "
                "was read. Try again."
            )


def _require_finite(samples: Samples, label: str) -> None:
    finite = np.isfinite(samples)
    if finite.all():
        return
    n_wrong = finite.size - int(finite.sum())
    channel, *cell = (int(i) for i in np.unravel_index(np.argmin(finite), finite.shape))
    what = "a NaN" if np.isnan(samples[channel, *cell]) else "an infinite"
    raise FormatError(
        f"{label} has {what} sample ({n_wrong:,} of {finite.size:,} are not finite; the first is channel "
        f"{'RGB'[channel]}, cell {cell}): expected finite samples, negative where unmeasured. "
        "It is damaged; compare it with the original download."
    )


def _is_storable(values: np.ndarray) -> bool:
    # Faster than looking at each: of what is not NaN, the smallest and the largest. Where all is NaN, they are too.
    least, most = np.fmin.reduce(values, axis=None), np.fmax.reduce(values, axis=None)
    return not (least < 0 or most == np.inf)


def _require_storable(table: TabularBrdf) -> None:
    values = table.values
    if _is_storable(values):
        return
    for what, wrong in (("negative", values < 0), ("infinite", np.isinf(values))):
        if wrong.any():
            raise OutputError(
                f"{table.name or 'the table'} has {int(wrong.sum()):,} {what} values: a MERL file holds finite ones, "
                "and negative means unmeasured there. Clip them first, or mix instead of reconstructing."
            )
