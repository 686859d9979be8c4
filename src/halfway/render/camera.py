"""Where the camera stands, what part of its frame some points fill, and a coarser frame for what is smooth."""

from typing import NamedTuple

import numpy as np
from PIL import Image

from .scenes import Camera

COARSE = 2
"""Pixels of the picture along a side of one pixel of a coarse one."""


class Window(NamedTuple):
    """A rectangle of pixels."""

    x: int
    y: int
    width: int
    height: int


def camera_to_world(camera: Camera) -> np.ndarray:
    """Columns: the camera's left, up, forward (Mitsuba's x, y, z) and its place; shape (4, 4)."""
    at = np.array(camera.at, float)
    forward = np.array(camera.target, float) - at
    forward /= np.linalg.norm(forward)
    left = np.cross([0.0, 0.0, 1.0], forward)
    left /= np.linalg.norm(left)
    matrix = np.eye(4)
    matrix[:3] = np.stack([left, np.cross(forward, left), forward, at], axis=-1)
    return matrix


def fov_degrees(camera: Camera, size: tuple[int, int], widened: float = 1.0) -> float:
    """The field of view across the width of a picture of this size that shows all that must be seen; ``widened`` times as wide."""
    half_width = np.tan(np.radians(camera.fov_degrees) / 2)
    wider = max(1.0, size[0] / size[1] / camera.aspect)
    return float(np.degrees(2 * np.arctan(half_width * wider * widened)))


def window(camera: Camera, size: tuple[int, int], points: np.ndarray, *, margin: int = 2) -> Window:
    """The part of the frame that ``points``, shape (n, 3), fill, and ``margin`` pixels around; never empty."""
    matrix = camera_to_world(camera)
    left, up, forward = ((points - matrix[:3, 3]) @ matrix[:3, :3]).T
    pixels_per_unit = size[0] / 2 / np.tan(np.radians(fov_degrees(camera, size)) / 2)
    if (forward <= 0).any():  # something is beside or behind the camera
        return Window(0, 0, *size)
    x = size[0] / 2 - pixels_per_unit * left / forward
    y = size[1] / 2 - pixels_per_unit * up / forward
    x0, x1 = _span(x, size[0], margin)
    y0, y1 = _span(y, size[1], margin)
    return Window(x0, y0, x1 - x0, y1 - y0)


def _span(positions: np.ndarray, size: int, margin: int) -> tuple[int, int]:
    low = int(np.clip(np.floor(positions.min()) - margin, 0, size - 1))
    high = int(np.clip(np.ceil(positions.max()) + margin, low + 1, size))
    return low, high


def coarse(size: tuple[int, int]) -> tuple[int, int]:
    """Width and height of the coarse frame of a picture of this size, the same or up to a pixel wider and higher."""
    width, height = size
    return -(-width // COARSE), -(-height // COARSE)


def refined(image: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """A coarse picture at its full ``size``, width and height; one that has it is left as it is."""
    height, width = image.shape[:2]
    if (width, height) == size:
        return image
    x, y = (width - size[0] / COARSE) / 2, (height - size[1] / COARSE) / 2
    box = (x, y, width - x, height - y)
    planes = [
        Image.fromarray(np.ascontiguousarray(plane)).resize(size, Image.Resampling.BILINEAR, box)
        for plane in np.moveaxis(image, -1, 0)
    ]
    return np.stack([np.asarray(plane) for plane in planes], axis=-1)
