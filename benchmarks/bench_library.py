"""Libraries, components, routes and mixes against what a user would otherwise use, each pair in one run.

100 materials on the MERL grid, stored on disk: 1.75 GB in the folder of temporary files.
"""

import json
import subprocess
import sys
import time

import numpy as np
import pytest
from sklearn.decomposition import PCA

from halfway import PaperSpace, Pca, Recipe, Route, build_library
from halfway.library import StoredLibrary
from halfway.space import Mixer

FIT = """
import json, sys, time
from pathlib import Path
from halfway.library import Pca, StoredLibrary
library = StoredLibrary(Path(sys.argv[1]))
def peak():  # not getrusage's, which a process inherits
    lines = Path("/proc/self/status").read_text().splitlines()
    return int(next(line for line in lines if line.startswith("VmHWM")).split()[1]) / 1024
before, start = peak(), time.perf_counter()
Pca.fit(library)
print(json.dumps({"seconds": time.perf_counter() - start, "megabytes": peak() - before}))
"""


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return build_library(
        ["builtin:merl-abc"], tmp_path_factory.mktemp("bench") / "merl.brdflib"
    ).library


@pytest.fixture(scope="module")
def route(library):
    space = PaperSpace.fit(library, Pca.fit(library))
    return Route.through(space, ["cherry-235", "tungsten-carbide"])


@pytest.mark.benchmark(group="components of 100 materials, three channels")
def bench_components(benchmark, library: StoredLibrary):
    """Ours in a process of its own, for its memory; scikit-learn's randomized solver on one channel, times three."""
    fits: list[dict[str, float]] = []

    def fit():
        command = [sys.executable, "-c", FIT, str(library.path)]
        fits.append(json.loads(subprocess.run(command, check=True, capture_output=True).stdout))

    benchmark.pedantic(fit, rounds=3)
    seconds = float(np.median([found["seconds"] for found in fits]))
    tables = np.load(library.tables, mmap_mode="r")
    start = time.perf_counter()
    channel = np.nan_to_num(np.array(tables[0], np.float64))
    PCA(45, svd_solver="randomized", random_state=0).fit(channel)
    theirs = 3 * (time.perf_counter() - start)
    start = time.perf_counter()
    for block in library.blocks():
        library.columns(block)
    stream = time.perf_counter() - start
    benchmark.extra_info |= {
        "seconds": round(seconds, 2),
        "megabytes above the interpreter": round(max(found["megabytes"] for found in fits)),
        "scikit-learn randomized / ours": round(theirs / seconds, 1),
        "ours / reading the bytes": round(seconds / stream, 2),
    }
    print(f"\n{benchmark.extra_info}")


@pytest.mark.benchmark(group="10,000 recipes of a route")
def bench_recipes(benchmark, route: Route):
    ts = np.arange(1, 10_001) / 10_000
    benchmark.pedantic(lambda: json.dumps(route.to_json(ts)), rounds=3)


@pytest.mark.benchmark(group="mix of 4 materials")
def bench_mix(benchmark, library: StoredLibrary):
    """Ours; numpy's weighted sum of the same rows; and copying one table's bytes, as ratios."""
    names = library.names[:4]
    recipe = Recipe.of(library.name, dict(zip(names, (0.1, 0.2, 0.3, 0.4), strict=True)))
    mixer = Mixer(library)
    mixer.mix(recipe)
    benchmark.pedantic(lambda: mixer.mix(recipe), rounds=10)
    rows = [library.row(i) for i in range(4)]
    weights = recipe.weights[0]

    def naive():
        return sum(w * row.astype(np.float64) for w, row in zip(weights, rows, strict=True))

    ours = benchmark.stats.stats.median
    benchmark.extra_info |= {
        "numpy / ours": round(_median(naive) / ours, 2),
        "ours / copying a table": round(ours / _median(rows[0].copy), 1),
    }
    print(f"\n{benchmark.extra_info}")


def _median(f) -> float:
    times = []
    for _ in range(5):
        start = time.perf_counter()
        f()
        times.append(time.perf_counter() - start)
    return float(np.median(times))
