"""What a recipe shall be like: a material, a colour, a picture."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Float64

from ..brdf import Brdf
from ..colour import from_hex
from ..instruments import Readings, read_table, table_of
from ..library import Library
from ..look import SphereOperator
from ..recipes import Recipe, split_address
from .nearness import Nearness
from .pictures import PICTURES, picture_numbers

Like = str | Recipe | Brdf | np.ndarray | None


class Reference(NamedTuple):
    """What nearness is measured from."""

    numbers: Float64[np.ndarray, " d"]
    """Of `Nearness`; NaN for those that it does not have."""
    readings: Float64[np.ndarray, "n_instruments 3"] | None = None
    """None where it is no material."""

    @classmethod
    def of(
        cls, like: str | Brdf | np.ndarray, library: Library, readings: Readings, nearness: Nearness
    ) -> "Reference":
        """Anything but a recipe of the library."""
        if isinstance(like, np.ndarray):
            return cls._of_picture(like, nearness)
        if not isinstance(like, str):
            return cls._of_table(like, nearness)
        if like in library.names:
            i = library.index(like)
            return cls(nearness.points[i], readings.values[i])
        if (colour := from_hex(like)) is not None:
            return cls(nearness.alone("colour", colour))
        if Path(like).suffix.lower() in PICTURES:
            return cls._of_picture(Path(like), nearness)
        is_addressed = len(split_address(like)) > 1
        return cls._of_table(like, nearness, library="" if is_addressed else library.address)

    @classmethod
    def _of_picture(cls, picture: Path | np.ndarray, nearness: Nearness) -> "Reference":
        numbers = picture_numbers(picture, nearness.of_group("picture"))
        return cls(nearness.alone("picture", numbers))

    @classmethod
    def _of_table(cls, what: str | Brdf, nearness: Nearness, *, library: str = "") -> "Reference":
        table = table_of(what, library=library)
        operator = SphereOperator.of(nearness.scene, table.grid)
        readings = read_table(table)
        return cls(nearness.seen(operator.picture(table.values.reshape(3, -1)), readings), readings)
