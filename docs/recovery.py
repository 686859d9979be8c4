"""What docs/recovery.md says of recovering, measured on a library of MERL's materials, some of which are left out as the test.

python docs/recovery.py merl_nbrdf.zip --test names.txt [--grid 90x30x36] [--draws 20] [--splits 12]
"""

import argparse
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from halfway.brdf import quadrature
from halfway.cli.arguments import parse_grid
from halfway.halfdiff import HalfDiff, from_half_diff
from halfway.library import Library, ProceduralLibrary, Subset, open_library
from halfway.measurements import Measurements
from halfway.recipes import mix
from halfway.recovery import Probes, Recovery, Setup, plan
from halfway.recovery.library_samples import spread_pairs, values_at
from halfway.recovery.log_relative import cosines_at, mapped, unmapped
from halfway.recovery.setup import as_batches, as_rows, spread

NUMBERS = (1, 2, 5, 10, 20, 40)
NIELSEN = (36.2, 1.4, 4.0, 86.5, 76.7, 13.1, 85.5, 7.6, 78.9, 144.8, 2.5, 73.8, 80.4, 12.9, 51.6)
"""phi_d, theta_h, theta_d in degrees, of five pairs: J. B. Nielsen et al., TOG 34(6), 2015."""
STEP = 3
"""Of the cells above the horizon, one in so many is compared."""
Pairs = tuple[np.ndarray, np.ndarray]


class Errors(NamedTuple):
    """Means over the cells, channels and materials of the test."""

    by_cell: float
    within: float
    """By cell, of those with both directions within 80 degrees of the normal."""
    by_solid_angle: float
    covered: float


class Bench:
    """The materials that are left out, against what the others make of them."""

    def __init__(self, library: Library, test: Sequence[str]) -> None:
        self.train = Subset(library, [name for name in library.names if name not in test])
        self.test = Subset(library, test)
        self.probes = Probes.of(self.train)
        whole = slice(0, library.grid.size)
        self.lit = np.flatnonzero(library.grid.mask().ravel())[::STEP]
        cells = quadrature.comparison_cells(library.grid)
        self.solid_angle = cells.solid_angle.ravel()[self.lit]
        self.near = ~np.broadcast_to(cells.grazing, library.grid.shape).ravel()[self.lit]
        cos_i, cos_o = cosines_at(library.grid, whole)
        self.cosines = np.asarray(cos_i)[self.lit], np.asarray(cos_o)[self.lit]
        known, truth = (each.columns(whole)[..., self.lit] for each in (self.train, self.test))
        self.known = {
            channels: as_batches(mapped(known, self.cosines), channels)
            for channels in ("apart", "together")
        }
        self.truth = truth

    def errors(self, pairs: Pairs, level: float = 0.9) -> Errors:
        """Of the completion from some directions."""
        setup = Setup.of(self.train, *pairs, probes=self.probes)
        batches = self.known["apart"]
        missed = setup.left_out.astype(np.float32) @ batches - batches
        half = setup.half_width(level) * spread(missed)
        by_material = []
        for name, truth in zip(self.test.names, self.truth.swapaxes(0, 1), strict=True):
            values = self.test.material(name).eval(*pairs)
            recovered = Recovery.of(setup, Measurements(*pairs, values)).weights @ batches[0]
            by_material.append(self._errors(recovered, truth, half))
        return Errors(*np.mean(by_material, axis=0).tolist())

    def seen(self, values: np.ndarray) -> np.ndarray:
        """What errors are taken in."""
        return np.log1p(values * self.cosines[0])

    def mix_error(self, pairs: Pairs) -> float:
        """Of the nearest mix, by cell."""
        setup = Setup.of(self.train, *pairs, probes=self.probes)
        apart = []
        for name, truth in zip(self.test.names, self.truth.swapaxes(0, 1), strict=True):
            values = self.test.material(name).eval(*pairs)
            recipe = Recovery.of(setup, Measurements(*pairs, values)).mix()
            mixed = mix(self.train, recipe).values.reshape(3, -1)[:, self.lit]
            apart.append(np.abs(self.seen(mixed) - self.seen(truth)).mean())
        return float(np.mean(apart))

    def _errors(self, recovered: np.ndarray, truth: np.ndarray, half: np.ndarray) -> list[float]:
        apart = np.abs(self.seen(unmapped(recovered, self.cosines)) - self.seen(truth)).mean(axis=0)
        inside = np.abs(recovered - mapped(truth, self.cosines)) <= half
        by_solid_angle = apart @ self.solid_angle / self.solid_angle.sum()
        means = apart.mean(), apart[self.near].mean(), by_solid_angle, inside.mean()
        return [float(mean) for mean in means]


def main() -> None:
    """Print every figure."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("library")
    parser.add_argument("--test", required=True, help="a file of names, one a line")
    parser.add_argument("--grid", default="", help="that materials are sampled on")
    parser.add_argument("--draws", type=int, default=20, help="of random directions")
    parser.add_argument("--splits", type=int, default=12, help="drawn, for what intervals hold")
    options = parser.parse_args()
    given, grid = open_library(options.library), parse_grid(options.grid)
    if grid:
        models = {name: given.material(name) for name in given.names}
        given = ProceduralLibrary(given.name, models, grid=grid)
    bench = Bench(given, Path(options.test).read_text().split())
    print(f"{len(bench.train)} materials recover {len(bench.test)}, on {given.grid}")
    planned = {n: plan(bench.train, n) for n in NUMBERS}
    print_planned(bench, {n: (found.wi, found.wo) for n, found in planned.items()})
    print_random(bench, options.draws)
    print_rivals(bench)
    print_reaches(bench)
    print_channels(bench, {n: (found.wi, found.wo) for n, found in planned.items()})
    print_splits(given, len(bench.test), options.splits)


def print_planned(bench: Bench, planned: dict[int, Pairs]) -> None:
    """The completion from planned directions."""
    print("planned, within 80 degrees: by cell, of those within 80, by solid angle, covered")
    for n, pairs in planned.items():
        print(f"  {n:3} {_line(bench.errors(pairs))}", flush=True)


def print_reaches(bench: Bench) -> None:
    """Within the reach of common instruments."""
    reaches: dict[str, dict[str, float | bool]] = {
        "within 90": {"max_theta": 90},
        "within 75": {"max_theta": 75},
        "within 75, in plane": {"max_theta": 75, "in_plane": True},
    }
    for label, reach in reaches.items():
        for n in NUMBERS[2:]:
            start = time.perf_counter()
            found = plan(bench.train, n, **reach)  # pyright: ignore[reportArgumentType]
            seconds = time.perf_counter() - start
            errors = bench.errors((found.wi, found.wo))
            print(f"  {label:20} {n:3} {_line(errors)}  planned in {seconds:.1f} s", flush=True)


def print_rivals(bench: Bench) -> None:
    """Published directions, and those of other criteria, recovered in the same way."""
    phi_d, theta_h, theta_d = np.radians(np.reshape(NIELSEN, (5, 3)).T)
    pairs = from_half_diff(HalfDiff(theta_h, np.zeros(5), theta_d, phi_d))
    print(f"Nielsen's five            {_line(bench.errors(pairs))}", flush=True)
    for n in (5, 10, 20):
        for label, chosen in (("pursuit", _pursued), ("conditioned", _conditioned)):
            print(f"{label:20} {n:3}  {_line(bench.errors(_chosen(bench, chosen, n)))}", flush=True)


def print_channels(bench: Bench, planned: dict[int, Pairs]) -> None:
    """Leave-one-out on the training materials alone, channels apart and together."""
    print("leave-one-out of the training materials: apart, together; width and eta apart")
    for n, pairs in planned.items():
        print(f"  {n:3} nearest mix by cell {bench.mix_error(pairs):.4f}", flush=True)
        apart, together = (
            Setup.of(bench.train, *pairs, channels=c, probes=bench.probes)
            for c in ("apart", "together")
        )
        chosen = f"{apart.regression.width:g} {apart.regression.eta:.2g}"
        print(f"  {n:3} {apart.best_error:.4f} {together.best_error:.4f}   {chosen}", flush=True)


def print_random(bench: Bench, n_draws: int) -> None:
    """Random cells of a table: mean over draws, and from the 5th to the 95th percentile."""
    rng = np.random.default_rng(0)
    wi, wo = (each.reshape(-1, 3)[bench.lit] for each in bench.train.grid.directions())
    print(f"random cells, {n_draws} draws: by cell (5 % to 95 %), covered")
    for n in NUMBERS:
        draws = [rng.choice(len(wi), n, replace=False) for _ in range(n_draws)]
        errors = [bench.errors((wi[drawn], wo[drawn])) for drawn in draws]
        by_cell = [each.by_cell for each in errors]
        low, high = np.percentile(by_cell, [5, 95])
        covered = np.mean([each.covered for each in errors])
        print(
            f"  {n:3} {np.mean(by_cell):.4f} ({low:.4f} to {high:.4f})  {covered:.3f}", flush=True
        )


def print_splits(library: Library, n_test: int, n_splits: int) -> None:
    """What intervals hold where the materials that are left out are drawn: mean and standard deviation over draws."""
    rng = np.random.default_rng(0)
    tests = [rng.permutation(library.names)[:n_test].tolist() for _ in range(n_splits)]
    benches = [Bench(library, test) for test in tests]
    print(f"{n_splits} splits that are drawn: by cell, covered (standard deviation)")
    for n in NUMBERS:
        plans = [plan(bench.train, n) for bench in benches]
        errors = [bench.errors((p.wi, p.wo)) for bench, p in zip(benches, plans, strict=True)]
        covered = [each.covered for each in errors]
        by_cell = np.mean([each.by_cell for each in errors])
        print(f"  {n:3} {by_cell:.4f}  {np.mean(covered):.3f} ({np.std(covered):.3f})", flush=True)


def _chosen(bench: Bench, choose: Callable[[np.ndarray, int], list[int]], n: int) -> Pairs:
    wi, wo = spread_pairs(1500, isotropic=True)
    near = np.minimum(wi[:, 2], wo[:, 2]) > np.cos(np.radians(80))
    wi, wo = wi[near], wo[near]
    rows = as_rows(mapped(values_at(bench.train, wi, wo), (wi[:, 2], wo[:, 2])), "apart")
    picked = choose(rows - rows.mean(axis=0), n)
    return wi[picked], wo[picked]


def _pursued(rows: np.ndarray, n: int) -> list[int]:
    """Simultaneous orthogonal matching pursuit: the cell that all others lean on most, again on what it leaves."""
    picked: list[int] = []
    for _ in range(n):
        norms = np.linalg.norm(rows, axis=0)
        norms[norms < 1e-6 * norms.max()] = np.inf
        leaning = np.abs(rows.T @ (rows / norms)).sum(axis=0)
        picked.append(int(np.argmax(leaning)))
        axis = rows[:, picked[-1]] / np.linalg.norm(rows[:, picked[-1]])
        rows = rows - np.outer(axis, axis @ rows)
    return picked


def _conditioned(rows: np.ndarray, n: int, n_sweeps: int = 3) -> list[int]:
    """The least condition number of ``n`` components at ``n`` cells, by exchange from random ones."""
    _, s, v = np.linalg.svd(rows, full_matrices=False)
    components = v[:n].T * s[:n]
    picked = np.random.default_rng(0).choice(len(components), n, replace=False)
    for _ in range(n_sweeps):
        for i in range(n):
            tried = np.repeat(components[picked][None], len(components), axis=0)
            tried[:, i] = components
            picked[i] = int(np.argmin(np.linalg.cond(tried)))
    return picked.tolist()


def _line(errors: Errors) -> str:
    return "{:.4f} {:.4f} {:.4f} {:.3f}".format(*errors)


if __name__ == "__main__":
    main()
