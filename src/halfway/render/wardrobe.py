"""What objects wear: tables as they are, or, without a compiler for them, RGL files that stand for them.

A plugin of Mitsuba's, given as its dict, is worn as it is.

Imported only after `halfway.render.variant.load_mitsuba` has chosen a variant.
"""

from abc import ABC, abstractmethod
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import mitsuba as mi

from ..brdf import TabularBrdf
from ..formats import write_rgl
from ..halfdiff import Grid
from .scenes import Material


class Wardrobe(ABC):
    """The BSDFs of a scene's materials."""

    def __init__(self, turn_degrees: float = 0.0) -> None:
        self.bsdfs: list[Any] = []
        self.turn_degrees = turn_degrees
        """Of anisotropic tables against the tangent."""

    @abstractmethod
    def change(self, materials: list[Material]) -> bool:
        """Wear these; whether the BSDFs are other objects than before, so that a scene must be loaded anew."""


class Tables(Wardrobe):
    """Exact tables. A new table of the same grid goes into the old BSDF: nothing is compiled again."""

    def __init__(self, turn_degrees: float = 0.0) -> None:
        super().__init__(turn_degrees)
        self._grids: list[Grid] = []
        """Of the tables; empty while a plugin is among the materials."""

    def change(self, materials: list[Material]) -> bool:
        from . import bsdf

        tables = [material for material in materials if isinstance(material, TabularBrdf)]
        grids = [table.grid for table in tables] if len(tables) == len(materials) else []
        if not grids or grids != self._grids:
            props = mi.Properties()
            props["turn"] = self.turn_degrees
            self.bsdfs = [
                bsdf.TableBsdf(props, material)
                if isinstance(material, TabularBrdf)
                else mi.load_dict(dict(material))
                for material in materials
            ]
            self._grids = grids
            return True
        for worn, table in zip(self.bsdfs, tables, strict=True):
            parameters = mi.traverse(worn)
            parameters["table"] = bsdf.pack(table)
            parameters.update()
        return False


class Files(Wardrobe):
    """RGL files for Mitsuba's own ``measured``, which needs no compiler: within some 50 dB of the table."""

    def change(self, materials: list[Material]) -> bool:
        with TemporaryDirectory(prefix="halfway-") as folder:
            self.bsdfs = [
                self._worn(material, Path(folder) / f"{i}.bsdf")
                for i, material in enumerate(materials)
            ]
        return True

    def _worn(self, material: Material, path: Path) -> Any:
        if not isinstance(material, TabularBrdf):
            return mi.load_dict(dict(material))
        write_rgl(path, material)
        return mi.load_dict({"type": "measured", "filename": str(path)})
