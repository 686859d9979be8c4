"""A library whose materials come in all six orders of their colour channels: as many hues of one reflectance.

    gold-paint          as it is
    gold-paint.gbr      its red is the green of gold-paint, its green the blue, its blue the red

Whatever holds for a material holds for these, but that they were measured.
"""

import hashlib
from dataclasses import replace
from itertools import permutations
from typing import ClassVar

import numpy as np

from .._types import Rows, Table
from ..locations import PERMUTED_PREFIX
from .library import Library


class Permuted(Library):
    """The materials of a library, each in all of `ORDERS`."""

    ORDERS: ClassVar = tuple("".join(order) for order in permutations("rgb"))
    """Which channel of a material red, green and blue are; as it is first."""

    @classmethod
    def name_of(cls, name: str, order: str) -> str:
        """What a material is called in one of `ORDERS`."""
        return name if order == cls.ORDERS[0] else f"{name}.{order}"

    @classmethod
    def channels(cls, order: str) -> list[int]:
        """The channels of a material that are red, green and blue in one of `ORDERS`."""
        return [cls.ORDERS[0].index(channel) for channel in order]

    def __init__(self, library: Library) -> None:
        self._library = library
        self.name = PERMUTED_PREFIX + library.name
        self.names = self._in_all(library.names)
        self.grid = library.grid
        description = f"{library.origin.description}; colour channels in all orders"
        self.origin = replace(library.origin, description=description)
        self.checksum = hashlib.sha256(f"{PERMUTED_PREFIX}{library.checksum}".encode()).hexdigest()
        self.material_checksums = self._in_all(library.material_checksums)

    @property
    def address(self) -> str:
        return PERMUTED_PREFIX + self._library.address

    def row(self, i: int) -> Table:
        i_material, i_order = divmod(i, len(self.ORDERS))
        return self._library.row(i_material)[self.channels(self.ORDERS[i_order])]

    def columns(self, columns: slice) -> Rows:
        samples = self._library.columns(columns)
        orders = np.stack([samples[self.channels(order)] for order in self.ORDERS], axis=2)
        return orders.reshape(3, len(self), -1)

    def blocks(self) -> list[slice]:
        return self._library.blocks()

    def _in_all(self, names: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(self.name_of(name, order) for name in names for order in self.ORDERS)
