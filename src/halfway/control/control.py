"""What is known of a library to find recipes with, and the finding.

The weights are one row for all channels, so that what is linear in the table is linear in them.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np

from ..errors import OutOfReachError
from ..instruments import ATTRIBUTES, Attribute, Readings, of_readings
from ..library import Library, LibraryRef, open_library
from ..look import PACING_SCENE, Looks, SphereScene
from ..people import QUALITIES, Perceived
from ..recipes import Blend, Mixer, Recipe, is_recipe_file, open_recipe
from ..tasks import HERE, Work
from .nearness import Nearness
from .newton import Linearised
from .programme import Goals, Weights, solve
from .ranges import Range, Walk
from .reader import MixReader
from .recolour import changed, in_colour
from .reference import Like, Reference
from .search import Search
from .wishes import SIGNS, Wishes, attribute


@dataclass(frozen=True, eq=False)
class Control:
    """What is known of a library to find recipes with."""

    library: Library
    readings: Readings
    looks: Looks
    nearness: Nearness
    mixer: Mixer
    work: Work = HERE

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
        return cls(
            opened, readings, looks, Nearness.of(looks, readings), mixer or Mixer(opened), work
        )

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
        search = self._search(wishes, like=like, blend=blend, few=few, draft=draft)
        recipe = search.best(wishes, release, clamp=clamp)
        if recipe is None:
            raise OutOfReachError(self.out_of_reach(wishes))
        return recipe

    def reach(self, name: str, wishes: Wishes) -> Range | None:
        """From the least to the most of an attribute where ``wishes`` hold; None where no mix has those.

        Among linear mixes; in what people perceive, or beside it, as far as a walk among them got.
        """
        wanted = attribute(name)
        wishes.require(wanted, bound=True)
        mixes = self.mixes(wishes, also=[name])
        start = self._start(wishes, mixes)
        return None if start is None else Walk(wanted, wishes, mixes).range(start)

    def attributes(
        self, recipe: Recipe, *, draft: bool = False, also: Collection[str] = ()
    ) -> dict[str, Any]:
        """The attributes of a recipe of the library, by name; of a linear one without its table, and in a ``draft`` by its small one.

        So are perceived qualities among those that are asked for ``also``.
        """
        read = self.reader(also).of(recipe, draft=draft)
        perceived = {n: float(each.of(read)) for n, each in QUALITIES.items() if n in also}
        return {**of_readings(read), **perceived}

    def perceived(self, recipe: Recipe) -> dict[str, Perceived]:
        """How people would perceive a recipe of the library, by name."""
        perception = self._asking_people.perception
        return perception.perceived(self.mixer.mix(recipe)) if perception else {}

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

    def _start(self, wishes: Wishes, mixes: Linearised) -> Weights | None:
        """Some mix that has what is wished for."""
        if mixes.is_linear:
            return solve(np.zeros(len(self.library)), wishes.goals(mixes.values))
        recipe, missed = self._search(wishes).mix(wishes)
        return recipe.dense(self.library.names)[0] if recipe and missed <= 1 else None

    def reference(self, like: Like, wishes: Wishes, *, draft: bool = False) -> Reference:
        """What a recipe shall be like; without it, the material that is nearest to the wishes."""
        if like is None:
            return Reference(self.nearness.points[wishes.nearest(self.reader(wishes.names).values)])
        if isinstance(like, Recipe):
            readings = self._reader.of(like, draft=draft)
            return Reference(self.nearness.seen(self.looks.of(like), readings), readings)
        return Reference.of(like, self.library, self.readings, self.nearness)

    def out_of_reach(self, wishes: Wishes) -> str:
        """Which wish is at fault, by itself or beside the others; how far it goes, and what to do."""
        for alone in (True, False):
            for kind, name, target in wishes.each():
                others = wishes.without(kind, name)
                held = others.only(attribute(name).needs) if alone else others
                if message := self._too_far(kind, name, target, held):
                    return f"{message} Ask for that, or let another wish go; `halfway find --clamp` takes the nearest."
        message = f"no mix of {self.library.name} has {wishes}, and none with one of them less"
        if not self.mixes(wishes).is_linear:
            message = f"no mix of {self.library.name} was found that has {wishes}"
        return f"{message}: let some go; `halfway find --clamp` takes the nearest."

    def _too_far(self, kind: str, name: str, target: Any, held: Wishes) -> str | None:
        """What to say of a wish that no mix has where the others hold; None where one does, or none has the others."""
        wanted = attribute(name)
        beside = f" where {held}" if list(held.each()) else ""
        message = f"no mix of {self.library.name} has {name} {SIGNS[kind]} {wanted.written(target)}{beside}"
        if not wanted.is_number:
            return self._nearest_colour(wanted, target, held, message)
        ends = self.reach(name, held)
        too_low = kind != "at_least" and ends is not None and target < ends.low
        too_high = kind != "at_most" and ends is not None and target > ends.high
        if ends is None or not (too_low or too_high):
            return None
        goes = "it goes" if self.mixes(held, also=[name]).is_linear else "it was found"
        return f"{message}: {goes} from {wanted.written(ends.low)} to {wanted.written(ends.high)} there."

    def _nearest_colour(
        self, wanted: Attribute, target: Any, held: Wishes, message: str
    ) -> str | None:
        values, nothing = self.reader(held.names).values, np.zeros(len(self.library))
        colour = Wishes({wanted.name: target})
        hard = held.goals(values)
        weights = solve(nothing, Goals.join([hard, colour.goals(values, missed=1.0)]))
        if weights is None or solve(nothing, Goals.join([hard, colour.goals(values)])) is not None:
            return None
        return f"{message}: the nearest is {wanted.written(weights @ wanted.of(values))}."

    def _search(
        self,
        wishes: Wishes,
        *,
        like: Like = None,
        blend: Blend = Blend.LINEAR,
        few: bool = False,
        draft: bool = False,
    ) -> Search:
        like = self._as_recipe(like)
        reference = self.reference(like, wishes, draft=draft)
        return Search(
            control=self, like=like, reference=reference, blend=blend, few=few, draft=draft
        )

    def mixes(
        self, wishes: Wishes, blend: Blend = Blend.LINEAR, *, also: Collection[str] = ()
    ) -> Linearised:
        """Mixes by a blend, of which is read what is wished for, and these attributes."""
        reader = self.reader({*wishes.names, *also})
        return Linearised(wishes, partial(self.recipe, blend=blend), reader, blend, also=also)

    def reader(self, names: Collection[str] = ()) -> MixReader:
        """What reads these attributes."""
        return self._asking_people if set(names) & set(QUALITIES) else self._reader

    @cached_property
    def _reader(self) -> MixReader:
        return MixReader(self.readings.values, self.readings, self.looks, self.mixer)

    @cached_property
    def _asking_people(self) -> MixReader:
        return self._reader.asking_people(self.library, work=self.work)

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
