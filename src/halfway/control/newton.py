"""Blends that are not linear, made linear where they stand.

About weights w a blend's readings r change with other weights v as

    r(v) ~ r(w) + sum_i v_i D_i        D_i = d/de r((1 - e) w + e e_i),   sum_i w_i D_i = 0

so ``r(w) + D_i`` is to the mix what the readings of material i are to a linear one, and a programme over those is a step of
Newton's method. D_i is read off small tables by finite differences; so is r(w), and what it differs there from the full table is
read off that when no step is left, and added from then on.
"""

from collections.abc import Callable

import numpy as np
from jaxtyping import Float64, Int

from ..instruments import read_table
from ..look import Looks
from ..recipes import Mixer, Recipe
from .programme import Goals, Weights, solve
from .wishes import Wishes

N_ROUNDS = 6
"""Of steps by small tables, each ended by a look at the full one."""
N_STEPS = 20
ENOUGH = 0.5
"""A step more is not worth its time."""
SHARES = (1.0, 0.5, 0.25)
"""Of a step, which are tried in turn until one is an improvement."""
MISSED = 1e3
"""What a wish costs that is missed by the most that a material does, where another material altogether costs 2."""
SMALL = 1e-3
"""Share of each material that is added to see what it changes."""


Among = Int[np.ndarray, " n"]
"""The materials that may be taken, in the library's order."""
Near = Callable[[Float64[np.ndarray, "N n_instruments 3"]], Weights | None]


class Linearised:
    """The readings of a blend's mixes about some weights."""

    def __init__(self, recipe: Callable[[Weights], Recipe], mixer: Mixer, looks: Looks) -> None:
        self._recipe = recipe
        self._mixer = mixer
        self._tables = looks.tables

    def approach(
        self, wishes: Wishes, weights: Weights, near: Near, among: Among, *, draft: bool = False
    ) -> tuple[Weights, float]:
        """Weights that have what is wished for, and how far off they are in `Wishes.missed`; from those of the linear mix.

        ``near`` gives the nearest weights by the readings of the materials. Steps go there as long as that helps, and then to
        what is nearest to where they stand; of the materials ``among`` which they go, and of those that there are. A
        ``draft`` is by small tables alone.
        """
        best, least = weights, np.inf
        offset = np.zeros(())
        for _ in range(1 if draft else N_ROUNDS):
            weights = self._steps(wishes, weights, near, among, offset)
            readings = self._small(weights) if draft else self.readings(weights)
            missed = wishes.missed(readings)
            if missed >= least:
                break
            best, least = weights, missed
            if missed <= ENOUGH:
                break
            offset = readings - self._small(weights)
        return best, least

    def _steps(
        self, wishes: Wishes, weights: Weights, near: Near, among: Among, offset: np.ndarray
    ) -> Weights:
        """As far as steps go by small tables, whose readings are off by so much."""
        readings = self._small(weights) + offset
        missed, free = wishes.missed(readings), True
        for _ in range(N_STEPS):
            if missed <= ENOUGH:
                break
            about = self._about(weights, readings, offset, among)
            ahead = near(about) if free else _least_change(wishes, about, weights)
            if ahead is None:
                break
            for share in SHARES:
                there = (1 - share) * weights + share * ahead
                readings_there = self._small(there) + offset
                if (missed_there := wishes.missed(readings_there)) < missed:
                    weights, readings, missed = there, readings_there, missed_there
                    break
            else:
                if not free:
                    break
                free = False
        return weights

    def readings(self, weights: Weights) -> Float64[np.ndarray, "n_instruments 3"]:
        """Read off the mixed table."""
        return read_table(self._mixer.mix(self._recipe(weights)))

    def _about(
        self,
        weights: Weights,
        readings: Float64[np.ndarray, "n_instruments 3"],
        offset: np.ndarray,
        among: Among,
    ) -> Float64[np.ndarray, "N n_instruments 3"]:
        """What the readings of each material are to the mix about these weights; NaN of one that takes no part."""
        own = readings - offset
        about = np.full((len(weights), *own.shape), np.nan)
        for i in np.union1d(among, np.flatnonzero(weights)).tolist():
            moved = (1 - SMALL) * weights
            moved[i] += SMALL
            about[i] = readings + (self._small(moved) - own) / SMALL
        return about

    def _small(self, weights: Weights) -> Float64[np.ndarray, "n_instruments 3"]:
        return read_table(self._tables.table(self._recipe(weights)))


def _least_change(
    wishes: Wishes, readings: Float64[np.ndarray, "N n_instruments 3"], weights: Weights
) -> Weights | None:
    """The weights that have what is wished for and differ least from others."""
    n = len(weights)
    stay = Goals(np.eye(n) - weights[:, None], np.ones(n), np.ones(n))
    return solve(np.zeros(n), Goals.join([stay, wishes.goals(readings, missed=MISSED)]))
