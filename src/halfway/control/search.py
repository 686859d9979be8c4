"""The search for one recipe: the mixes that have what is wished for, and what there is where none has it all."""

from collections.abc import Collection
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from jaxtyping import Float64

from ..errors import OutOfReachError
from ..recipes import Blend, Recipe
from .newton import Linearised, Near
from .programme import Goals, Weights, solve
from .recolour import holding, with_colour
from .reference import Like, Reference
from .wishes import Values, Wishes

if TYPE_CHECKING:
    from .control import Control

SPREAD = 0.1
"""What the distance of the ingredients counts, where that of their mix counts 1: of mixes that are as near, the one of
materials that are near is taken."""
MISSED = 1e3
"""What it costs to miss a wish by the most that a material does, where the farthest material costs 1."""


class Found(NamedTuple):
    """A mix, and by how much it misses what is wished for, where 1 is near enough."""

    recipe: Recipe | None
    missed: float


@dataclass(frozen=True, kw_only=True)
class Search:
    """For a recipe that is like something, in one blend."""

    control: "Control"
    like: Like
    reference: Reference
    blend: Blend
    few: bool
    draft: bool
    """Whether small tables do."""

    def best(self, wishes: Wishes, release: Collection[str], *, clamp: bool) -> Recipe | None:
        """The mix that holds what is held; else what it shall be like with its body scaled; else the nearest mix. None where none has what is wished for.

        Raises
        ------
        OutOfReachError
            When the steps of a blend that is not linear do not come near enough.
        """
        held = holding(wishes, self.reference.readings, release)
        scaled = None
        if held is not None:
            nearest = self.mix(held, thorough=False)
            if nearest.missed <= 1:
                return nearest.recipe
            scaled = self._recoloured(wishes)
            if scaled and self._missed(held, scaled) <= 1:
                return scaled
        nearest = self.mix(wishes, clamp=clamp and scaled is None)
        if nearest.missed <= 1 or (scaled is None and (clamp or self.draft)):
            return nearest.recipe
        # Of linear mixes it can be said how far each wish goes.
        if scaled is None and nearest.recipe is not None and self.blend is not Blend.LINEAR:
            raise OutOfReachError(
                f"no mix by the blend {str(self.blend)!r} near to the linear one has {wishes}: the nearest that was found is "
                f"{nearest.missed:.3g} times too far off. Ask for less, take --blend linear, or this one with --clamp."
            )
        return scaled

    def mix(self, wishes: Wishes, *, clamp: bool = False, thorough: bool = True) -> Found:
        """The nearest mix of materials; with ``clamp`` there always is one, and not linear it is only tried for if ``thorough``."""
        differences = self.control.nearness.scaled(self.reference.numbers, held=wishes.held())
        near = partial(_nearest, wishes, differences, few=self.few)
        mixes = self.control.mixes(wishes, self.blend)
        # What is not linear may have what no mix would have if it were: it begins at the nearest of those.
        weights = near(mixes.values, clamp=clamp or not mixes.is_linear)
        if weights is None:
            return Found(None, np.inf)
        if mixes.is_linear or not wishes.names:
            return Found(self._recipe(weights), 0.0)
        clamped = partial(near, clamp=True)
        return self._approached(mixes, weights, clamped, thorough=thorough)

    def _approached(
        self, mixes: Linearised, weights: Weights, near: Near, *, thorough: bool
    ) -> Found:
        """By steps from the linear mix; nearly always those materials do that it has, and a step among all takes several times as long."""
        names = self.control.library.names
        known = self.like.dense(names).any(axis=0) if isinstance(self.like, Recipe) else 0
        among = np.flatnonzero(known + weights)
        nearest, missed = mixes.approach(weights, near, among, draft=self.draft)
        if missed > 1 and thorough and not self.draft:
            everything = np.arange(len(weights))
            nearest, missed = mixes.approach(weights, near, everything)
        return Found(self._recipe(nearest), missed)

    def _recoloured(self, wishes: Wishes) -> Recipe | None:
        """What it shall be like, or the mix that has the other wishes, with its body scaled; None where that does not do."""
        others = wishes.without("exact", "body")
        if isinstance(self.like, Recipe) and not list(others.each()):
            recipe = self.like.unscaled()
        else:
            recipe = self.mix(others).recipe
        table = partial(self.control.reader().table, draft=self.draft)
        scaled = recipe and with_colour(recipe, table(recipe), wishes.exact["body"])
        return scaled if scaled and self._missed(wishes, scaled) <= 1 else None

    def _missed(self, wishes: Wishes, recipe: Recipe) -> float:
        return wishes.missed(self.control.reader(wishes.names).of(recipe, draft=self.draft))

    def _recipe(self, weights: Weights) -> Recipe:
        return self.control.recipe(weights, self.blend)


def _nearest(
    wishes: Wishes,
    differences: Float64[np.ndarray, "N d"],
    readings: Values,
    *,
    few: bool,
    clamp: bool,
) -> Weights | None:
    """The weights of the nearest mix of materials with these readings, or where none has what is wished for None."""
    distance = np.abs(differences).sum(axis=1)
    asked = wishes.goals(readings, missed=MISSED * distance.max() if clamp else np.inf)
    near = Goals(differences.T, *np.ones((2, differences.shape[1])))
    # Each goal takes a material more: the fewest are found where the mix itself is not compared.
    return solve(SPREAD * distance, asked if few else Goals.join([near, asked]))
