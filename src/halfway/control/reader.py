"""What is read of mixes: by instruments, and where it is asked for by people.

Instruments read of a linear mix what they read of its materials, mixed. Nothing else is as simple as that: not another blend, and not
how people perceive a mix, which is read off its table.
"""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32, Float64

from ..brdf import TabularBrdf
from ..instruments import Reader, Readings, read_table
from ..library import Library
from ..look import Looks
from ..people import Perception, read_library
from ..recipes import Blend, Mixer, Recipe
from ..tasks import HERE, Work
from .wishes import attribute

Reading = Float64[np.ndarray, "n_readings 3"]


@dataclass(frozen=True, eq=False)
class MixReader:
    """Reads mixes of a library."""

    values: Float64[np.ndarray, "N n_readings 3"]
    """What is read of its materials."""
    instruments: Readings
    looks: Looks
    mixer: Mixer
    perception: Perception | None = None
    """Of people, where they are asked."""

    def asking_people(self, library: Library, *, work: Work = HERE) -> "MixReader":
        """One that reads how people perceive mixes of ``library``, too."""
        values = read_library(self.instruments.values, library, work=work)
        perception = Perception.of(library, work=work)
        return MixReader(values, self.instruments, self.looks, self.mixer, perception)

    def is_linear(self, blend: Blend) -> bool:
        """Whether what is read of a mix is what is read of its materials, mixed."""
        return blend is Blend.LINEAR and self.perception is None

    def of(self, recipe: Recipe, *, draft: bool = False) -> Reading:
        """What is read of a recipe; for a ``draft`` of its small table, where a table is needed at all."""
        if recipe.pictures_mix and self.perception is None:
            return self._mixed(recipe)
        table = self.table(recipe, draft=draft)
        read = self._mixed(recipe) if recipe.pictures_mix else read_table(table)
        return read if self.perception is None else self.perception.read(read, table)

    def table(self, recipe: Recipe, *, draft: bool) -> TabularBrdf:
        """The table of a recipe, or for a ``draft`` its small one."""
        return self.looks.tables.table(recipe) if draft else self.mixer.mix(recipe)

    def _mixed(self, recipe: Recipe) -> Reading:
        return self.instruments.mix(recipe.dense(self.instruments.names), recipe.blend)


class SmallReader:
    """Reads small tables for some attributes: instruments some columns of them, people all."""

    def __init__(self, names: Collection[str], reader: MixReader) -> None:
        tables, self._perception = reader.looks.tables, reader.perception
        whole = self._perception is not None
        instruments = {each for name in names for each in attribute(name).instruments}
        self._instruments = Reader.of(instruments, tables.grid, whole=whole)
        self.mixes = tables if whole else tables.on(self._instruments.columns)
        """Of what is read."""

    def read(self, values: Float32[np.ndarray, "*k 3 p"]) -> Float64[np.ndarray, "*k n_readings 3"]:
        """The readings of such tables; NaN of other instruments."""
        readings = self._instruments.read(values)
        if self._perception is None:
            return readings
        *many, _, _ = values.shape
        grid = self.mixes.grid
        tables = (TabularBrdf(each, grid) for each in values.reshape(-1, 3, *grid.shape))
        each = zip(readings.reshape(-1, *readings.shape[-2:]), tables, strict=True)
        read = np.stack([self._perception.read(*one) for one in each])
        return read.reshape(*many, *read.shape[-2:])
