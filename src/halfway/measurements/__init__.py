"""Measurements: values of one material at some pairs of directions, and the files that instruments write them to."""

from .measurements import Angles, Measurements

__all__ = ["Angles", "Measurements"]
