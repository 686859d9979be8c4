"""What goes into a camera and what comes out: samples, seeds and passes; layers of a picture."""

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, isqrt
from typing import NamedTuple

import numpy as np

from .camera import Window

PASS_SAMPLES = 2**25
"""The most samples that are under way at once: their random numbers take some 16 bytes each."""


class Passes(NamedTuple):
    """A picture is the mean of as many passes as there are seeds."""

    spp: int
    seeds: list[int]


def no_progress(done: int, total: int) -> None:
    """Say nothing."""


@dataclass(frozen=True)
class Exposure:
    """Samples per pixel, their seed, and whether their noise is taken out."""

    spp: int
    seed: int
    denoise: bool = False
    progress: Callable[[int, int], None] = no_progress
    """Called with the passes done and their number."""

    def passes(self, n_pixels: int) -> Passes:
        """Passes of equal size, rounded up to the grid of samples that Mitsuba's multijitter draws from."""
        n = ceil(self.spp * n_pixels / PASS_SAMPLES)
        each = ceil(self.spp / n)
        side = isqrt(each)
        # A step of the golden ratio keeps the seeds of the passes of different pictures apart.
        seeds = [(self.seed + i * 0x9E3779B9) % 2**32 for i in range(n)]
        return Passes(side * ceil(each / side), seeds)


class Layer(NamedTuple):
    """What the camera sees of some objects, in the window of its frame that they fill."""

    window: Window
    radiance: np.ndarray
    """Linear RGB, shape (height, width, 3); 0 where no object covers the pixel, so that layers add up."""
    alpha: np.ndarray
    """How much of the pixel the objects cover, shape (height, width, 1)."""

    def over(self, background: np.ndarray) -> np.ndarray:
        """The picture before a background, shape (height, width, 3) of the frame."""
        picture = background.copy()
        x, y, width, height = self.window
        part = picture[y : y + height, x : x + width]
        part *= 1 - self.alpha
        part += self.radiance
        return picture
