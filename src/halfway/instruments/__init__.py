"""What instruments read off a table, and the attributes that are functions of it: numbers that people use of a material."""

from .attribute import Attribute, Condition
from .functionals import INSTRUMENTS
from .readings import Reader, Readings, read_table
from .registry import (
    ATTRIBUTES,
    attribute,
    attributes,
    described,
    of_readings,
    of_table,
    table_of,
)

__all__ = [
    "ATTRIBUTES",
    "INSTRUMENTS",
    "Attribute",
    "Condition",
    "Reader",
    "Readings",
    "attribute",
    "attributes",
    "described",
    "of_readings",
    "of_table",
    "read_table",
    "table_of",
]
