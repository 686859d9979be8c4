"""What the principal components of a library will take: blocks, memory, time.

    peak = total + threads x (block + pieces + result + 2 N^2 products of one channel) + waiting results

where a result is what one task returns, 12 N (N + 1) bytes of a Gram matrix or 24 N l of a sketch with l test vectors. It
counts the arrays; the interpreter and its libraries take some 150 MB beside them.
"""

import os
import time
from dataclasses import dataclass, replace

import numpy as np
from threadpoolctl import threadpool_limits

from ..library import Library, columns_per_piece
from .gram import Pass, gram_block
from .pca import MOST_EXACT, N_KEPT
from .sketch import N_PASSES, OVERSAMPLING, sketch_block

N_WAITING = 2
"""Results beside those being made, that wait for their turn."""


@dataclass(frozen=True)
class PcaPlan:
    """How `Pca.fit` goes about a library."""

    n_vectors: int | None
    """Test vectors of a sketch; None where the Gram matrices are exact."""
    n_materials: int
    n_cells: int
    n_passes: int
    n_blocks: int
    n_columns: int
    """Of the widest block."""
    block_bytes: int
    """Samples of one block, float32."""
    peak_bytes: int
    """Arrays held at once, at most."""
    read_bytes: int
    """Samples that are read or computed, all passes together."""
    seconds: float | None = None
    """From the time that one block took, on all cores; None where it was not measured."""

    @classmethod
    def of(
        cls, library: Library, *, n_components: int | None = None, n_threads: int | None = None
    ) -> "PcaPlan":
        """The plan for ``library`` on ``n_threads`` threads, one per core by default."""
        n = len(library)
        n_threads = n_threads or os.cpu_count() or 1
        blocks = library.blocks()
        n_columns = max(block.stop - block.start for block in blocks)
        n_vectors = None if n <= MOST_EXACT else min((n_components or N_KEPT) + OVERSAMPLING, n)
        result = 12 * n * (n + 1) if n_vectors is None else 24 * n * n_vectors
        block_bytes = 12 * n * n_columns
        task = block_bytes + 2 * 8 * n * min(n_columns, columns_per_piece(n)) + result
        # A piece's products, and their sum.
        task += 16 * n**2 if n_vectors is None else 0
        # Beside the sum, a sketch holds its test vectors and their orthonormal copy.
        held = result if n_vectors is None else 3 * result
        n_passes = 1 if n_vectors is None else N_PASSES
        return cls(
            n_vectors,
            n,
            library.grid.size,
            n_passes,
            len(blocks),
            n_columns,
            block_bytes,
            int(held + min(n_threads, len(blocks)) * task + N_WAITING * result),
            12 * n * library.grid.size * n_passes,
        )

    def timed(self, library: Library) -> "PcaPlan":
        """The plan with the time it takes, as far as the middle block tells."""
        blocks = library.blocks()
        block = blocks[len(blocks) // 2]
        start = time.perf_counter()
        with threadpool_limits(1, "blas"):
            if self.n_vectors is None:
                gram_block(library, Pass(np.arange(len(library)), 0), block)
            else:
                sketch_block(library, np.ones((3, len(library), self.n_vectors)), block)
        seconds = time.perf_counter() - start
        share = (block.stop - block.start) / library.grid.size
        n_threads = min(os.cpu_count() or 1, len(blocks))
        return replace(self, seconds=seconds / share * self.n_passes / n_threads)

    def lines(self) -> list[str]:
        """The plan for people."""
        gb = 1e9
        exact = self.n_vectors is None
        method = (
            "exact, one pass" if exact else f"{self.n_vectors} test vectors, {self.n_passes} passes"
        )
        blocks = f"{self.n_blocks:,} block{'s' * (self.n_blocks > 1)} of {self.n_columns:,} columns, {self.block_bytes / 1e6:.1f} MB each"
        shown = [
            f"{self.n_materials:,} materials x {self.n_cells:,} cells: {method}",
            f"{blocks}; {self.read_bytes / gb:.3g} GB of samples in all",
            f"memory at most {self.peak_bytes / gb:.2f} GB beside the interpreter",
        ]
        if self.seconds is not None:
            shown.append(f"about {_duration(self.seconds)}, judged by one block")
        return shown


def _duration(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.1f} s"
    if seconds < 5400:
        return f"{seconds / 60:.0f} minutes"
    return f"{seconds / 3600:.1f} hours"
