"""Recipes by what they shall be: attributes that are asked for, and what can be reached."""

from .control import Control
from .find import find, reach
from .ranges import Range
from .wishes import Wishes

__all__ = ["Control", "Range", "Wishes", "find", "reach"]
