"""Measurements, or the directions of those to come, as CSV that `read_measurements` reads."""

from pathlib import Path

import numpy as np

from .._types import Directions
from ..files import write_text
from .measurements import Angles, Measurements

_ANGLES = "theta_i [deg],phi_i [deg],theta_o [deg],phi_o [deg]"


def write_measurements(path: Path, measurements: Measurements) -> None:
    """Write measurements as CSV: angles in degrees, values in 1/sr."""
    header = f"{_ANGLES},r [1/sr],g [1/sr],b [1/sr],weight"
    numbers = (measurements.values, measurements.weights[:, None])
    _write(path, header, _degrees(measurements.wi, measurements.wo), *numbers)


def write_directions(path: Path, wi: Directions, wo: Directions) -> None:
    """Write directions as CSV; the values are to be filled in: columns r, g and b follow, empty."""
    empty = np.full((len(wi), 3), "")
    _write(path, f"{_ANGLES},r [1/sr],g [1/sr],b [1/sr]", _degrees(wi, wo), empty)


def _degrees(wi: Directions, wo: Directions) -> np.ndarray:
    return np.degrees(np.stack(Angles.of(wi, wo), axis=1))


def _write(path: Path, header: str, *columns: np.ndarray) -> None:
    rows = zip(*(each.tolist() for each in columns), strict=True)
    lines = [",".join(_cell(x) for part in row for x in part) for row in rows]
    write_text(path, "\n".join([header, *lines]) + "\n")


def _cell(x: float | str) -> str:
    return x if isinstance(x, str) else f"{x:.9g}"
