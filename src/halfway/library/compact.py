"""Compact libraries: principal components in one file (`halfway.library.compact_file`), reconstructed when asked for.

What is read is a reconstruction, not the measurement. It is never negative, but nothing else of a measured material is
promised of it, and a mix of a compact library is a mix of reconstructions.
"""

from dataclasses import asdict
from functools import cached_property
from typing import Any

import numpy as np

from .._types import Rows, Table
from ..locations import Location
from ..tasks import HERE, Work
from .blocks import columns_per_block, ranges
from .compact_file import Arrays, read_arrays, read_header
from .library import FileLibrary, Verdict, material_checksum

CELLS_AT_ONCE = 32768
"""Of one row: its components in float32 stay small."""


class CompactLibrary(FileLibrary):
    """A library opened from a compact file.

    Raises
    ------
    LibraryError
        When the file is no compact library, one of a newer format, or damaged.
    """

    def __init__(self, path: Location) -> None:
        self.path = path
        self.header = header = read_header(path)
        self.name = str(path)
        self.names, self.grid, self.origin = header.names, header.grid, header.origin
        self.checksum = header.checksum
        self.material_checksums = tuple(
            material_checksum(name, self.grid, f"{self.checksum} {i}".encode())
            for i, name in enumerate(self.names)
        )

    @property
    def n_bytes(self) -> int:
        """Size of the file."""
        return self.path.stat().st_size

    def facts(self) -> dict[str, Any]:
        compact = {
            "n_components": self.header.n_components,
            **asdict(self.header.coding),
            "n_bytes": self.n_bytes,
            "table_bytes": 12 * len(self) * self.grid.size,
            "error": self.header.error,
        }
        return super().facts() | {"compact": compact}

    def storage(self) -> list[str]:
        header, coding, error = self.header, self.header.coding, self.header.error
        table_bytes = 12 * len(self) * self.grid.size
        times = table_bytes / self.n_bytes
        shared = "shared by the channels" if coding.shared else "for each channel"
        loss = "not measured, as its making was stopped: make it again"
        if error:
            loss = f"{error['mean_relative_error']:.4f} relative (Table I's), {error['log_relative']:.4f} log-relative"
        return [
            f"compact: {header.n_components} {coding.mapping} components {shared}, {coding.precision}",
            f"size: {self.n_bytes / 1e6:.1f} MB, {times:.1f} times less than tables of {table_bytes / 1e6:.1f} MB",
            f"error: {loss}",
        ]

    def verify(self, *, work: Work = HERE) -> Verdict:  # noqa: ARG002
        """Whether its numbers have the one checksum that it has; it is right as a whole.

        Raises
        ------
        LibraryError
            When it is damaged.
        """
        read_arrays(self.path, self.header)
        return Verdict(len(self))

    def row(self, i: int) -> Table:
        rows = np.array([i]) if not self.header.coding.shared else i + len(self) * np.arange(3)
        parts = [self._read(rows, part) for part in ranges(self.grid.size, CELLS_AT_ONCE)]
        return np.concatenate(parts, axis=-1)[:, 0]

    def columns(self, columns: slice) -> Rows:
        return self._read(np.arange(self._arrays.scores.shape[1]), columns)

    def blocks(self) -> list[slice]:
        return ranges(self.grid.size, columns_per_block(len(self)))

    def _read(self, rows: np.ndarray, columns: slice) -> Rows:
        arrays = self._arrays
        cells = np.flatnonzero(self._mask[columns])
        first = int(self._n_before[columns.start])
        measured = slice(first, first + len(cells))
        run = np.searchsorted(arrays.starts, np.arange(measured.start, measured.stop), "right") - 1
        basis = arrays.components[:, :, measured].astype(np.float32) * arrays.steps[:, :, run]
        coded = arrays.scores[:, rows] @ basis + arrays.mean[:, None, measured]
        values = self.header.coding.to_samples(coded, self.grid, columns.start + cells)
        samples = np.full((3, values.shape[1], columns.stop - columns.start), np.nan, np.float32)
        samples[..., cells] = values
        return samples

    @cached_property
    def _arrays(self) -> Arrays:
        return read_arrays(self.path, self.header)

    @cached_property
    def _mask(self) -> np.ndarray:
        return np.unpackbits(self._arrays.cells, count=self.grid.size).astype(bool)

    @cached_property
    def _n_before(self) -> np.ndarray:
        """Measured cells before each cell."""
        return np.append(0, np.cumsum(self._mask))
