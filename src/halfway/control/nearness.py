"""How near a mix is to a material that it shall be like: in numbers that are linear in the table.

    picture        the mean radiance of each of 6 x 6 parts of the picture of its lit sphere, per channel
    reflections    gloss at three angles, and haze
    colour         the body colour, per channel

each as a share of the reference's own, in the slope of a cube root as lightness has it. Distances are sums of absolute
differences. What nobody asks to change is held: reflections and colour then count for more than the picture.

These numbers and not a space's coordinates, because a file that is in no library has them as well.
"""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float64, Int

from .._types import Mask
from ..instruments import ATTRIBUTES, Readings
from ..look import Looks, SphereScene

N_PARTS = 6
"""Of the picture, along each side."""
DARK = 0.02
"""Radiance, or share of a gloss unit's hundred, below which differences no longer count for more."""
HELD = 4.0
"""What a group that is held weighs, where the picture weighs 1."""
GROUPS = ("picture", "reflections", "colour")
REFLECTIONS = ("gloss20", "gloss60", "gloss85", "haze")


@dataclass(frozen=True, eq=False)
class Nearness:
    """The numbers of all materials of a library."""

    points: Float64[np.ndarray, "N d"]
    groups: tuple[str, ...]
    """Of each number."""
    scene: SphereScene
    """In which they are pictured."""
    parts: Int[np.ndarray, " n_pixels"]
    """Of the picture, in which its pixels are."""

    @classmethod
    def of(cls, looks: Looks, readings: Readings) -> "Nearness":
        """The numbers of a library, by its pictures and readings."""
        parts = parts_of(looks.scene.mask())
        points = _numbers(parts, looks.images, readings.values)
        n_picture = points.shape[1] - len(REFLECTIONS) - 3
        groups = np.repeat(GROUPS, [n_picture, len(REFLECTIONS), 3])
        return cls(points, tuple(groups.tolist()), looks.scene, parts)

    def seen(self, picture: np.ndarray, readings: np.ndarray) -> Float64[np.ndarray, " d"]:
        """The numbers of a material, by its picture in the scene and its readings."""
        return _numbers(self.parts, picture[None], readings[None])[0]

    def scaled(
        self, reference: Float64[np.ndarray, " d"], *, held: Collection[str]
    ) -> Float64[np.ndarray, "N n_counted"]:
        """The differences of all materials from a reference, where distances count, with these groups held.

        Numbers that the reference does not have, which are NaN, do not count.
        """
        known = np.isfinite(reference)
        # What has no picture is told by what it has.
        plain = 0.0 if known[0] else 1.0
        weights = {**dict.fromkeys(GROUPS, plain), "picture": 1.0, **dict.fromkeys(held, HELD)}
        scale = np.array([weights[group] / self.groups.count(group) for group in self.groups])
        scale = np.where(known, scale / (np.abs(reference) + DARK) ** (2 / 3), 0)
        counted = scale > 0
        return (self.points - reference)[:, counted] * scale[counted]

    def alone(self, group: str, numbers: np.ndarray) -> Float64[np.ndarray, " d"]:
        """The numbers of a reference of which one group is known."""
        out = np.full(len(self.groups), np.nan)
        out[np.array(self.groups) == group] = numbers
        return out

    def of_group(self, group: str) -> Float64[np.ndarray, "N n_group"]:
        """The numbers of one group, of all materials."""
        return self.points[:, np.array(self.groups) == group]


def _numbers(
    parts: Int[np.ndarray, " n_pixels"], pictures: np.ndarray, readings: np.ndarray
) -> Float64[np.ndarray, "N d"]:
    reflections = [ATTRIBUTES[name].of(readings) / 100 for name in REFLECTIONS]
    means = part_means(pictures, parts)
    return np.concatenate(
        [means, np.stack(reflections, axis=1), ATTRIBUTES["body"].of(readings)], axis=1
    )


def parts_of(mask: Mask) -> Int[np.ndarray, " n_pixels"]:
    """The parts in which the pixels of a sphere are, those of ``mask``."""
    side = np.arange(len(mask)) * N_PARTS // len(mask)
    return (side[:, None] * N_PARTS + side)[mask]


def part_means(
    pictures: np.ndarray, parts: Int[np.ndarray, " n_pixels"]
) -> Float64[np.ndarray, "N n_picture"]:
    """The means of the parts of pictures of a sphere, of whose pixels alone they are, shape (N, n_pixels, 3)."""
    means = [pictures[:, parts == i].mean(axis=1, dtype=np.float64) for i in _on_sphere()]
    return np.concatenate(means, axis=1)


def _on_sphere() -> Int[np.ndarray, " n_parts"]:
    """The parts whose middle is on the sphere."""
    across = (np.arange(N_PARTS) + 0.5) * 2 / N_PARTS - 1
    return np.flatnonzero(np.hypot(across, across[:, None]) < 1)
