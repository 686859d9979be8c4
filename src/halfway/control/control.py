"""What is known of a library to find recipes with, and the finding.

The weights are one row for all channels, so that what is linear in the table is linear in them.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float64

from ..brdf import Brdf
from ..colour import from_hex
from ..errors import OutOfReachError
from ..instruments import (
    ATTRIBUTES,
    Attribute,
    Readings,
    attribute,
    of_readings,
    read_table,
    table_of,
)
from ..library import Library, LibraryRef, open_library
from ..look import Looks
from ..recipes import Blend, Mixer, Recipe, split_address
from ..tasks import HERE, Work
from .nearness import Nearness, numbers, numbers_of
from .newton import Linearised
from .pictures import PICTURES, picture_numbers
from .programme import Goals, Weights, solve
from .wishes import SIGNS, Wishes, row_of

SPREAD = 0.1
"""What the distance of the ingredients counts, where that of their mix counts 1: of mixes that are as near, the one of
materials that are near is taken."""
MISSED = 1e3
"""What it costs to miss a wish by the most that a material does, where the farthest material costs 1."""
KEPT = 0.2
"""Share by which an attribute may change and still be what it was."""
N_STEPS = 50
"""Of the search for the end of a range; a ratio takes three or four."""
SAME = 1e-9
"""A step that moves the end by less, as a share, is the last."""

Like = str | Recipe | Brdf | None


class Range(NamedTuple):
    """From the least to the most of an attribute."""

    low: float
    high: float


@dataclass(frozen=True, eq=False)
class Control:
    """What is known of a library to find recipes with."""

    library: Library
    readings: Readings
    looks: Looks
    nearness: Nearness
    mixer: Mixer

    @classmethod
    def of(
        cls, library: Library | str, *, mixer: Mixer | None = None, work: Work = HERE
    ) -> "Control":
        """What is known of ``library``: read off its tables once, and kept in the cache; its ``mixer``, where there is one."""
        opened = open_library(library) if isinstance(library, str) else library
        readings = Readings.fit(opened, work=work)
        looks = Looks.fit(opened, work=work)
        return cls(opened, readings, looks, Nearness.of(looks, readings), mixer or Mixer(opened))

    def find(
        self,
        wishes: Wishes,
        *,
        like: Like = None,
        blend: Blend = Blend.LINEAR,
        few: bool = False,
        clamp: bool = False,
        draft: bool = False,
    ) -> Recipe:
        """The recipe that has what is wished for and is nearest to ``like``; see the function `find`.

        In another blend than the linear one a ``draft`` has what is wished for roughly, and is found sooner.
        """
        differences = self.nearness.scaled(self._reference(like, wishes), held=wishes.held())
        near = partial(_nearest, wishes, differences, few=few)
        # Another blend may have what no linear mix has: it begins at the nearest of those.
        weights = near(self.readings.values, clamp=clamp or blend is not Blend.LINEAR)
        if weights is None:
            raise OutOfReachError(self.out_of_reach(wishes))
        if blend is not Blend.LINEAR:
            weights = self._blended(wishes, like, blend, weights, near, clamp=clamp, draft=draft)
        return self._recipe(weights, blend)

    def _blended(
        self,
        wishes: Wishes,
        like: Like,
        blend: Blend,
        weights: Weights,
        near: Callable[..., Weights | None],
        *,
        clamp: bool,
        draft: bool,
    ) -> Weights:
        """What a blend needs to have what is wished for, from the weights of the linear mix."""
        recipe = partial(self._recipe, blend=blend)
        mixes = Linearised(recipe, self.mixer, self.looks, blend)
        known = (
            self._dense(like).any(axis=0) if isinstance(like, Recipe) else np.zeros(len(weights))
        )
        few = np.flatnonzero(known + weights)
        # Nearly always those do that the linear mix has; a step among all takes ten times as long.
        for among in (few, np.arange(len(weights))):
            found, missed = mixes.approach(
                wishes, weights, partial(near, clamp=True), among, draft=draft
            )
            if missed <= 1 or draft:
                return found
        if not clamp:
            raise OutOfReachError(
                f"no mix by the blend {str(blend)!r} near to the linear one has {wishes}: the nearest that was found is "
                f"{missed:.3g} times too far off. Ask for less, take --blend linear, or this one with --clamp."
            )
        return found

    def reach(self, name: str, wishes: Wishes) -> Range | None:
        """From the least to the most of an attribute where ``wishes`` hold; None where no mix has those."""
        wanted = attribute(name)
        wishes.require(wanted, bound=True)
        goals = wishes.goals(self.readings.values)
        start = solve(np.zeros(len(self.library)), goals)
        if start is None:
            return None
        return Range(*(self._end(wanted, wishes, goals, start, sign) for sign in (-1, 1)))

    def attributes(self, recipe: Recipe) -> dict[str, Any]:
        """The attributes of a recipe of the library, by name; of a linear one without its table."""
        return of_readings(self._reading(recipe))

    def given_up(self, recipe: Recipe, wishes: Wishes, like: str) -> dict[str, tuple[Any, Any]]:
        """What a recipe should have kept of what it is like, and did not: the values there and here, by the attribute."""
        if like not in self.library.names:
            return {}
        there = of_readings(self.readings.values[self.library.index(like)])
        here = self.attributes(recipe)
        kept = [a for a in ATTRIBUTES.values() if a.group in wishes.held()]
        return {
            a.name: (there[a.name], here[a.name])
            for a in kept
            if np.any(np.abs(here[a.name] - there[a.name]) > a.close + KEPT * np.abs(there[a.name]))
        }

    def number(self, wanted: Attribute, weights: Weights) -> float:
        """An attribute of a mix; the most there is where it has none, as a matte one no highlight."""
        dense = np.broadcast_to(weights, (3, len(weights)))
        value = float(wanted.of(self.readings.mix(dense, Blend.LINEAR)))
        return wanted.most if np.isnan(value) else value

    def _end(
        self, wanted: Attribute, wishes: Wishes, goals: Goals, start: Weights, sign: int
    ) -> float:
        """The least or the most: a step goes as far as can be beyond the value before, until there is nothing beyond.

        W. Dinkelbach, "On Nonlinear Fractional Programming", Management Science 13, 1967.
        """
        value = self.number(wanted, start)
        for _ in range(N_STEPS):
            (condition,) = wanted.conditions(value, wishes.exact)
            weights = solve(-sign * row_of(condition, self.readings.values), goals)
            beyond = value if weights is None else self.number(wanted, weights)
            if sign * (beyond - value) <= SAME * max(abs(value), SAME):
                break
            value = beyond
        return value

    def _reference(self, like: Like, wishes: Wishes) -> Float64[np.ndarray, " d"]:
        """The numbers of what a recipe shall be like; without it, of the material that is nearest to the wishes."""
        if like is None:
            return self.nearness.points[wishes.nearest(self.readings.values)]
        if isinstance(like, Recipe):
            picture = self.looks.mix(self._dense(like), like.blend)
            return numbers(picture[None], self._reading(like)[None])[0]
        if not isinstance(like, str):
            return numbers_of(table_of(like))
        if like in self.library.names:
            return self.nearness.points[self.library.index(like)]
        if (colour := from_hex(like)) is not None:
            return self.nearness.alone("colour", colour)
        if Path(like).suffix.lower() in PICTURES:
            materials = self.nearness.of_group("picture")
            return self.nearness.alone("picture", picture_numbers(Path(like), materials))
        named = len(split_address(like)) > 1
        return numbers_of(table_of(like, library="" if named else self.library.address))

    def out_of_reach(self, wishes: Wishes) -> str:
        """Which wish is at fault, by itself or beside the others; how far it goes, and what to do."""
        for alone in (True, False):
            for kind, name, target in wishes.each():
                others = wishes.without(kind, name)
                held = others.only(attribute(name).needs) if alone else others
                if told := self._too_far(kind, name, target, held):
                    return (
                        f"{told} Ask for that, release another, or take the nearest with --clamp."
                    )
        return (
            f"no mix of {self.library.name} has {wishes}, and none with one of them less: "
            "release some, or take the nearest with --clamp."
        )

    def _too_far(self, kind: str, name: str, target: Any, held: Wishes) -> str | None:
        """What to say of a wish that no mix has where the others hold; None where one does, or none has the others."""
        wanted = attribute(name)
        beside = f" where {held}" if list(held.each()) else ""
        told = f"no mix of {self.library.name} has {name} {SIGNS[kind]} {wanted.written(target)}{beside}"
        if not wanted.is_number:
            return self._nearest_colour(wanted, target, held, told)
        ends = self.reach(name, held)
        too_low = kind != "at_least" and ends is not None and target < ends.low
        too_high = kind != "at_most" and ends is not None and target > ends.high
        if ends is None or not (too_low or too_high):
            return None
        return (
            f"{told}: it goes from {wanted.written(ends.low)} to {wanted.written(ends.high)} there."
        )

    def _nearest_colour(
        self, wanted: Attribute, target: Any, held: Wishes, told: str
    ) -> str | None:
        nothing = np.zeros(len(self.library))
        hard = held.goals(self.readings.values)
        soft = Wishes({wanted.name: target}).goals(self.readings.values, missed=1.0)
        weights = solve(nothing, Goals.join([hard, soft]))
        exactly = Goals.join([hard, Wishes({wanted.name: target}).goals(self.readings.values)])
        if weights is None or solve(nothing, exactly) is not None:
            return None
        return (
            f"{told}: the nearest is {wanted.written(weights @ wanted.of(self.readings.values))}."
        )

    def _reading(self, recipe: Recipe) -> Float64[np.ndarray, "n_instruments 3"]:
        if recipe.blend is Blend.LINEAR:
            return self.readings.mix(self._dense(recipe), recipe.blend)
        return read_table(self.mixer.mix(recipe))

    def _dense(self, recipe: Recipe) -> Float64[np.ndarray, "3 N"]:
        """The weights of a recipe over all materials."""
        weights = np.zeros((3, len(self.library)))
        weights[:, [self.library.index(name) for name in recipe.names]] = recipe.weights
        return weights

    def _recipe(self, weights: Weights, blend: Blend) -> Recipe:
        dense = np.broadcast_to(weights, (3, len(weights)))
        return Recipe.from_dense(LibraryRef.of(self.library), self.library.names, dense, blend)


def _nearest(
    wishes: Wishes,
    differences: Float64[np.ndarray, "N d"],
    readings: Float64[np.ndarray, "N n_instruments 3"],
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
