"""What is known of a library to find recipes with, and the finding.

The weights are one row for all channels, so that what is linear in the table is linear in them.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float64

from ..brdf import TabularBrdf
from ..errors import OutOfReachError
from ..instruments import (
    ATTRIBUTES,
    Attribute,
    Readings,
    attribute,
    of_readings,
    read_table,
)
from ..library import Library, LibraryRef, open_library
from ..look import PACING_SCENE, Looks, SphereScene
from ..recipes import Blend, Mixer, Recipe, is_recipe_file, open_recipe
from ..tasks import HERE, Work
from .nearness import Nearness
from .programme import Goals, Weights, solve
from .recolour import changed, in_colour
from .reference import Like, Reference
from .search import Search
from .wishes import SIGNS, Wishes, row_of

N_STEPS = 50
"""Of the search for the end of a range; a ratio takes three or four."""
SAME = 1e-9
"""A step that moves the end by less, as a share, is the last."""


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
        cls,
        library: Library | str,
        *,
        lights: np.ndarray | None = None,
        mixer: Mixer | None = None,
        work: Work = HERE,
    ) -> "Control":
        """What is known of ``library``: read off its tables once, and kept in the cache; its ``mixer``, where there is one.

        Pictures are compared in the light in which routes are paced, or in other ``lights`` (see `SphereScene.under`).
        """
        opened = open_library(library)
        scene = PACING_SCENE if lights is None else SphereScene.under(lights)
        readings = Readings.fit(opened, work=work)
        looks = Looks.fit(opened, scene, work=work)
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
        release: Collection[str] = (),
    ) -> Recipe:
        """The recipe that has what is wished for and is nearest to ``like``; see the function `find`.

        In another blend than the linear one a ``draft`` has what is wished for roughly, and is found sooner.
        """
        like = self._as_recipe(like)
        search = Search(
            control=self,
            like=like,
            reference=self.reference(like, wishes, draft=draft),
            blend=blend,
            few=few,
            draft=draft,
        )
        recipe = search.best(wishes, release, clamp=clamp)
        if recipe is None:
            raise OutOfReachError(self.out_of_reach(wishes))
        return recipe

    def reach(self, name: str, wishes: Wishes) -> Range | None:
        """From the least to the most of an attribute where ``wishes`` hold; None where no mix has those."""
        wanted = attribute(name)
        wishes.require(wanted, bound=True)
        goals = wishes.goals(self.readings.values)
        start = solve(np.zeros(len(self.library)), goals)
        if start is None:
            return None
        return Range(*(self._end(wanted, wishes, goals, start, sign) for sign in (-1, 1)))

    def attributes(self, recipe: Recipe, *, draft: bool = False) -> dict[str, Any]:
        """The attributes of a recipe of the library, by name; of a linear one without its table, and in a ``draft`` by its small one."""
        return of_readings(self.reading(recipe, draft=draft))

    def given_up(
        self, here: Mapping[str, Any], wishes: Wishes, like: Like
    ) -> dict[str, tuple[Any, Any]]:
        """What a recipe with the attributes ``here`` should have kept of what it is like, and did not: the values there and here."""
        own = self.reference(like, wishes).readings
        if own is None:
            return {}
        there, expected = of_readings(own), of_readings(in_colour(own, wishes))
        kept = [a for a in ATTRIBUTES.values() if a.group in wishes.held()]
        return {
            a.name: (there[a.name], here[a.name])
            for a in kept
            if all(changed(a, each[a.name], here[a.name]) for each in (there, expected))
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

    def reference(self, like: Like, wishes: Wishes, *, draft: bool = False) -> Reference:
        """What a recipe shall be like; without it, the material that is nearest to the wishes."""
        if like is None:
            return Reference(self.nearness.points[wishes.nearest(self.readings.values)])
        if isinstance(like, Recipe):
            readings = self.reading(like, draft=draft)
            return Reference(self.nearness.seen(self.looks.of(like), readings), readings)
        return Reference.of(like, self.library, self.readings, self.nearness)

    def out_of_reach(self, wishes: Wishes) -> str:
        """Which wish is at fault, by itself or beside the others; how far it goes, and what to do."""
        for alone in (True, False):
            for kind, name, target in wishes.each():
                others = wishes.without(kind, name)
                held = others.only(attribute(name).needs) if alone else others
                if told := self._too_far(kind, name, target, held):
                    return f"{told} Ask for that, or let another wish go; `halfway find --clamp` takes the nearest."
        return (
            f"no mix of {self.library.name} has {wishes}, and none with one of them less: "
            "let some go; `halfway find --clamp` takes the nearest."
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

    def reading(
        self, recipe: Recipe, *, draft: bool = False
    ) -> Float64[np.ndarray, "n_instruments 3"]:
        """What instruments read off a recipe; of a linear one without its table."""
        if recipe.pictures_mix:
            return self.readings.mix(recipe.dense(self.library.names), recipe.blend)
        return read_table(self.table(recipe, draft=draft))

    def table(self, recipe: Recipe, *, draft: bool) -> TabularBrdf:
        """The table of a recipe, or for a ``draft`` its small one."""
        return self.looks.tables.table(recipe) if draft else self.mixer.mix(recipe)

    def _as_recipe(self, like: Like) -> Like:
        """The recipe that a JSON file holds, where it is of the library; else what was given."""
        if not isinstance(like, str) or like in self.library.names or not is_recipe_file(like):
            return like
        library, recipe = open_recipe([like], library=self.library.address)
        return recipe if library.checksum == self.library.checksum else like

    def recipe(self, weights: Weights, blend: Blend) -> Recipe:
        """The recipe of weights over all materials, the same in every channel."""
        dense = np.broadcast_to(weights, (3, len(weights)))
        return Recipe.from_dense(LibraryRef.of(self.library), self.library.names, dense, blend)
