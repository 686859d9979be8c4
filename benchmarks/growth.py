"""How time and memory grow with the number of materials N and of cells p: run by hand, ``python benchmarks/growth.py``.

Each measurement is a process of its own, for its peak memory (VmHWM); exponents are the slope of log time over log N or log p
by least squares. ``--full 2000`` takes the components of that many materials on the whole MERL grid instead, as `Pca.fit` does by
default: minutes; 10,000 take half an hour.
"""

import argparse
import json
import subprocess
import sys

import numpy as np

MEASURE = """
import json, sys, tempfile, time
from pathlib import Path
from halfway.halfdiff import Grid
from halfway.components import Pca, PcaPlan
from halfway.library import ProceduralLibrary
from halfway.components.gram import Gram
from halfway.components.gram_cache import kept_gram
from halfway.components.sketch import sketch
from halfway.models import synthetic
from halfway.space import PaperSpace, Route
from halfway.space.walk import DelaunayWalk
from halfway.tasks import Work
def peak():
    lines = Path("/proc/self/status").read_text().splitlines()
    return int(next(line for line in lines if line.startswith("VmHWM")).split()[1]) / 1024
what, n, *shape = sys.argv[1], *map(int, sys.argv[2:])
grid = Grid.merl(*shape)
library = ProceduralLibrary("synthetic", synthetic(n), grid=grid)
found = {"planned": PcaPlan.of(library).peak_bytes / 1e6}
base, cpu, start = peak(), time.process_time(), time.perf_counter()
if what == "components":
    Pca.fit(library)
if what == "gram":
    Gram.of(library)
if what == "sketch":
    sketch(library, 64)
if what == "eigen":
    with tempfile.TemporaryDirectory() as cache:
        kept_gram(library, work=Work(cache=Path(cache)))
        cpu, start = time.process_time(), time.perf_counter()
        Pca.fit(library, work=Work(cache=Path(cache)))
if what in ("route 3", "route 6"):
    k = int(what[-1])
    pca = Pca.fit(library, n_components=16)
    cpu, start = time.process_time(), time.perf_counter()
    walks = [DelaunayWalk.of(scores) for scores in pca.scores(k)]
    found["fit"] = time.process_time() - cpu
    cpu = time.process_time()
    for i in range(3):
        for walk in walks:
            found["knots"] = len(walk.way(i, n // 2 + i).knots)
if what == "samples":
    for block in library.blocks():
        library.columns(block)
found |= {"seconds": time.perf_counter() - start, "cpu": time.process_time() - cpu, "megabytes": peak()}
print(json.dumps(found))
"""
SMALL = (16, 12, 16)
NS = {
    "samples": (250, 500, 1000, 2000),
    "gram": (250, 500, 1000, 2000),
    "eigen": (500, 1000, 2000),
    "sketch": (1000, 2000, 4000, 8000),
    "route 3": (1000, 3000, 10000),
    "route 6": (1000, 3000, 10000),
}
PS = [(8, 12, 16), (16, 12, 16), (32, 12, 16), (64, 12, 16)]


def main() -> None:
    """Print a table per measurement, and the exponents."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--full", type=int, help="materials on the whole MERL grid")
    full = parser.parse_args().full
    if full:
        print(json.dumps(measure("components", full, (90, 90, 180))))
        return
    print("| what | N | p | CPU (s) | peak (MB) |\n|---|---|---|---|---|")
    exponents = [
        f"{what}: CPU grows as N^{growth(what, [(n, SMALL) for n in ns], by_n=True):.2f}"
        for what, ns in NS.items()
    ]
    exponents += [
        f"{what}: CPU grows as p^{growth(what, [(500, shape) for shape in PS], by_n=False):.2f}"
        for what in ("samples", "gram", "sketch")
    ]
    print("\n".join(["", *exponents]))


def growth(what: str, cases: list[tuple[int, tuple[int, ...]]], *, by_n: bool) -> float:
    """The exponent over the cases, which are printed."""
    sizes, times = [], []
    for n, shape in cases:
        found = measure(what, n, shape)
        p = int(np.prod(shape))
        print(
            f"| {what} | {n:,} | {p:,} | {found['cpu']:.2f} | {found['megabytes']:.0f} |",
            flush=True,
        )
        sizes.append(n if by_n else p)
        times.append(found["cpu"])
    return float(np.polyfit(np.log(sizes), np.log(times), 1)[0])


def measure(what: str, n: int, shape: tuple[int, ...]) -> dict[str, float]:
    """One measurement in a process of its own."""
    command = [sys.executable, "-c", MEASURE, what, str(n), *map(str, shape)]
    return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)


if __name__ == "__main__":
    main()
