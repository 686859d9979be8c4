"""Recipes: a blend, and barycentric weights over the materials of a library.

A material is its recipe: some hundred bytes. Tables and pictures are made from it on demand. As JSON,

    {"library": "builtin:merl-abc", "weights": {"gold-paint": 0.7, "teflon": 0.3}}
    {"library": "builtin:merl-abc", "weights": {"r": {...}, "g": {...}, "b": {...}}}

the second form where the channels differ. Every weight is positive and each channel sums to 1. ``"blend"`` says how they
are mixed, where it is not linear, and ``"body_scale": [R, G, B]`` what the body of the mix is then multiplied by; ``"library_address"`` and ``"library_checksum"`` may say which library it is.
"""

import re
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import Float64

from ..errors import RecipeError
from ..library import Library, LibraryRef
from .blend import Blend
from .body import UNSCALED, BodyScale

CHANNELS: tuple[str, str, str] = ("r", "g", "b")
SUM_TOLERANCE = 1e-6
"""How far a channel's written weights may sum from 1; they are then scaled to sum to 1 exactly."""
_WEIGHT = re.compile(
    r"\s*=\s*([-+]?(?:\d+\.?\d*(?:e[-+]?\d+)?|\.\d+(?:e[-+]?\d+)?|nan|inf))\s*(?:,[,\s]*|$)",
    re.IGNORECASE,
)


@dataclass(frozen=True, eq=False)
class Recipe:
    """Weights over some materials of a library, per channel, and how they are mixed.

    Parameters
    ----------
    library : LibraryRef
        The library whose materials they are.
    names : tuple of str
        The n materials that carry weight in any channel.
    weights : float64 array, shape (3, n)
        Non-negative; each row sums to 1.
    blend : Blend
        How the weighted materials become one.
    body_scale : tuple of float
        What the body of that is multiplied by, in each channel; its highlight stays (`halfway.recipes.body`).

    Examples
    --------
    >>> from halfway import Recipe
    >>> recipe = Recipe.from_text("builtin:merl-abc", "gold-paint=0.7, teflon=0.3")
    >>> recipe.to_json()["weights"]
    {'gold-paint': 0.7, 'teflon': 0.3}
    """

    library: LibraryRef
    names: tuple[str, ...]
    weights: Float64[np.ndarray, "3 n"]
    blend: Blend = Blend.LINEAR
    body_scale: BodyScale = UNSCALED

    def __post_init__(self) -> None:
        self.weights.flags.writeable = False

    def __repr__(self) -> str:
        return f"Recipe({self.library.name!r}, {self.to_json()['weights']})"

    @classmethod
    def of(
        cls,
        library: str | LibraryRef | Library,
        weights: Mapping[str, Any],
        blend: Blend | str = Blend.LINEAR,
    ) -> "Recipe":
        """The recipe with these weights: one map for all channels, or one under each of "r", "g", "b".

        Raises
        ------
        RecipeError
            When a weight is negative or no number, a channel does not sum to 1, or there is no such blend.
        """
        per_channel = (
            [weights[c] for c in CHANNELS] if set(weights) == set(CHANNELS) else [weights] * 3
        )
        names = tuple(dict.fromkeys(name for channel in per_channel for name in channel))
        checked = [
            _checked(channel, f"channel {c}")
            for c, channel in zip(CHANNELS, per_channel, strict=True)
        ]
        rows = np.array([[channel.get(name, 0.0) for name in names] for channel in checked])
        return cls(LibraryRef.of(library), names, rows, Blend(blend))

    @classmethod
    def from_dense(
        cls,
        library: str | LibraryRef | Library,
        names: Sequence[str],
        weights: Float64[np.ndarray, "3 N"],
        blend: Blend = Blend.LINEAR,
    ) -> "Recipe":
        """The recipe of weights over all ``names``, keeping those that carry any."""
        kept = np.flatnonzero(weights.any(axis=0))
        return cls(
            LibraryRef.of(library), tuple(names[int(i)] for i in kept), weights[:, kept], blend
        )

    @classmethod
    def from_text(cls, library: str | LibraryRef | Library, text: str) -> "Recipe":
        """The recipe written as ``"gold-paint=0.7, teflon=0.3"``, or in parts of a hundred.

        A name may hold ``=`` and ``,`` itself: it goes as far as the next weight, or is the longest of the library's that fits.

        Raises
        ------
        RecipeError
            As `of`; and when a name has no weight, or two.
        """
        names = library.names if isinstance(library, Library) else ()
        weights: dict[str, float] = {}
        rest = text.strip(" ,")
        while rest or not weights:
            name, number, rest = _first_part(rest, names)
            if name in weights:
                raise RecipeError(f"{name} is given twice in {text!r}: write each material once.")
            weights[name] = number
        return cls.of(library, _of_one(weights))

    @classmethod
    def from_json(cls, document: Any, *, library: str | LibraryRef | Library = "") -> "Recipe":
        """The recipe in a JSON document; ``library`` stands in where the document names none."""
        try:
            recipe = cls.of(
                _library_in(document) or library,
                document["weights"],
                document.get("blend", Blend.LINEAR),
            )
            return replace(recipe, body_scale=_scale_in(document))
        except (KeyError, TypeError, AttributeError):
            raise RecipeError(
                'this JSON is no recipe: expected {"library": NAME, "weights": {MATERIAL: WEIGHT, ...}}.'
            ) from None

    def to_json(self) -> dict[str, Any]:
        """The JSON document; one map of weights where the channels are the same."""
        channels = [
            {name: w for name, w in zip(self.names, row, strict=True) if w > 0}
            for row in self.weights.tolist()
        ]
        same = channels[0] == channels[1] == channels[2]
        weights = channels[0] if same else dict(zip(CHANNELS, channels, strict=True))
        blend = {} if self.blend is Blend.LINEAR else {"blend": str(self.blend)}
        scale = {"body_scale": list(self.body_scale)} if self.is_recoloured else {}
        return {"library": self.library.name, **blend, "weights": weights, **scale}

    def unscaled(self) -> "Recipe":
        """The same mix with its own body."""
        return replace(self, body_scale=UNSCALED)

    @property
    def is_recoloured(self) -> bool:
        """Whether its body is another than that of the mix."""
        return self.body_scale != UNSCALED

    @property
    def material(self) -> str | None:
        """The material of the library that it is; None where it is another one."""
        return self.names[0] if len(self.names) == 1 and not self.is_recoloured else None

    @property
    def pictures_mix(self) -> bool:
        """Whether it is linear in the tables, so that pictures of it in direct light are those of its materials, mixed."""
        return self.blend is Blend.LINEAR and not self.is_recoloured

    def dense(self, names: Sequence[str]) -> Float64[np.ndarray, "3 N"]:
        """The weights over ``names``, which are all materials of the library.

        Raises
        ------
        RecipeError
            When it is of a material that is not among them.
        """
        positions = {name: i for i, name in enumerate(names)}
        if missing := [name for name in self.names if name not in positions]:
            raise RecipeError(f"{self.library.name} has no material called {missing[0]!r}.")
        weights = np.zeros((3, len(names)))
        weights[:, [positions[name] for name in self.names]] = self.weights
        return weights


def _first_part(text: str, names: Sequence[str]) -> tuple[str, float, str]:
    """The first name of a text of ``NAME=WEIGHT, ...``, its weight, and the rest."""
    known = sorted((len(name) for name in names if text.startswith(name)), reverse=True)
    others = (weight.start() for weight in _WEIGHT.finditer(text))
    for end in (*known, *(end for end in others if not names or "," not in text[:end])):
        if weight := _WEIGHT.match(text, end):
            return text[:end].strip(), float(weight[1]), text[weight.end() :]
    part = text.partition(",")[0].strip()
    name, equals, number = (piece.strip() for piece in part.rpartition("="))
    if equals:
        raise RecipeError(f"the weight of {name}, {number!r}, is no number: expected such as 0.7.")
    raise RecipeError(
        f'{part!r} has no weight: expected NAME=WEIGHT, such as "gold-paint=0.7, teflon=0.3". '
        "A recipe in a JSON file takes any name."
    )


def _of_one(weights: Mapping[str, float]) -> Mapping[str, float]:
    """Weights that sum to 1 instead of 100; others as they are."""
    if not abs(sum(weights.values()) / 100 - 1) <= SUM_TOLERANCE:
        return weights
    warnings.warn("the weights sum to 100: they are taken as parts of a hundred.", stacklevel=3)
    return {name: weight / 100 for name, weight in weights.items()}


def _library_in(document: Mapping[str, Any]) -> LibraryRef | None:
    name = document.get("library")
    if not name:
        return None
    address, checksum = document.get("library_address"), document.get("library_checksum")
    return LibraryRef(str(name), str(address or ""), str(checksum or ""))


def _scale_in(document: Mapping[str, Any]) -> BodyScale:
    written = document.get("body_scale")
    if written is None:
        return UNSCALED
    match written:
        case [int() | float() as r, int() | float() as g, int() | float() as b] if all(
            0 <= x < np.inf for x in (r, g, b)
        ):
            return float(r), float(g), float(b)
        case _:
            raise RecipeError(
                f"the body scale is {written!r}: expected three numbers, one of each channel, none negative."
            )


def _checked(weights: Mapping[str, Any], where: str) -> dict[str, float]:
    for name, weight in weights.items():
        if isinstance(weight, bool) or not isinstance(weight, int | float) or not weight >= 0:
            raise RecipeError(
                f"the weight of {name} in {where} is {weight!r}: a recipe takes numbers that are not negative."
            )
    total = sum(weights.values())
    if not abs(total - 1) <= SUM_TOLERANCE:
        raise RecipeError(
            f"the weights in {where} sum to {total:.6g}: they must sum to 1. Divide each by {total:.6g}."
        )
    return {name: float(weight) / total for name, weight in weights.items()}
