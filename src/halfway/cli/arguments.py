"""What a person writes on the command line, as the package's values."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..errors import HalfwayError

if TYPE_CHECKING:
    from ..halfdiff import Grid

LONGEST_ROUTE = 100_000
"""Materials; their recipes take 1.5 GB of memory while they are written."""


class ArgumentError(HalfwayError):
    """An argument that says nothing the command understands."""


def parse_t(text: str) -> list[float]:
    """The list of t written as ``0,0.25,1`` or as ranges ``start:stop:step`` with both ends."""
    ts: list[float] = []
    for part in text.split(","):
        match _numbers(part, ":"):
            case [t]:
                ts.append(t)
            case [start, stop, step] if step > 0 and 0 <= stop - start < math.inf:
                require_length(len(ts) + (stop - start) / step)
                n = round((stop - start) / step)
                ts.extend(np.round(start + step * np.arange(n + 1), 12).tolist())
            case _:
                raise ArgumentError(
                    f"--t {part!r} is no finite number and no range: expected such as 0,0.25,1 or 0.0001:1:0.0001."
                )
    return ts


def parse_counts(text: str) -> list[int]:
    """The list of whole numbers from 1 written as ``3,5,15``."""
    parts = [part.strip() for part in text.split(",")]
    if not all(part.isdecimal() and int(part) > 0 for part in parts):
        raise ArgumentError(
            f"-k {text!r} is no list of numbers of components: expected such as 3,5,15."
        )
    return [int(part) for part in parts]


def require_length(n: float) -> None:
    """Refuse a route of more materials than memory holds recipes of."""
    if n > LONGEST_ROUTE:
        raise ArgumentError(
            f"a route of {n:,.0f} materials is too long: expected {LONGEST_ROUTE:,} or fewer. Make one for each part of it, "
            "with --t, in a folder of its own."
        )


def parse_grid(text: str) -> "Grid | None":
    """The MERL-like grid written as ``30x30x60``, or one with phi_h, as ``48x36x24x36``; None for no text."""
    from ..halfdiff import Grid

    if not text:
        return None
    sizes = text.lower().split("x")
    make = {3: Grid.merl, 4: Grid.anisotropic}.get(len(sizes))
    if make is None or not all(size.isdecimal() and 0 < int(size) <= 1000 for size in sizes):
        raise ArgumentError(
            f"--grid {text!r} is no grid: expected cells in theta_h, theta_d and phi_d, such as 30x30x60, "
            "or in theta_h, phi_h, theta_d and phi_d, such as 48x36x24x36."
        )
    return make(*map(int, sizes))


def parse_point(text: str) -> np.ndarray:
    """The coordinates written as ``1.5,-2e3,0.1``."""
    point = _numbers(text, ",")
    if not point:
        raise ArgumentError(
            f"--point {text!r} is no list of finite numbers: expected such as 1.5,-2e3,0.1."
        )
    return np.array(point)


def parse_lights(text: str) -> np.ndarray:
    """The directions written as ``-1,1,1`` or ``-1,1,1;1,0,1``, shape (n, 3); or the environment in a file, or ``studio``."""
    from ..render import open_environment

    try:
        rows = [[float(number) for number in part.split(",")] for part in text.split(";")]
    except ValueError:
        return open_environment(text)
    if not all(len(row) == 3 and np.isfinite(row).all() and _is_seen(*row) for row in rows):
        raise ArgumentError(
            f"--lights {text!r} are no directions to lights: expected x,y,z such as -1,1,1, z to the viewer, not from right behind; "
            "or a file of an environment."
        )
    return np.array(rows)


def open_like(text: str) -> str | np.ndarray | None:
    """What a recipe shall be like, as `halfway.find` takes it: a picture in linear light is opened, for it takes the renderer's reader."""
    from ..render import open_environment

    if not text.lower().endswith((".exr", ".hdr")):
        return text or None
    if not Path(text).is_file():
        raise ArgumentError(f"{text} is not there: expected a picture of a sphere. Check its name.")
    return open_environment(text)


def _is_seen(x: float, y: float, z: float) -> bool:
    return z > 0 or math.hypot(x, y) > 0


def parse_targets(texts: Sequence[str]) -> dict[str, str]:
    """The attributes written as ``gloss60=35``, one each."""
    targets: dict[str, str] = {}
    for text in texts:
        name, equals, value = (part.strip() for part in text.partition("="))
        if not equals or name in targets:
            wrong = "gives it twice" if name in targets else "is no attribute with its value"
            raise ArgumentError(f"{text!r} {wrong}: expected such as gloss60=35, each once.")
        targets[name] = value
    return targets


def parse_shares(text: str) -> dict[str, float]:
    """The shares written as ``train=80,test=20``."""
    shares: dict[str, float] = {}
    for part in text.split(","):
        name, _, share = (piece.strip() for piece in part.partition("="))
        try:
            shares[name] = float(share)
        except ValueError:
            raise ArgumentError(
                f"{part!r} is no name with its share: expected such as train=80,test=20."
            ) from None
    return shares


def parse_range(text: str) -> tuple[str, float, float]:
    """The attribute and its ends written as ``gloss60=5:80``."""
    name, _, ends = text.partition("=")
    match _numbers(ends, ":"):
        case [start, stop]:
            return name.strip(), start, stop
        case _:
            raise ArgumentError(
                f"--along {text!r} is no attribute with two ends: expected such as gloss60=5:80."
            )


def _numbers(text: str, separator: str) -> list[float]:
    """The finite numbers with separators between; none where anything else is among them."""
    try:
        numbers = [float(number) for number in text.split(separator)]
    except ValueError:
        return []
    return numbers if all(map(math.isfinite, numbers)) else []
