"""Components: against scikit-learn, numpy, and reading the bytes once; how they grow with N and p; what a task costs.

100 materials on the MERL grid, stored on disk: 1.75 GB in the folder of temporary files. What takes minutes there is measured on
half as many angles of each kind (an eighth of the cells), both sides alike.
"""

import json
import os
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from racing import race, ratio
from sklearn.decomposition import PCA

from halfway import Grid, Pca, build_library
from halfway.library import ProceduralLibrary
from halfway.library.blocks import columns_per_piece
from halfway.tasks import HERE

FIT = """
import json, sys, time
from pathlib import Path
from halfway.components import Pca
from halfway.library import StoredLibrary
library = StoredLibrary(Path(sys.argv[1]))
def peak():  # not getrusage's, which a process inherits
    lines = Path("/proc/self/status").read_text().splitlines()
    return int(next(line for line in lines if line.startswith("VmHWM")).split()[1]) / 1024
before, start = peak(), time.perf_counter()
Pca.fit(library)
print(json.dumps({"seconds": time.perf_counter() - start, "megabytes": peak() - before}))
"""


@pytest.fixture(scope="module")
def channel(library):
    """One channel in float64, as scikit-learn wants it."""
    blocks = [library.columns(block)[0].astype(np.float64) for block in library.blocks()]
    return np.nan_to_num(np.concatenate(blocks, axis=1))


def bench_components(figures, library, channel):
    """Ours in a process of its own, for its memory, three channels; theirs one channel, times three."""
    command = [sys.executable, "-c", FIT, str(library.path)]
    fits = [json.loads(subprocess.check_output(command)) for _ in range(3)]
    ours = float(np.median([fit["seconds"] for fit in fits]))
    note = f"{ours:.2f} s, {max(fit['megabytes'] for fit in fits):.0f} MB above the interpreter"
    start = time.perf_counter()
    PCA(45, svd_solver="randomized", random_state=0).fit(channel)
    theirs = 3 * (time.perf_counter() - start)
    what = "components of 100 materials"
    figures.note(what, "scikit-learn randomized / ours", theirs / ours, goal=">= 10", note=note)

    def stream():
        for _ in HERE.run(library.columns, library.blocks()):
            pass

    def products():
        piece = np.ones((len(library), columns_per_piece(len(library))))
        n_pieces = 3 * library.grid.size // piece.shape[1]
        for _ in HERE.run(lambda _: piece @ piece.T, range(n_pieces)):
            pass

    seconds = race(lambda: Pca.fit(library), stream, products, rounds=5)
    figures.note(what, "ours / reading the bytes once, from memory", ratio(seconds, 0, 1))
    figures.note(what, "ours / the products alone, by BLAS", ratio(seconds, 0, 2))

    def from_disk(f):
        forget(library.tables)
        start = time.perf_counter()
        f()
        return time.perf_counter() - start

    rounds = [from_disk(lambda: Pca.fit(library)) / from_disk(stream) for _ in range(5)]
    compared = "ours / reading the bytes once, from disk"
    figures.note(what, compared, float(np.median(rounds)), goal="<= 2")


def forget(path):
    """Have the system drop its pages of a file, so that the disk is what is read."""
    with path.open("rb") as file:
        os.fsync(file.fileno())
        os.posix_fadvise(file.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)


def bench_components_exactly(figures, channel):
    """The exact decompositions, on every eighth cell."""
    x = np.ascontiguousarray(channel[:, ::8])
    rows = {f"m{i:03}": row for i, row in enumerate(x)}
    grid = Grid.merl(45, 45, 90)
    library = tabular(rows, grid, x.shape[1])
    u = x - x.mean(axis=0)
    seconds = race(
        lambda: Pca.fit(library),
        lambda: PCA(svd_solver="full").fit(x),
        lambda: np.linalg.svd(u, full_matrices=False),
        rounds=1,
    )
    what = "components of 100 materials, 182,250 cells"
    # Ours has three channels, theirs one.
    figures.note(what, "scikit-learn full / ours", 3 * ratio(seconds, 1, 0))
    figures.note(what, "numpy SVD / ours", 3 * ratio(seconds, 2, 0))


def bench_growth(figures):
    """Exponents in the number of materials N and of cells p: of seconds ~ N^a p^b, by least squares on logarithms."""
    rng = np.random.default_rng(0)
    sizes = [(50, 36), (100, 36), (200, 36), (400, 36), (200, 24), (200, 48), (200, 60)]
    rows, seconds = [], []
    for n, side in sizes:
        grid = Grid.merl(side, side, 2 * side)
        samples = rng.random((n, grid.size), np.float32)
        library = tabular({f"m{i}": row for i, row in enumerate(samples)}, grid, grid.size)
        rows.append([np.log(n), np.log(grid.size), 1.0])
        seconds.append(np.log(race(lambda library=library: Pca.fit(library), rounds=3).min()))
    a, b, _ = np.linalg.lstsq(np.array(rows), np.array(seconds), rcond=None)[0]
    figures.note(
        "growth of components, N = 50 to 400", "exponent in N", a, note="2 is the product's"
    )
    figures.note(
        "growth of components, p = 28 to 432 thousand",
        "exponent in p",
        b,
        note="1 is the product's",
    )


def tabular(rows, grid, size):
    """A library held in memory, the same samples in each channel."""
    from halfway import TabularBrdf

    values = {
        name: np.broadcast_to(row.astype(np.float32)[:size], (3, size)).reshape(3, *grid.shape)
        for name, row in rows.items()
    }
    tables = {
        name: TabularBrdf(np.ascontiguousarray(v), grid, name=name) for name, v in values.items()
    }
    return ProceduralLibrary("bench", tables, grid=grid)


def bench_tasks(figures):
    n = 20_000

    def plain():
        with ThreadPoolExecutor(2) as pool:
            list(pool.map(abs, range(n)))

    seconds = race(lambda: list(HERE.run(abs, range(n))), plain, rounds=5)
    each = 1e6 * float(np.median(seconds[:, 0])) / n
    figures.note(
        "20,000 empty tasks on threads",
        "ours / Executor.map",
        ratio(seconds, 0, 1),
        note=f"{each:.0f} us a task",
    )


def bench_build(figures, library, tmp_path):
    """Ingest: a library of MERL files against copying the same bytes."""
    from halfway.formats import write_merl

    for name in library.names[:12]:
        write_merl(tmp_path / "files" / f"{name}.binary", library.brdf(name))
    files = sorted((tmp_path / "files").iterdir())

    def copy():
        with (tmp_path / "copy").open("wb") as out:
            for path in files:
                out.write(path.read_bytes()[: path.stat().st_size // 2])

    seconds = race(lambda: build_library(files, tmp_path / "some.brdflib"), copy, rounds=3)
    figures.note(
        "library of 12 MERL files",
        "ours / reading them, writing half the bytes",
        ratio(seconds, 0, 1),
        note="checksums of files and tables",
    )
