"""Recipes by what they shall be: attributes that are asked for, and what can be reached."""

from .find import Control, Range, find, reach
from .wishes import Wishes

__all__ = ["Control", "Range", "Wishes", "find", "reach"]
