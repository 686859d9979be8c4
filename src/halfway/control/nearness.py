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
from jaxtyping import Float64

from ..brdf import TabularBrdf
from ..instruments import ATTRIBUTES, Readings, read_table
from ..look import PACING_SCENE, Looks, SphereOperator

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

    @classmethod
    def of(cls, looks: Looks, readings: Readings) -> "Nearness":
        """The numbers of a library, by its pictures and readings."""
        points = _numbers(looks.images, readings.values)
        n_picture = points.shape[1] - len(REFLECTIONS) - 3
        groups = np.repeat(GROUPS, [n_picture, len(REFLECTIONS), 3])
        return cls(points, tuple(groups.tolist()))

    def scaled(
        self, reference: Float64[np.ndarray, " d"], *, held: Collection[str]
    ) -> Float64[np.ndarray, "N n_counted"]:
        """The differences of all materials from a reference, where distances count, with these groups held."""
        weights = {"picture": 1.0, **dict.fromkeys(held, HELD)}
        shares = {group: weights.get(group, 0.0) / self.groups.count(group) for group in GROUPS}
        scale = np.array([shares[group] for group in self.groups])
        differences = (self.points - reference) * scale / (np.abs(reference) + DARK) ** (2 / 3)
        return differences[:, scale > 0]


def numbers_of(table: TabularBrdf) -> Float64[np.ndarray, " d"]:
    """The numbers of a table."""
    picture = SphereOperator.of(PACING_SCENE, table.grid).picture(table.values.reshape(3, -1))
    return _numbers(picture[None], read_table(table)[None])[0]


def _numbers(pictures: np.ndarray, readings: np.ndarray) -> Float64[np.ndarray, "N d"]:
    means = np.stack([pictures[:, part].mean(axis=1) for part in _parts()], axis=1)
    reflections = [ATTRIBUTES[name].of(readings) / 100 for name in REFLECTIONS]
    parts = (
        means.reshape(len(means), -1),
        np.stack(reflections, axis=1),
        ATTRIBUTES["body"].of(readings),
    )
    return np.concatenate(parts, axis=1)


def _parts() -> list[np.ndarray]:
    """The pixels of the sphere in each part of its picture."""
    side = np.arange(PACING_SCENE.size) * N_PARTS // PACING_SCENE.size
    part = (side[:, None] * N_PARTS + side)[PACING_SCENE.mask()]
    return [np.flatnonzero(part == i) for i in np.unique(part)]
