"""A BRDF under the name that a person gives it, with where it comes from; read or mixed when it is asked for."""

import re
from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ..brdf import Brdf, TabularBrdf, directional_albedo, tabulate
from ..errors import RecipeError
from ..halfdiff import Grid
from ..library import Library
from .mixing import Mixer
from .recipe import Recipe

ALBEDO_ANGLE = np.radians(20.0)
"""From the normal; of the albedo that says what colour a material has."""


class NamedBrdf(NamedTuple):
    """A material that can be rendered, checked or written; see `open_materials`."""

    label: str
    load: Callable[[], Brdf]
    """As its file has it, or mixed."""
    of: Any
    """What it is, as JSON, with what changes when it does: a library's checksum, a file's time."""
    stem: str
    """What a file about it is called, before the suffix."""
    library: Library | None = None
    recipe: Recipe | None = None

    @classmethod
    def mixed(cls, library: Library, recipe: Recipe, label: str = "mix") -> "NamedBrdf":
        """What a recipe of a library stands for; of one material alone, under that one's name."""
        label = recipe.material or label
        load = partial(Mixer(library).mix, recipe)
        return cls(label, load, made_of(library, recipe), label, library, recipe)

    def scaled(self, factor: float) -> "NamedBrdf":
        """The material with its values times a number.

        Raises
        ------
        RecipeError
            When the number is not positive.
        """
        if factor == 1:
            return self
        if not (factor > 0 and np.isfinite(factor)):
            raise RecipeError(f"a scale of {factor:g} is none: expected a positive number.")
        load, of = partial(_scaled, self.load, factor), {"scaled": factor, "of": self.of}
        return NamedBrdf(self.label, load, of, self.stem)

    def table(self, grid: Grid | None = None) -> TabularBrdf:
        """The material on a grid: this one, or its own, or the usual one where it has none."""
        brdf = self.load()
        if isinstance(brdf, TabularBrdf) and grid in (None, brdf.grid):
            return brdf
        return tabulate(brdf, grid or brdf.own_grid, name=self.label)

    def facts(self) -> dict[str, Any]:
        """What it is, for people and programs, as JSON."""
        brdf = self.load()
        return {
            "name": self.label,
            "is": brdf.about,
            "description": self.library.origin.description if self.library else "",
            "albedo_20_degrees": directional_albedo(
                brdf, ALBEDO_ANGLE, n_theta_h=90, n_phi_h=24
            ).tolist(),
        }


def _scaled(load: Callable[[], Brdf], factor: float) -> Brdf:
    return load().scaled(factor)


def made_of(library: Library, recipe: Recipe) -> Any:
    """A mix as JSON that changes when the mix does."""
    return {"library_checksum": library.checksum, **recipe.to_json(), "library": library.name}


def file_names(materials: Sequence[NamedBrdf], suffix: str) -> list[str]:
    """A file name for each material: ``gold-paint.png``; those that share a name are counted."""
    seen = Counter[str]()
    names: list[str] = []
    for material in materials:
        stem = file_stem(material.stem)
        seen[stem] += 1
        names.append(f"{stem}-{seen[stem]}{suffix}" if seen[stem] > 1 else f"{stem}{suffix}")
    return names


def file_stem(name: str) -> str:
    """A name as part of a file's, whatever is in it."""
    return re.sub(r"[^\w.+=-]+", "-", name).strip("-.") or "material"
