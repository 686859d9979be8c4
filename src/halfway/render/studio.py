"""The built-in environment: a photographer's studio of soft boxes, as a latitude-longitude picture.

A light is a rectangle in the room that faces the object, brighter in its middle and soft at its edge. Around them is a dim room that
is lighter towards the horizon, and a floor that is darker under the object, where its own shadow would lie. Radiance is in units in
which a white diffuse floor shows as light grey.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class SoftBox:
    """A rectangular light that faces the origin; x is to the right of the camera, y away from it, z up."""

    centre: tuple[float, float, float]
    width: float
    height: float
    radiance: float

    def seen(self, directions: np.ndarray) -> np.ndarray:
        """Radiance seen from the origin along unit ``directions`` (..., 3)."""
        centre = np.array(self.centre)
        forward = centre / np.linalg.norm(centre)
        across = np.cross(forward, [0.0, 0.0, 1.0])
        across = across / np.linalg.norm(across) if across.any() else np.array([1.0, 0.0, 0.0])
        up = np.cross(across, forward)
        facing = directions @ forward
        with np.errstate(divide="ignore", invalid="ignore"):
            reach = np.linalg.norm(centre) / facing
            x = np.abs(reach * (directions @ across)) / (self.width / 2)
            y = np.abs(reach * (directions @ up)) / (self.height / 2)
        inside = _edge(x) * _edge(y) * (1 - 0.35 * (x**2 + y**2) / 2)
        return np.where(facing > 1e-6, self.radiance * np.nan_to_num(inside), 0.0)


LIGHTS = (
    SoftBox((-6.5, -4.0, 5.0), width=5.0, height=6.5, radiance=21.0),  # key: large, from the left
    SoftBox((8.0, -2.5, 3.2), width=1.8, height=7.5, radiance=8.0),  # fill: a tall strip
    SoftBox((2.5, 7.5, 6.5), width=8.0, height=2.2, radiance=13.0),  # rim: from behind and above
    SoftBox((0.5, -0.5, 9.0), width=5.0, height=4.0, radiance=6.0),  # top
)


def studio(height: int = 256) -> np.ndarray:
    """The environment, float32, shape (height, 2 * height, 3), linear RGB; the top row looks up, the middle column to +y."""
    d = directions(height)
    room = 0.24 + 0.42 * np.exp(-((d[..., 2] / 0.35) ** 2))
    floor = 0.2 + 0.5 * np.clip(1 + d[..., 2], 0, 1) ** 0.8
    grey = np.where(d[..., 2] >= 0, room, floor)
    grey = grey + sum(light.seen(d) for light in LIGHTS)
    return np.repeat(grey[..., None], 3, axis=-1).astype(np.float32)


def as_bright_as_the_studio(environment: np.ndarray) -> np.ndarray:
    """An environment scaled so that it lights the ground as the studio does: files come in units of their own."""
    scale = _on_the_ground(studio(64)) / max(_on_the_ground(environment), 1e-12)
    return (environment * scale).astype(np.float32)


def _on_the_ground(environment: np.ndarray) -> float:
    """Irradiance of a horizontal surface from above, the mean of the channels."""
    height, width = environment.shape[:2]
    theta = np.pi * (np.arange(height) + 0.5) / height
    weights = np.maximum(np.cos(theta), 0) * np.sin(theta) * 2 * np.pi**2 / (height * width)
    return float(np.einsum("h,hwc->", weights, environment.astype(float)) / 3)


def directions(height: int) -> np.ndarray:
    """Unit directions of the pixels of a latitude-longitude picture, shape (height, 2 * height, 3)."""
    theta = np.pi * (np.arange(height) + 0.5) / height
    turn = 2 * np.pi * (np.arange(2 * height) + 0.5) / (2 * height) - np.pi
    sin = np.sin(theta)[:, None]
    return np.stack(
        [
            sin * np.sin(turn),
            sin * np.cos(turn),
            np.broadcast_to(np.cos(theta)[:, None], (height, 2 * height)),
        ],
        axis=-1,
    )


def _edge(x: np.ndarray) -> np.ndarray:
    """1 inside, 0 outside, smooth over the outer tenth."""
    t = np.clip((1 - x) / 0.1, 0, 1)
    return t * t * (3 - 2 * t)
