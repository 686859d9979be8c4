"""Which materials a method may learn from, and which it is judged by.

liu2023         80 and 20 of the MERL database, as Liu et al. 2023 split them
kind            what is alike is left out together: fabrics, paints, woods, metals ...
leave-one-out   every material by all others
"""

from collections.abc import Callable, Mapping, Sequence
from importlib.resources import files
from typing import NamedTuple

from ..errors import HalfwayError

KINDS: Mapping[str, tuple[str, ...]] = {
    "fabric": ("fabric", "felt"),
    "metallic paint": ("metallic-paint", "silver-paint", "gold-paint", "color-changing-paint"),
    "paint": ("paint", "latex", "two-layer"),
    "phenolic": ("phenolic",),
    "plastic": ("plastic", "acrylic", "delrin", "nylon", "polyethylene", "pvc", "teflon"),
    "rubber": ("rubber", "foam"),
    "wood": ("cherry", "fruitwood", "maple", "oak", "pine", "walnut", "natural-209"),
    "metal": ("alum", "brass", "chrome", "nickel", "steel", "ss440", "tungsten"),
}
"""By what the names of the MERL database hold; the first that fits."""
OTHER = "stone and other"


class Fold(NamedTuple):
    """One run of a method."""

    train: tuple[str, ...]
    test: tuple[str, ...]


class Split(NamedTuple):
    """Folds over which scores are the mean, each material of a test once."""

    name: str
    folds: tuple[Fold, ...]

    @property
    def test(self) -> tuple[str, ...]:
        """All materials that are judged."""
        return tuple(name for fold in self.folds for name in fold.test)


def split(name: str, materials: Sequence[str]) -> Split:
    """A split of ``materials`` by its name, one of `SPLITS`.

    Raises
    ------
    HalfwayError
        When there is no such split, or the materials are not those that it splits.
    """
    if name not in SPLITS:
        raise HalfwayError(f"there is no split {name!r}: expected one of {', '.join(SPLITS)}.")
    tests = SPLITS[name](materials)
    return Split(name, tuple(Fold(_but(materials, test), tuple(test)) for test in tests))


def kind_of(name: str) -> str:
    """What kind of material a name of the MERL database says."""
    fits = (kind for kind, words in KINDS.items() if any(word in name for word in words))
    return next(fits, OTHER)


def _liu2023(materials: Sequence[str]) -> list[list[str]]:
    text = files("halfway.yardstick").joinpath("data", "liu2023_test.txt").read_text("utf-8")
    test = [line for line in text.splitlines() if not line.startswith("#")]
    missing = [name for name in test if name not in materials]
    if missing:
        raise HalfwayError(
            f"{len(missing)} of the {len(test)} test materials of liu2023 are not in the library, {missing[0]} among them: "
            "expected the MERL materials by their names. Take --split leave-one-out."
        )
    return [test]


def _kinds(materials: Sequence[str]) -> list[list[str]]:
    kinds = [kind_of(name) for name in materials]
    tests = [
        [name for name, kind in zip(materials, kinds, strict=True) if kind == each]
        for each in dict.fromkeys(kinds)
    ]
    if len(tests) < 2:
        raise HalfwayError(
            f"the names of all {len(materials)} materials say the kind {kinds[0]!r}: expected the MERL materials by their names. "
            "Take --split leave-one-out."
        )
    return tests


def _each(materials: Sequence[str]) -> list[list[str]]:
    return [[name] for name in materials]


def _but(materials: Sequence[str], test: Sequence[str]) -> tuple[str, ...]:
    return tuple(name for name in materials if name not in test)


SPLITS: Mapping[str, Callable[[Sequence[str]], list[list[str]]]] = {
    "liu2023": _liu2023,
    "kind": _kinds,
    "leave-one-out": _each,
}
