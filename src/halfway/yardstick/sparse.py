"""The task `recover`: a material from its values at n pairs of directions.

A method is a function of the materials that it may learn from, n, and a generator of random numbers. It says which directions it
wants, and gives what completes their values to a table; None where it cannot take so many.

    def mine(train: Library, n: int, rng: np.random.Generator) -> Sampling | None: ...

    benchmark(recoveries=RECOVERIES | {"mine": RecoveryMethod(mine)})

[1] J. B. Nielsen, H. W. Jensen, R. Ramamoorthi, "On Optimal, Minimal BRDF Sampling for Reflectance Acquisition", ACM TOG 34(6), 2015.
[2] "FROST": simultaneous orthogonal matching pursuit for the same, 2024.
"""

from collections.abc import Callable, Mapping
from functools import partial
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Float32, Float64, Int

from .._types import Directions
from ..brdf import quadrature
from ..halfdiff import Grid
from ..library import Library
from ..measurements import Measurements
from ..recipes import Mixer
from ..recovery import Recovery, Setup, log_relative, plan
from .data import values_of
from .reconstruction import LogRelative

ETA = 40.0
"""Of Nielsen's ridge."""
N_CANDIDATES = 1500
"""Cells of which directions are chosen."""
N_EXCHANGED = 300
"""Candidates that are tried in the place of each direction."""
N_SWEEPS = 2
MOST_EXCHANGED = 20
"""Directions beyond which an exchange takes too long."""

Complete = Callable[[Float64[np.ndarray, "n 3"]], Float[np.ndarray, "3 p"]]


class Sampling(NamedTuple):
    """What a method asks for, and makes of it."""

    wi: Directions
    wo: Directions
    complete: Complete


N_DRAWS = 20
"""Of directions, where a method is fast."""


class RecoveryMethod(NamedTuple):
    """A method of the task."""

    method: Callable[[Library, int, np.random.Generator], Sampling | None]
    n_draws: int = 1
    """Over how many draws it is judged, at most: 1 where its directions are not drawn."""


Cells = Int[np.ndarray, " n"]
Choice = Callable[["Rows", int, np.random.Generator], "Cells | None"]


class Rows:
    """The training materials in the log-relative mapping, a row for each channel of each, about their mean."""

    def __init__(self, train: Library) -> None:
        self.grid = train.grid
        self.mapping = LogRelative(train)
        mapped = self.mapping.to(values_of(train))
        rows = mapped.reshape(-1, mapped.shape[-1])
        self.mean: Float32[np.ndarray, " p"] = rows.mean(axis=0)
        self.rows: Float32[np.ndarray, "n_rows p"] = rows - self.mean

    def candidates(self, rng: np.random.Generator, n: int = N_CANDIDATES) -> Cells:
        """Cells that directions are chosen of, each as likely."""
        allowed = _measurable(self.grid)
        return np.sort(rng.choice(allowed, min(n, len(allowed)), replace=False))

    def complete(self, cells: Cells, values: Float64[np.ndarray, "n 3"]) -> np.ndarray:
        """The ridge: c = (X_o X_o^T + eta)^-1 of what is measured about the mean, a sum of rows."""
        known = self.rows[:, cells].astype(np.float64)
        measured = np.full((3, 1, self.grid.size), np.nan, np.float32)
        measured[:, 0, cells] = values.T
        off = self.mapping.to(measured)[:, 0, cells] - self.mean[cells]
        inner = known.T @ known + ETA * np.eye(len(cells))
        weights = np.linalg.solve(inner, off.T.astype(np.float64)).T @ known.T
        mapped = self.mean + weights.astype(np.float32) @ self.rows
        return self.mapping.back(mapped[:, None])[:, 0]


def ridge(choose: Choice, train: Library, n: int, rng: np.random.Generator) -> Sampling | None:
    """Nielsen's ridge of values at cells that are chosen somehow."""
    rows = Rows(train)
    cells = choose(rows, n, rng)
    if cells is None:
        return None
    wi, wo = (x.reshape(-1, 3)[cells] for x in train.grid.directions())
    return Sampling(wi, wo, partial(rows.complete, cells))


def planned(train: Library, n: int, rng: np.random.Generator) -> Sampling | None:
    """`halfway.recover` at the directions of `halfway.plan`."""
    del rng
    chosen = plan(train, n)
    return Sampling(chosen.wi, chosen.wo, completion(train, chosen.wi, chosen.wo))


def planned_mix(train: Library, n: int, rng: np.random.Generator) -> Sampling | None:
    """The nearest mix at the directions of `halfway.plan`."""
    del rng
    chosen = plan(train, n)
    setup, mixer = Setup.of(train, chosen.wi, chosen.wo), Mixer(train)

    def mixed(values: Float64[np.ndarray, "n 3"]) -> np.ndarray:
        recipe = Recovery.of(setup, Measurements(chosen.wi, chosen.wo, values)).mix()
        return mixer.mix(recipe).values.reshape(3, -1)

    return Sampling(chosen.wi, chosen.wo, mixed)


def unplanned(train: Library, n: int, rng: np.random.Generator) -> Sampling | None:
    """`halfway.recover` at directions that are drawn."""
    wi, wo = random_directions(train.grid, n, rng)
    return Sampling(wi, wo, completion(train, wi, wo))


def random_directions(
    grid: Grid, n: int, rng: np.random.Generator
) -> tuple[Directions, Directions]:
    """Those of cells within reach, each as likely."""
    cells = rng.choice(_measurable(grid), n, replace=False)
    wi, wo = (x.reshape(-1, 3)[cells] for x in grid.directions())
    return wi, wo


def completion(train: Library, wi: Directions, wo: Directions) -> Complete:
    """What `halfway.recover` makes of values at these directions: the completed table, without its interval."""
    setup, cosines = Setup.of(train, wi, wo), log_relative.cosines_at(train.grid, slice(None))
    rows = log_relative.mapped(values_of(train), cosines).reshape(3 * len(train), -1)

    def completed(values: Float64[np.ndarray, "n 3"]) -> np.ndarray:
        weights = Recovery.of(setup, Measurements(wi, wo, values)).weights
        return log_relative.unmapped(weights.astype(np.float32) @ rows, cosines)

    return completed


def drawn(rows: Rows, n: int, rng: np.random.Generator) -> Cells | None:
    """Cells at random, each as likely."""
    return rng.choice(_measurable(rows.grid), n, replace=False)


def pursued(rows: Rows, n: int, rng: np.random.Generator) -> Cells | None:
    """FROST: the cells whose columns of S^-1 U^T, of n components and normalised, explain V^T best, one after another [2]."""
    candidates = rows.candidates(rng)
    u, s, vt = np.linalg.svd(rows.rows[:, candidates].T.astype(np.float64), full_matrices=False)
    if n > int((s > 1e-6 * s[0]).sum()):
        return None
    atoms = u[:, :n].T / s[:n, None]
    atoms /= np.linalg.norm(atoms, axis=0)
    targets = rest = vt[:n]
    chosen: list[int] = []
    for _ in range(n):
        gain = np.square(atoms.T @ rest).sum(axis=1)
        gain[chosen] = -1
        chosen.append(int(gain.argmax()))
        basis = atoms[:, chosen]
        rest = targets - basis @ np.linalg.lstsq(basis, targets, rcond=None)[0]
    return candidates[chosen]


def conditioned(rows: Rows, n: int, rng: np.random.Generator) -> Cells | None:
    """Nielsen: cells whose rows of n components have the least condition number, by exchange of one at a time [1]."""
    if n > MOST_EXCHANGED:
        return None
    candidates = rows.candidates(rng, N_EXCHANGED)
    u, s, _ = np.linalg.svd(rows.rows[:, candidates].T.astype(np.float64), full_matrices=False)
    q = u[:, :n] * s[:n]
    chosen = rng.choice(len(candidates), n, replace=False)
    for _ in range(N_SWEEPS):
        for i in range(n):
            trials = np.repeat(chosen[None], len(candidates), axis=0)
            trials[:, i] = np.arange(len(candidates))
            chosen = trials[int(_conditions(q[trials]).argmin())]
    return candidates[chosen]


def _conditions(matrices: Float64[np.ndarray, "m n n"]) -> Float64[np.ndarray, " m"]:
    singular = np.linalg.svd(matrices, compute_uv=False)
    # One number has no condition: the largest is taken.
    if matrices.shape[-1] == 1:
        return -singular[:, 0]
    return singular[:, 0] / np.maximum(singular[:, -1], np.finfo(float).tiny)


def _measurable(grid: Grid) -> Cells:
    cells = quadrature.comparison_cells(grid)
    return np.flatnonzero(grid.mask() & ~cells.grazing)


RECOVERIES: Mapping[str, RecoveryMethod] = {
    "halfway, planned directions": RecoveryMethod(planned),
    "halfway, random directions": RecoveryMethod(unplanned, N_DRAWS),
    "nearest mix, planned directions": RecoveryMethod(planned_mix),
    "ridge, Nielsen's directions": RecoveryMethod(partial(ridge, conditioned)),
    "ridge, FROST's directions": RecoveryMethod(partial(ridge, pursued)),
    "ridge, random directions": RecoveryMethod(partial(ridge, drawn), N_DRAWS),
}
