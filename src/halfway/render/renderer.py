"""Pictures of materials: a scene is loaded and compiled once, then takes any number of tables.

With direct light a picture has two layers that add up:

    picture = object(material) + backdrop

The object is lit by the environment alone, whose floor stands for the ground. The backdrop is the ground with the shadow of the
object, black where the object covers it; no material enters, so it is rendered once. The object's layer is linear in the BRDF and
the backdrop constant: with weights that sum to 1, the picture of a mix is the mix of the pictures.

With more bounces the ground and the objects stand in one scene and light each other, and that no longer holds.
"""

from collections.abc import Sequence
from functools import cached_property
from pathlib import Path

import numpy as np

from ..brdf import TabularBrdf
from ..errors import RenderError
from .scenes import SCENES, Scene
from .variant import register

LARGEST_SIZE = 8192
LARGEST_SPP = 65536
BACKDROP_SPP = 64
"""At least so many samples for the backdrop, which is rendered once."""


class Renderer:
    """A scene, a size and a number of samples; makes pictures of materials.

    Parameters
    ----------
    scene : str or Scene
        A scene or the name of one of `SCENES`.
    size : (int, int)
        Width and height in pixels.
    spp : int
        Samples per pixel.
    seed : int
        Of the samples: the same seed gives the same picture, and the same noise in every picture of a route.
    env : path, optional
        Environment in place of the studio: latitude-longitude, ``.hdr`` or ``.exr``, up is up.
    mesh : path, optional
        Object in place of the scene's teapot (of its sphere where it has none): ``.ply`` or ``.obj``, y up.
    bounces : int, optional
        Of light between surfaces, in place of the scene's own.

    Raises
    ------
    RenderError
        When Mitsuba or LLVM is missing, the scene unknown, a number out of range, a file unreadable.

    Examples
    --------
    >>> from halfway.models import builtin                                  # doctest: +SKIP
    >>> renderer = Renderer("teapot", size=(256, 256), spp=16)              # doctest: +SKIP
    >>> pictures.write("gold.png", renderer.picture(table))                 # doctest: +SKIP
    """

    def __init__(
        self,
        scene: str | Scene = "teapot",
        *,
        size: tuple[int, int] = (512, 512),
        spp: int = 64,
        seed: int = 0,
        env: Path | str | None = None,
        mesh: Path | str | None = None,
        bounces: int | None = None,
    ) -> None:
        self.scene = _scene(scene)
        self.size = size
        self.spp = spp
        self.seed = seed
        self.bounces = self.scene.bounces if bounces is None else bounces
        _require("width", size[0], 1, LARGEST_SIZE)
        _require("height", size[1], 1, LARGEST_SIZE)
        _require("spp", spp, 1, LARGEST_SPP)
        _require("bounces", self.bounces, 1, 1000)
        register()
        from .stage import Stage

        self._stage = Stage(
            self.scene,
            size=size,
            env=None if env is None else Path(env),
            mesh=None if mesh is None else Path(mesh),
        )

    @property
    def linear(self) -> bool:
        """Whether the picture of a mix is the mix of the pictures (see the top of the module)."""
        return self.bounces == 1

    def picture(self, brdf: TabularBrdf | Sequence[TabularBrdf]) -> np.ndarray:
        """The picture of a material, float32, shape (height, width, 3): linear RGB radiance.

        A scene of several materials takes as many tables; one table dresses all of its objects.
        """
        tables = self._tables(brdf)
        if not self.linear:
            return self._stage.whole(tables, bounces=self.bounces, spp=self.spp, seed=self.seed)
        return self.backdrop + self._stage.objects(tables, spp=self.spp, seed=self.seed)

    @cached_property
    def backdrop(self) -> np.ndarray:
        """What is behind the objects, black where they cover it, shape (height, width, 3)."""
        spp = max(self.spp, BACKDROP_SPP if self.scene.ground else 1)
        return self._stage.backdrop(spp=spp, seed=self.seed)

    def _tables(self, brdf: TabularBrdf | Sequence[TabularBrdf]) -> list[TabularBrdf]:
        tables = [brdf] if isinstance(brdf, TabularBrdf) else list(brdf)
        n = self.scene.n_materials
        if len(tables) == 1:
            tables = tables * n
        if len(tables) != n:
            raise RenderError(
                f"The scene {self.scene.name} takes {n} materials: {len(tables)} were given. "
                "Give one for all objects or one for each."
            )
        return tables


def _scene(scene: str | Scene) -> Scene:
    if isinstance(scene, Scene):
        return scene
    if scene not in SCENES:
        raise RenderError(f"There is no scene {scene!r}: there are {', '.join(SCENES)}.")
    return SCENES[scene]


def _require(what: str, value: int, least: int, most: int) -> None:
    if not least <= value <= most:
        raise RenderError(f"The {what} is {value}: expected {least} to {most}.")
