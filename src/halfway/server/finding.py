"""Recipes by their attributes, as the page's sliders ask for them."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..brdf import TabularBrdf
from ..colour import Rgb, ciede2000, to_hex, to_lab
from ..control import Control, Wishes
from ..instruments import ATTRIBUTES, Attribute, attribute
from ..people import QUALITIES, Perception
from ..recipes import Recipe
from .schema import (
    AttributesView,
    AttributeView,
    FoundView,
    GivenUp,
    PerceivedView,
    PerceptionView,
    RecipeDocument,
    Wanted,
)

_NUMBERS = [each for each in ATTRIBUTES.values() if each.is_number]
_ASKED = [*(each.name for each in _NUMBERS), *QUALITIES]


def attributes_view(control: Control) -> AttributesView:
    """The attributes that are one number, of all materials."""
    return AttributesView(attributes=[_view(each, control) for each in _NUMBERS])


def _view(wanted: Attribute, control: Control) -> AttributeView:
    return AttributeView(
        name=wanted.name,
        label=wanted.label,
        unit=wanted.unit,
        needs=wanted.needs,
        values=[_or_none(value) for value in np.asarray(wanted.of(control.readings.values))],
    )


def found_view(control: Control, like: Recipe, wanted: Wanted) -> FoundView:
    """The recipe that misses least of what is wanted; without any wishes the one that it shall be like."""
    wishes = Wishes.of(wanted.set)
    recipe = _found(control, wishes, like, wanted) if wanted.set else like
    has = control.attributes(recipe, draft=wanted.draft, also=wishes.names)
    lost = {} if wanted.draft else control.given_up(has, wishes, like)
    return FoundView(
        recipe=RecipeDocument.model_validate(recipe.to_json()),
        attributes={name: _or_none(has[name]) for name in _ASKED if name in has},
        missed=[] if wanted.draft else wishes.missing(has),
        body=to_hex(has["body"]),
        difference=_difference(wishes.exact.get("body"), has["body"]),
        given_up=[_given_up(name, *values) for name, values in lost.items()],
        # Beside what people perceive a range takes seconds.
        ranges={} if wishes.names & set(QUALITIES) else _ranges(control, wanted, has),
    )


def _found(control: Control, wishes: Wishes, like: Recipe, wanted: Wanted) -> Recipe:
    return control.find(
        wishes, like=like, blend=like.blend, clamp=True, draft=wanted.draft, release=wanted.release
    )


def _difference(asked: Rgb | None, has: Rgb) -> float | None:
    return None if asked is None else float(ciede2000(to_lab(asked), to_lab(has)))


def _given_up(name: str, was: Any, now: Any) -> GivenUp:
    written = attribute(name).written
    return GivenUp(name=name, was=written(was), now=written(now))


def perception_view(perception: Perception, table: TabularBrdf) -> PerceptionView:
    """How people would perceive a material."""
    each = perception.perceived(table).items()
    return PerceptionView(
        perceived=[PerceivedView(name=name, value=one.value, trust=one.trust) for name, one in each]
    )


def _ranges(
    control: Control, wanted: Wanted, has: Mapping[str, Any]
) -> dict[str, tuple[float, float]]:
    ends = {name: control.reach(name, _beside(name, wanted.set, has)) for name in wanted.ranges}
    return {
        name: (each.low, each.high)
        for name, each in ends.items()
        if each and all(map(math.isfinite, each))
    }


def _beside(name: str, asked: Mapping[str, Any], has: Mapping[str, Any]) -> Wishes:
    """What is held while one of the attributes goes as far as it can."""
    held = {other: value for other, value in asked.items() if other != name}
    # a* and b* are read beside the lightness that there is; where that goes, they are free.
    if needs := attribute(name).needs:
        held.setdefault(needs, has[needs])
    return Wishes.of({each: v for each, v in held.items() if attribute(each).needs in ("", *held)})


def _or_none(value: float) -> float | None:
    return None if math.isnan(value) else float(value)
