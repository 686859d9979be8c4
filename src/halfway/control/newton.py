"""Blends that are not linear, made linear where they stand.

About weights w a blend's readings r change with other weights v as

    r(v) ~ r(w) + sum_i v_i D_i        D_i = d/de r((1 - e) w + e e_i),   sum_i w_i D_i = 0

so ``r(w) + D_i`` is to the mix what the readings of material i are to a linear one, and a programme over those is a step of
Newton's method. r(w) is read off the mixed table, D_i off small tables by finite differences.
"""

from collections.abc import Callable

import numpy as np
from jaxtyping import Float64

from ..brdf import TabularBrdf
from ..instruments import read_table
from ..library import Library, LibraryRef
from ..look import Looks
from ..recipes import Blend, Mixer, Recipe
from .programme import Goals, Weights, solve
from .wishes import Wishes

N_STEPS = 20
ENOUGH = 0.5
"""A step more is not worth its time."""
SHARES = (1.0, 0.5, 0.25)
"""Of a step, which are tried in turn until one is an improvement."""
MISSED = 1e3
"""What a wish costs that is missed by the most that a material does, where another material altogether costs 2."""
SMALL = 1e-3
"""Share of each material that is added to see what it changes."""


Near = Callable[[Float64[np.ndarray, "N n_instruments 3"]], Weights | None]


class Linearised:
    """The readings of a blend's mixes about some weights."""

    def __init__(self, library: Library, looks: Looks, blend: Blend) -> None:
        self._mixer = Mixer(library)
        self._library = LibraryRef.of(library)
        self._tables = looks.tables
        self._names = looks.names
        self._blend = blend

    def approach(self, wishes: Wishes, weights: Weights, near: Near) -> tuple[Weights, float]:
        """Weights that have what is wished for, and how far off they are in `Wishes.missed`; from those of the linear mix.

        ``near`` gives the nearest weights by the readings of the materials. Steps go there as long as that helps, and then to
        what is nearest to where they stand.
        """
        readings = self.readings(weights)
        missed, free = wishes.missed(readings), True
        for _ in range(N_STEPS):
            if missed <= ENOUGH:
                break
            about = self._about(weights, readings)
            ahead = near(about) if free else _least_change(wishes, about, weights)
            if ahead is None:
                break
            for share in SHARES:
                there = (1 - share) * weights + share * ahead
                readings_there = self.readings(there)
                if (missed_there := wishes.missed(readings_there)) < missed:
                    weights, readings, missed = there, readings_there, missed_there
                    break
            else:
                if not free:
                    break
                free = False
        return weights, missed

    def recipe(self, weights: Weights) -> Recipe:
        """The recipe of weights that are the same for all channels."""
        dense = np.broadcast_to(weights, (3, len(weights)))
        return Recipe.from_dense(self._library, self._names, dense, self._blend)

    def readings(self, weights: Weights) -> Float64[np.ndarray, "n_instruments 3"]:
        """Read off the mixed table."""
        return read_table(self._mixer.mix(self.recipe(weights)))

    def _about(
        self, weights: Weights, readings: Float64[np.ndarray, "n_instruments 3"]
    ) -> Float64[np.ndarray, "N n_instruments 3"]:
        """What the readings of each material are to the mix about these weights."""
        own = self._small(weights)
        moved = (1 - SMALL) * weights + SMALL * np.eye(len(weights))
        return np.stack([readings + (self._small(each) - own) / SMALL for each in moved])

    def _small(self, weights: Weights) -> Float64[np.ndarray, "n_instruments 3"]:
        dense = np.broadcast_to(weights, (3, 1, len(weights)))
        grid = self._tables.grid
        values = self._tables.mix(dense, self._blend)[:, 0].reshape(3, *grid.shape)
        # Below the horizon a small table has the values of neighbours; a table has none.
        return read_table(TabularBrdf(np.where(grid.mask(), values, np.float32(np.nan)), grid))


def _least_change(
    wishes: Wishes, readings: Float64[np.ndarray, "N n_instruments 3"], weights: Weights
) -> Weights | None:
    """The weights that have what is wished for and differ least from others."""
    n = len(weights)
    stay = Goals(np.eye(n) - weights[:, None], np.ones(n), np.ones(n))
    return solve(np.zeros(n), Goals.join([stay, wishes.goals(readings, missed=MISSED)]))
