"""Wishes: which attributes a recipe shall have, exactly, at most or at least."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from jaxtyping import Float64

from ..errors import ControlError
from ..instruments import ATTRIBUTES, Attribute, Condition
from ..instruments import attribute as among
from ..people import QUALITIES
from .programme import Goals

Values = Float64[np.ndarray, "N n_readings 3"]
"""Readings of N materials."""
WISHED: Mapping[str, Attribute] = {**ATTRIBUTES, **QUALITIES}
"""What can be wished for: what instruments read, and what people perceive."""
attribute = partial(among, among=WISHED)
SIGNS = {"exact": "=", "at_most": "at most", "at_least": "at least"}


@dataclass(frozen=True)
class Wishes:
    """Targets by the name of the attribute, as its `Attribute.parsed` gives them."""

    exact: Mapping[str, Any] = field(default_factory=dict)
    at_most: Mapping[str, Any] = field(default_factory=dict)
    at_least: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        exact: Mapping[str, Any] | None = None,
        at_most: Mapping[str, Any] | None = None,
        at_least: Mapping[str, Any] | None = None,
    ) -> "Wishes":
        """The wishes that a person writes.

        Raises
        ------
        ControlError
            When there is no such attribute, a target is none of its values, or it cannot be asked for like this.
        """
        exact, at_most, at_least = (
            {name: attribute(name).parsed(target) for name, target in (each or {}).items()}
            for each in (exact, at_most, at_least)
        )
        wishes = cls(exact, at_most, at_least)
        for kind, name, _ in wishes.each():
            wishes.require(attribute(name), bound=kind != "exact")
        return wishes

    def each(self) -> Iterator[tuple[str, str, Any]]:
        """Kind, name and target of every wish."""
        for kind in SIGNS:
            for name, target in getattr(self, kind).items():
                yield kind, name, target

    @property
    def names(self) -> set[str]:
        """Of the attributes that are wished for."""
        return {name for _, name, _ in self.each()}

    def without(self, kind: str, name: str) -> "Wishes":
        """The others."""
        rest = {
            k: {n: t for n, t in getattr(self, k).items() if (k, n) != (kind, name)} for k in SIGNS
        }
        return Wishes(**rest)

    def held(self) -> list[str]:
        """The groups of `Attribute.group` of which nothing is asked for."""
        asked = [attribute(name).group for _, name, _ in self.each()]
        return [group for group in ("reflections", "colour") if group not in asked]

    def only(self, name: str) -> "Wishes":
        """The exact one called ``name``, if there is one."""
        return Wishes({n: t for n, t in self.exact.items() if n == name})

    def nearest(self, readings: Values) -> int:
        """The material with the least sum of what it misses, each as a share of the most that any does."""
        goals = self.goals(readings, missed=1.0)
        missed = goals.above @ np.maximum(goals.rows, 0) + goals.below @ np.maximum(-goals.rows, 0)
        return int(np.nan_to_num(missed, nan=np.inf).argmin())

    def missed(self, readings: Float64[np.ndarray, "n_readings 3"]) -> float:
        """By how much a material misses the worst of them, where `Attribute.close` is 1."""
        worst = 0.0
        for kind, name, target in self.each():
            wanted = attribute(name)
            above = np.nan_to_num(wanted.of(readings) - target, nan=np.inf)
            by = {"exact": np.abs(above), "at_most": above, "at_least": -above}[kind]
            worst = max(worst, float(np.max(by)) / wanted.close)
        return worst

    def missing(self, has: Mapping[str, Any]) -> list[str]:
        """The names of the exact numbers that are not what a material has, nearly enough."""
        wanted = [attribute(name) for name in self.exact if attribute(name).is_number]
        return [a.name for a in wanted if not abs(has[a.name] - self.exact[a.name]) <= a.close]

    def goals(self, readings: Values, *, missed: float = np.inf) -> Goals:
        """The goals for materials with these readings.

        ``missed`` is what it costs to miss one by the most that any material does.
        """
        rows, above, below = [np.zeros((0, len(readings)))], [], []
        for kind, name, target in self.each():
            for condition in attribute(name).conditions(target, self.exact):
                rows.append(_scaled(row_of(condition, readings))[None])
                above.append(0.0 if kind == "at_least" else missed)
                below.append(0.0 if kind == "at_most" else missed)
        return Goals(np.concatenate(rows), np.array(above), np.array(below))

    def require(self, wanted: Attribute, *, bound: bool) -> None:
        """Refuse an attribute that these wishes do not make linear, or that is no single number where one is needed.

        Raises
        ------
        ControlError
            When it is so.
        """
        if wanted.needs and wanted.needs not in self.exact:
            raise ControlError(
                f"{wanted.name} alone is no straight condition on a mix: expected {wanted.needs} beside it. "
                f"Set {wanted.needs} too, or ask for the body colour."
            )
        if bound and not wanted.is_number:
            raise ControlError(
                f"{wanted.name} is a colour, which has no least and no most: set it."
            )

    def __str__(self) -> str:
        return " and ".join(
            f"{name} {SIGNS[kind]} {attribute(name).written(target)}"
            for kind, name, target in self.each()
        )


def row_of(condition: Condition, readings: Values) -> np.ndarray:
    """The condition on a mix of materials with these readings, as a sum over its weights that is to be 0, or less."""
    # What is not asked about may be NaN.
    asked = np.flatnonzero(condition.coefficients.any(axis=1))
    products = np.einsum("nfc,fc->n", readings[:, asked], condition.coefficients[asked])
    return products - condition.constant  # the weights sum to 1


def _scaled(row: np.ndarray) -> np.ndarray:
    return row / max(np.nanmax(np.abs(row), initial=0.0), 1e-300)
