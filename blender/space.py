"""A ``.brdfspace`` file as a library in memory, and the recipes along a route through its stops.

What the file holds: `halfway.export.blender` writes it.
"""

import io
import json
import zipfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from .halfway.brdf import TabularBrdf
from .halfway.errors import FormatError
from .halfway.halfdiff import Grid
from .halfway.library import Library, LibraryRef
from .halfway.origin import Origin
from .halfway.recipes import Blend, Mixer, Recipe

SUFFIX = ".brdfspace"
FORMAT = 1


class SpaceFile(Library):
    """The materials of a file, and the ways between its stops."""

    def __init__(self, path: str | Path) -> None:
        try:
            with zipfile.ZipFile(path) as file:
                self.document = json.loads(file.read("space.json"))
                members = {name: file.read(name) for name in file.namelist() if "/" in name}
        except (zipfile.BadZipFile, KeyError, ValueError):
            raise FormatError(
                f"{Path(path).name} holds no materials for Blender: expected what `halfway export --for blender` writes."
            ) from None
        if self.document.get("format") != FORMAT:
            raise FormatError(
                f"{Path(path).name} is of format {self.document.get('format')}: expected {FORMAT}. "
                "Export it anew, or update the extension."
            )
        about = self.document["library"]
        self.name, self.checksum = about["name"], about["checksum"]
        self.origin = Origin(about["description"], about["source"], about["licence"])
        self.grid = Grid.merl(*self.document["grid"])
        self.names = tuple(each["name"] for each in self.document["materials"])
        self.material_checksums = self.names
        self.stops = tuple(self.document["stops"])
        self.blend = Blend(self.document["blend"])
        self.ways = {(way["from"], way["to"]): way for way in self.document["ways"]}
        self.pictures = {n: members[f"pictures/{i:03}.png"] for i, n in enumerate(self.names)}
        self._mixer = Mixer(self, compiles=False)
        self._tables = {n: members[f"tables/{i:03}.npy"] for i, n in enumerate(self.names)}

    def row(self, i: int) -> np.ndarray:
        facts = self.document["materials"][i]
        values = np.load(io.BytesIO(self._tables[facts["name"]])).astype(np.float32)
        return values.reshape(3, -1) * np.float32(facts["scale"])

    def blocks(self) -> list[slice]:
        return [slice(0, self.grid.size)]

    def columns(self, columns: slice) -> np.ndarray:
        return np.stack([self.row(i)[:, columns] for i in range(len(self))], axis=1)

    def fit(self, name: str) -> dict:
        """The inputs of Blender's Principled BSDF fitted to one material."""
        return self.document["materials"][self.index(name)]["fit"]["parameters"]

    def weights(self, stops: Sequence[str], t: float) -> dict[str, float]:
        """The weights at t in [0, 1] on the route through ``stops``, each leg an equal share of t."""
        if len(stops) == 1:
            return {stops[0]: 1.0}
        n_legs = len(stops) - 1
        leg = min(int(t * n_legs), n_legs - 1)
        start, stop, t = stops[leg], stops[leg + 1], t * n_legs - leg
        if (start, stop) not in self.ways:
            start, stop, t = stop, start, 1 - t
        if start == stop:
            return {start: 1.0}
        way = self.ways[start, stop]
        names = sorted({name for weights in way["weights"] for name in weights})
        values = {
            name: np.interp(t, way["knots"], [w.get(name, 0.0) for w in way["weights"]])
            for name in names
        }
        return {name: float(value) for name, value in values.items() if value > 0}

    def mix(self, weights: dict[str, float]) -> TabularBrdf:
        """The table of some weights."""
        recipe = Recipe.of(LibraryRef.of(self), weights, self.blend)
        return self._mixer.mix(recipe)
