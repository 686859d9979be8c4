"""Measurements: values of one material at some pairs of directions, and the files that instruments write them to."""

from .measurements import Angles, Measurements
from .reading import read_measurements
from .writing import write_directions, write_measurements

__all__ = [
    "Angles",
    "Measurements",
    "read_measurements",
    "write_directions",
    "write_measurements",
]
