"""What is not linear in the weights, made linear where they stand: other blends than the linear one, and what people perceive.

About weights w the readings r of mixes change with other weights v as

    r(v) ~ r(w) + sum_i v_i D_i        D_i = d/de r((1 - e) w + e e_i),   sum_i w_i D_i = 0

so ``r(w) + D_i`` is to the mix what the readings of material i are to a linear one, and a programme over those is a step of
Newton's method. D_i is read off small tables, which know how a mix changes (`SmallTables.about`); so is r(w), and what it differs
there from the full table is read off that when no step is left, and added from then on.
"""

from collections.abc import Callable, Collection
from functools import cached_property, partial

import numpy as np
from jaxtyping import Int

from ..recipes import Blend, Recipe
from .programme import Goals, Weights, solve
from .reader import MixReader, Reading, SmallReader
from .wishes import Values, Wishes

N_ROUNDS = 6
"""Of steps by small tables, each ended by a look at the full one."""
N_STEPS = 20
ENOUGH = 0.5
"""A step more is not worth its time."""
DRAFTED = 2.0
"""Nor for a draft, whose small tables read as far off."""
SHARES = (1.0, 0.5, 0.25)
"""Of a step, which are tried in turn until one is an improvement."""
MISSED = 1e3
"""What a wish costs that is missed by the most that a material does, where another material altogether costs 2."""
SMALL = 1e-3
"""Of a change, as far as which the readings are taken for straight: those of instruments are, what people perceive nearly."""

Among = Int[np.ndarray, " n"]
"""The materials that may be taken, in the library's order."""
Near = Callable[[Values], Weights | None]


class Linearised:
    """The readings of a blend's mixes about some weights, as far as wishes ask for them, and what is asked ``also``."""

    def __init__(
        self,
        wishes: Wishes,
        recipe: Callable[[Weights], Recipe],
        reader: MixReader,
        blend: Blend,
        *,
        also: Collection[str] = (),
    ) -> None:
        self._wishes = wishes
        self._names = {*wishes.names, *also}
        self._recipe = recipe
        self._reader = reader
        self._blend = blend
        self.values = reader.values
        self.is_linear = reader.is_linear(blend)

    @cached_property
    def _of_small(self) -> SmallReader:
        return SmallReader(self._names, self._reader)

    def approach(
        self, weights: Weights, near: Near, among: Among, *, draft: bool = False
    ) -> tuple[Weights, float]:
        """Weights that have what is wished for, and how far off they are in `Wishes.missed`; from those of the linear mix.

        ``near`` gives the nearest weights by the readings of the materials. Steps go there as long as that helps, and then to
        what is nearest to where they stand; of the materials ``among`` which they go, and of those that there are. A
        ``draft`` is by small tables alone.
        """
        best, least = weights, np.inf
        enough = DRAFTED if draft else ENOUGH
        offset = np.zeros(())
        for _ in range(1 if draft else N_ROUNDS):
            weights = self._steps(weights, near, among, offset, enough)
            readings = self._small(weights) if draft else self.readings(weights)
            missed = self._wishes.missed(readings)
            if missed >= least:
                break
            best, least = weights, missed
            if missed <= enough:
                break
            offset = readings - self._small(weights)
        return best, least

    def corrected(self, weights: Weights) -> Weights | None:
        """The weights that have what is wished for and differ little from others, of the same materials; None where steps find none."""
        if self._wishes.missed(self.readings(weights)) <= 1:
            return weights
        near = partial(self._least_change, weights=weights)
        nearest, missed = self.approach(weights, near, np.flatnonzero(weights))
        return nearest if missed <= 1 else None

    def _steps(
        self, weights: Weights, near: Near, among: Among, offset: np.ndarray, enough: float
    ) -> Weights:
        """As far as steps go by small tables, whose readings are off by so much."""
        readings = self._small(weights) + offset
        missed, free = self._wishes.missed(readings), True
        for _ in range(N_STEPS):
            if missed <= enough:
                break
            about = self._about(weights, among) + offset
            ahead = near(about) if free else self._least_change(about, weights)
            if ahead is None:
                break
            for share in SHARES:
                there = (1 - share) * weights + share * ahead
                readings_there = self._small(there) + offset
                if (missed_there := self._wishes.missed(readings_there)) < missed:
                    weights, readings, missed = there, readings_there, missed_there
                    break
            else:
                if not free:
                    break
                free = False
        return weights

    def readings(self, weights: Weights) -> Reading:
        """Of the mix, in full."""
        return self._reader.of(self._recipe(weights))

    def about(self, weights: Weights) -> Values:
        """What the readings of each material are to the mix about these weights."""
        offset = self.readings(weights) - self._small(weights)
        return self._about(weights, np.arange(len(weights))) + offset

    def _about(self, weights: Weights, among: Among) -> Values:
        """What the readings of each material are to the mix about these weights; NaN of one that takes no part."""
        part = np.union1d(among, np.flatnonzero(weights))
        mixed, changes = self._of_small.mixes.about(weights, self._blend, part)
        own = self._of_small.read(mixed)
        moved = self._of_small.read(mixed + np.float32(SMALL) * changes)
        about = np.full((len(weights), *own.shape), np.nan)
        about[part] = own + (moved - own) / SMALL
        return about

    def _small(self, weights: Weights) -> Reading:
        dense = np.broadcast_to(weights, (3, 1, len(weights)))
        return self._of_small.read(self._of_small.mixes.mix(dense, self._blend)[:, 0])

    def _least_change(self, about: Values, weights: Weights) -> Weights | None:
        """The weights that have what is wished for, by the readings about others, and differ least from these."""
        n = len(weights)
        stay = Goals(np.eye(n) - weights[:, None], np.ones(n), np.ones(n))
        return solve(np.zeros(n), Goals.join([stay, self._wishes.goals(about, missed=MISSED)]))
