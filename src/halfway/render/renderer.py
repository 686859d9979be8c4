"""Pictures of materials: a scene is loaded and compiled once, then takes any number of tables.

With direct light a picture is its object before a backdrop:

    picture = object(material) + (1 - alpha) backdrop          alpha: how much of a pixel the object covers

The object is lit by the environment alone, whose floor stands for the ground. The backdrop is the ground with the shadow
of the object; no material enters, so it is rendered once, without noise where that is possible, and kept. The object is
linear in the BRDF and the backdrop constant: with weights that sum to 1, the picture of a mix is the mix of the pictures.

With more bounces the ground and the objects stand in one scene and light each other, and that no longer holds.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from hashlib import sha256
from pathlib import Path

import numpy as np

from ..brdf import TabularBrdf
from ..errors import RenderError
from ..tasks import HERE, Work
from .camera import refined
from .denoise import denoiser_available, require_denoiser
from .exposure import Exposure, no_progress
from .interrupts import interrupts_wait
from .scenes import SCENES, Material, Scene
from .studio import studio
from .variant import VARIANTS, Device, compiles, load_mitsuba, register

STUDIO = "studio"
"""The built-in environment, in place of a file."""

BACKGROUND = 0.03
"""Radiance behind the objects of a scene without a ground."""
BACKDROP_SPP = 64, 256
"""At least so many samples a pixel of the ground, with a denoiser and without."""
LARGEST_SIZE = 8192
LARGEST_SPP = 65536
LARGEST_TURN = 360

QUALITY = {"preview": 16, "normal": 64, "final": 256}
"""Samples per pixel by the name of a quality."""


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
        Environment in place of the scene's light: latitude-longitude, ``.hdr`` or ``.exr``, up is up; or ``"studio"``.
    mesh : path, optional
        In place of every object of the scene: ``.ply`` or ``.obj``, y up.
    bounces : int, optional
        Of light between surfaces, in place of the scene's own.
    turn_degrees : float
        By how much an anisotropic table is turned against the tangent of the surface, counter-clockwise seen from outside.
    show_env : bool
        The environment stands behind the objects, in place of the ground.
    denoise : bool
        Take the noise out of each picture. A denoised picture of a mix is not quite the mix of the denoised pictures.
    device : {"auto", "cpu", "gpu"}
        Where to render; ``auto`` is an NVIDIA GPU where there is one that works. All of a program runs on one.
    work : Work
        Its cache keeps what is behind the objects.

    Raises
    ------
    RenderError
        When Mitsuba is missing, the scene unknown, a number out of range, a file unreadable.

    Examples
    --------
    >>> import halfway
    >>> from halfway.render import Renderer, pictures
    >>> gold = halfway.open_library("builtin:merl-abc").brdf("gold-paint")
    >>> renderer = Renderer("sphere", size=(64, 64), spp=16)
    >>> pictures.write("gold.png", renderer.picture(gold))
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
        turn_degrees: float = 0.0,
        show_env: bool = False,
        denoise: bool = False,
        device: Device = "auto",
        work: Work = HERE,
    ) -> None:
        self.scene = _scene(scene)
        if str(env) == STUDIO:
            self.scene, env = replace(self.scene, points=()), None
        if show_env:
            self.scene = _before_environment(self.scene, env)
        self.size = size
        self.spp = spp
        self.seed = seed
        self.bounces = self.scene.bounces if bounces is None else bounces
        self.turn_degrees = turn_degrees
        self._require_numbers()
        self._variant = load_mitsuba(device).variant()
        if self.exact:
            register(device)
        elif turn_degrees:
            raise RenderError(
                f"a material cannot be turned by {turn_degrees:g} degrees in the Mitsuba variant {self._variant}: "
                f"expected one that compiles, such as {VARIANTS['cpu']}."
            )
        if denoise:
            require_denoiser()
        self._denoise = denoise
        self._work = work
        env, mesh = (None if path is None else Path(path) for path in (env, mesh))
        self._files = env, mesh
        self._show_env = show_env
        self._device: Device = device
        with interrupts_wait():
            from .stage import Stage

            self._stage = Stage(
                self.scene, size=size, env=env, mesh=mesh, turn_degrees=turn_degrees
            )

    def _require_numbers(self) -> None:
        _require("width", self.size[0], 1, LARGEST_SIZE)
        _require("height", self.size[1], 1, LARGEST_SIZE)
        _require("spp", self.spp, 1, LARGEST_SPP)
        _require("seed", self.seed, 0, 2**32 - 1)
        _require("bounces", self.bounces, 1, 1000)
        if not abs(self.turn_degrees) <= LARGEST_TURN:
            raise RenderError(
                f"a turn of {self.turn_degrees:g} degrees is none: expected {-LARGEST_TURN} to {LARGEST_TURN}."
            )

    def turned(self, degrees: float) -> "Renderer":
        """The same with its objects on a turntable, counter-clockwise seen from above; light and camera stay."""
        env, mesh = self._files
        return Renderer(
            self.scene.turned(degrees),
            size=self.size,
            spp=self.spp,
            seed=self.seed,
            env=env,
            mesh=mesh,
            bounces=self.bounces,
            turn_degrees=self.turn_degrees,
            show_env=self._show_env,
            denoise=self._denoise,
            device=self._device,
            work=self._work,
        )

    @property
    def exact(self) -> bool:
        """Whether tables are looked up as they are; without GPU and LLVM, files within some 50 dB stand for them."""
        return compiles(self._variant)

    @property
    def linear(self) -> bool:
        """Whether the picture of a mix is the mix of the pictures (see the top of the module)."""
        return self.bounces == 1

    def picture(
        self,
        brdf: Material | Sequence[Material],
        *,
        progress: Callable[[int, int], None] = no_progress,
    ) -> np.ndarray:
        """The picture of a material, float32, shape (height, width, 3): linear RGB radiance.

        A scene of several materials takes as many tables; one table dresses all of its objects. A plugin of Mitsuba's,
        as the dict that ``mitsuba.load_dict`` takes, may stand for a table. ``progress`` is called
        with the passes done and their number: a large picture takes several.
        """
        materials = self._materials(brdf)
        exposure = Exposure(self.spp, self.seed, denoise=self._denoise, progress=progress)
        if self.bounces > 1:
            layer = self._stage.whole(materials, exposure, bounces=self.bounces)
            return layer.over(self._behind)
        return self._stage.objects(materials, exposure).over(self.backdrop)

    def fingerprint(self) -> str:
        """Letters that change when anything but the material changes the picture: 32 hexadecimal digits."""
        return self._fingerprint(
            self.spp, self.seed, self.bounces, self._denoise, self.turn_degrees
        )

    @cached_property
    def backdrop(self) -> np.ndarray:
        """What is behind the objects, as if seen through them: radiance, float32, shape (height, width, 3)."""
        if not self.scene.ground:
            return self._behind
        denoise = denoiser_available()
        exposure = Exposure(max(self.spp, BACKDROP_SPP[not denoise]), seed=0, denoise=denoise)
        kept = self._work.cached(
            f"ground-{self._fingerprint(exposure.spp, denoise)}",
            lambda: {"radiance": self._ground(exposure)},
        )
        return refined(kept["radiance"], self.size)

    @cached_property
    def _behind(self) -> np.ndarray:
        """What is behind all, the ground too."""
        return self._stage.environment() if self._show_env else _background(self.size)

    def _ground(self, exposure: Exposure) -> np.ndarray:
        layer = self._stage.ground(exposure)
        return layer.over(_background((layer.window.width, layer.window.height)))

    def _fingerprint(self, *sampling: float) -> str:
        """Of the scene, and of how it is sampled."""
        digest = sha256(
            f"4 {self.scene} {self.size} {self.exact} {self._show_env} {sampling}".encode()
        )
        for path in self._files:
            digest.update(b"none" if path is None else path.read_bytes())
        digest.update(studio(16).tobytes())
        return digest.hexdigest()[:32]

    def _materials(self, brdf: Material | Sequence[Material]) -> list[Material]:
        materials = [brdf] if isinstance(brdf, TabularBrdf | Mapping) else list(brdf)
        n = self.scene.n_materials
        if len(materials) == 1:
            materials = materials * n
        if len(materials) != n:
            raise RenderError(
                f"The scene {self.scene.name} takes {n} materials: {len(materials)} were given. "
                "Give one for all objects or one for each."
            )
        return materials


def open_environment(env: Path | str) -> np.ndarray:
    """An environment as `Renderer` takes it, a file or ``"studio"``: radiance, float32, shape (height, width, 3).

    The top row looks up, the middle column to where the camera looks.

    Raises
    ------
    RenderError
        When there is no such file, it is damaged or no picture in colour, or a value is missing.
    """
    if str(env) == STUDIO:
        return studio()
    load_mitsuba()
    from .environment import read_environment

    return read_environment(Path(env))


def _background(size: tuple[int, int]) -> np.ndarray:
    return np.full((size[1], size[0], 3), BACKGROUND, np.float32)


def _scene(scene: str | Scene) -> Scene:
    if isinstance(scene, Scene):
        return scene
    if scene not in SCENES:
        raise RenderError(f"there is no scene {scene!r}: there are {', '.join(SCENES)}.")
    return SCENES[scene]


def _before_environment(scene: Scene, env: Path | str | None) -> Scene:
    """The scene without its ground, for light that shows."""
    if scene.points and env is None:
        raise RenderError(
            f"the scene {scene.name} is lit by {len(scene.points)} points, which are no environment to show: expected one, with --env."
        )
    return replace(scene, ground=False)


def _require(what: str, value: int, least: int, most: int) -> None:
    if not least <= value <= most:
        raise RenderError(f"the {what} is {value}: expected {least} to {most}.")
