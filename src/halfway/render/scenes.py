"""The scenes: what stands where, under which light, seen from where.

World coordinates: x to the right of the camera, y away from it, z up; the ground is z = 0.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import cos, radians, sin
from typing import Any, Literal

from ..brdf import TabularBrdf

Vector = tuple[float, float, float]
Material = TabularBrdf | Mapping[str, Any]
"""What an object wears: a table, or a plugin of Mitsuba's as its dict."""


@dataclass(frozen=True)
class Placed:
    """An object: its shape, where it stands, and which of the materials it wears."""

    shape: Literal["teapot", "sphere", "disc", "mesh"]
    at: Vector = (0.0, 0.0, 0.0)
    """Where the middle of its foot stands."""
    height: float = 1.0
    """What stands here is no higher, and no wider than `width`."""
    turn_degrees: float = 0.0
    """About the vertical, counter-clockwise seen from above."""
    material: int = 0

    @property
    def width(self) -> float:
        """The diameter of the room for it: the teapot's own, or a sphere's."""
        return self.height * (2.05 if self.shape == "teapot" else 1.0)

    def turned(self, degrees: float) -> "Placed":
        """It on a turntable about the vertical through the origin, counter-clockwise seen from above."""
        c, s = cos(radians(degrees)), sin(radians(degrees))
        x, y, z = self.at
        at = c * x - s * y, s * x + c * y, z
        return replace(self, at=at, turn_degrees=self.turn_degrees + degrees)


@dataclass(frozen=True)
class PointLight:
    """A point that shines evenly to all sides."""

    at: Vector
    intensity: float
    """W/sr; at distance r it lights a surface that faces it with intensity / r^2."""


@dataclass(frozen=True)
class Camera:
    """A pinhole camera with z up."""

    at: Vector
    target: Vector
    fov_degrees: float
    """Of the width of what must be seen."""
    aspect: float = 1.0
    """Width by height of what must be seen: a picture of another shape shows more at its sides or above and below."""


@dataclass(frozen=True)
class Scene:
    """A scene of one or more objects."""

    name: str
    text: str
    """One line on what it shows."""
    objects: tuple[Placed, ...]
    camera: Camera
    points: tuple[PointLight, ...] = ()
    """Point lights; none means the environment."""
    ground: bool = False
    """A white sweep of paper under and behind the objects."""
    bounces: int = 1
    """1: direct light, and pictures mix as materials do; more: light between the objects and the ground too."""

    @property
    def n_materials(self) -> int:
        """How many materials the scene takes."""
        return 1 + max(placed.material for placed in self.objects)

    def turned(self, degrees: float) -> "Scene":
        """The objects on a turntable, under the same light, from the same place."""
        return replace(self, objects=tuple(placed.turned(degrees) for placed in self.objects))


_KEY, _FILL, _BACK = (
    PointLight((-4.0, -5.0, 6.0), 220.0),
    PointLight((5.5, -4.0, 2.0), 60.0),
    PointLight((4.5, 3.0, 5.0), 110.0),
)

SCENES = {
    scene.name: scene
    for scene in (
        Scene(
            "teapot",
            "the Utah teapot in a studio of soft boxes",
            (Placed("teapot", height=3.15, turn_degrees=-28.0),),
            Camera((0.15, -13.0, 5.4), (0.12, 0.0, 1.4), 29.0, 1.3),
            ground=True,
        ),
        Scene(
            "spheres",
            "a sphere under three point lights",
            (Placed("sphere", height=2.0),),
            Camera((0.0, -12.0, 1.0), (0.0, 0.0, 1.0), 11.0),
            points=(_KEY, _FILL, _BACK),
        ),
        Scene(
            "sphere",
            "a sphere under one point light, the fastest",
            (Placed("sphere", height=2.0),),
            Camera((0.0, -12.0, 1.0), (0.0, 0.0, 1.0), 10.4),
            points=(_KEY,),
        ),
        Scene(
            "trio",
            "three objects in three materials on a ground, with the light between them",
            (
                Placed("sphere", at=(-3.1, -0.6, 0.0), height=2.0, turn_degrees=20.0, material=0),
                Placed("teapot", at=(0.0, 0.9, 0.0), height=2.35, turn_degrees=-28.0, material=1),
                Placed("sphere", at=(3.1, -0.6, 0.0), height=2.0, turn_degrees=-40.0, material=2),
            ),
            Camera((0.0, -14.0, 5.2), (0.0, 0.0, 0.9), 37.0, 1.7),
            ground=True,
            bounces=5,
        ),
        Scene(
            "brushed",
            "a disc and a teapot, both turned on a lathe, which anisotropic materials show",
            (
                Placed("disc", at=(-1.8, 1.1, 0.0), height=3.4, turn_degrees=24.0),
                Placed("teapot", at=(1.35, -0.7, 0.0), height=2.35, turn_degrees=-28.0),
            ),
            Camera((0.1, -14.0, 4.6), (0.1, 0.0, 1.4), 31.0, 1.6),
            ground=True,
        ),
    )
}
"""The scenes by name."""
