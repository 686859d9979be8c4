"""A scene set up in Mitsuba, ready to be photographed.

Imported only after `halfway.render.variant.load_mitsuba` has chosen a variant.
"""

import warnings
from pathlib import Path
from typing import Any

import mitsuba as mi
import numpy as np

from .assets import read_mesh
from .camera import COARSE, Window, camera_to_world, coarse, fov_degrees, window
from .denoise import denoised
from .environment import read_environment
from .exposure import Exposure, Layer
from .ground import seen_through
from .interrupts import interrupts_wait
from .mesh import Mesh, brushed, disc, placed, sweep
from .scenes import Camera, Material, Placed, PointLight, Scene
from .studio import as_bright_as_the_studio, studio
from .teapot import tessellate
from .variant import compiles
from .wardrobe import Files, Tables

PAPER = 0.4
"""Reflectance of the ground."""
ENVIRONMENT_SPP = 16
"""Samples of what is behind the objects: no noise, but edges within a pixel."""


class Stage:
    """The objects, lights and camera of a scene; its parts are compiled when first used."""

    def __init__(
        self,
        scene: Scene,
        *,
        size: tuple[int, int],
        env: Path | None,
        mesh: Path | None,
        turn_degrees: float = 0.0,
    ) -> None:
        self._scene = scene
        self._size = size
        self._meshes = _meshes(scene, mesh)
        self._mesh_file = mesh
        self._lights = _lights(scene, env)
        self._wardrobe = (Tables if compiles(str(mi.variant())) else Files)(turn_degrees)
        self._scenes: dict[bool, list[Any]] = {}

    def objects(self, materials: list[Material], exposure: Exposure) -> Layer:
        """The objects under direct light. No light leaves the frame around them, so no more of it is rendered."""
        self._dress(materials)
        return _photograph(self._dressed(ground=False), _direct(), exposure)

    def whole(self, materials: list[Material], exposure: Exposure, *, bounces: int) -> Layer:
        """Objects and ground, with ``bounces`` of light between them."""
        self._dress(materials)
        integrator = {"type": "path", "max_depth": bounces + 1, "hide_emitters": True}
        photographer = mi.load_dict(integrator)
        return _photograph(self._dressed(ground=self._scene.ground), photographer, exposure)

    def ground(self, exposure: Exposure) -> Layer:
        """The ground as if seen through the objects, whose shadows it has; coarse where the variant compiles."""
        black = _both_sides(mi.load_dict({"type": "diffuse", "reflectance": 0.0}))
        bsdfs = [black] * self._scene.n_materials
        if not compiles(str(mi.variant())):
            return self._ground_beside(bsdfs, exposure)
        size = coarse(self._size)
        sensor = _sensor(self._scene.camera, size, widened=COARSE * size[0] / self._size[0])
        scenes = self._load(bsdfs, sensor, ground=True)
        return _photograph(scenes, seen_through(black), exposure)

    def environment(self) -> np.ndarray:
        """The light itself where the camera looks, shape (height, width, 3)."""
        sensor = _sensor(self._scene.camera, self._size)
        scenes = [mi.load_dict({"type": "scene", "sensor": sensor, "light": self._lights[0]})]
        shown = mi.load_dict({"type": "direct"})
        return _photograph(scenes, shown, Exposure(ENVIRONMENT_SPP, seed=0)).radiance

    def _ground_beside(self, black: list[Any], exposure: Exposure) -> Layer:
        """The ground beside black objects: what Mitsuba's own integrators see, which are the fast ones in a scalar variant."""
        sensor = _sensor(self._scene.camera, self._size)
        beside, objects = (
            _photograph(self._load(black, sensor, ground=ground), _direct(), exposure)
            for ground in (True, False)
        )
        # Where they cover a part of a pixel, the rest is as the whole would be.
        return beside._replace(radiance=beside.radiance / np.maximum(1 - objects.alpha, 1 / 64))

    @interrupts_wait()
    def _dress(self, materials: list[Material]) -> None:
        if self._wardrobe.change(materials):
            self._scenes = {}
            self._say_where_tangents_point()

    def _say_where_tangents_point(self) -> None:
        """Where a mesh of the user's own does not say itself, and it matters."""
        unsaid = any(mesh is not None and mesh.uv is None for mesh in self._meshes)
        if unsaid and any(map(_is_anisotropic, self._wardrobe.bsdfs)):
            warnings.warn(
                f"{self._mesh_file} has no texture coordinates, which say where a material's tangent points: "
                "it runs level, around the vertical. Unwrap the mesh to have another.",
                stacklevel=2,
            )

    def _dressed(self, *, ground: bool) -> list[Any]:
        if ground not in self._scenes:
            window = None if ground else self._window()
            sensor = _sensor(self._scene.camera, self._size, window)
            self._scenes[ground] = self._load(self._wardrobe.bsdfs, sensor, ground=ground)
        return self._scenes[ground]

    def _load(self, bsdfs: list[Any], sensor: dict[str, Any], *, ground: bool) -> list[Any]:
        """One scene for each light: their pictures add up, and no sample goes to choosing between lights."""
        description: dict[str, Any] = {"type": "scene", "sensor": sensor}
        for i, (obj, mesh) in enumerate(zip(self._scene.objects, self._meshes, strict=True)):
            description[f"object_{i}"] = _shape(obj, mesh, bsdfs[obj.material])
        if ground:
            paper = mi.load_dict({"type": "diffuse", "reflectance": PAPER})
            description["ground"] = _mesh("ground", sweep(), paper)
        return [mi.load_dict({**description, "light": light}) for light in self._lights]

    def _window(self) -> Window:
        corners = [
            _box(obj) if mesh is None else mesh.positions
            for obj, mesh in zip(self._scene.objects, self._meshes, strict=True)
        ]
        return window(self._scene.camera, self._size, np.concatenate(corners))


def _direct() -> Any:
    return mi.load_dict({"type": "direct", "hide_emitters": True})


def _photograph(scenes: list[Any], photographer: Any, exposure: Exposure) -> Layer:
    """The layer of scenes that differ in their light, in the window of their sensor."""
    film = scenes[0].sensors()[0].film()
    window = Window(*map(int, film.crop_offset()), *map(int, film.crop_size()))
    passes = exposure.passes(window.width * window.height)
    takes = [(seed, scene) for seed in passes.seeds for scene in scenes]
    total = np.zeros((window.height, window.width, 4), np.float32)
    for done, (seed, scene) in enumerate(takes, start=1):
        with interrupts_wait():
            image = mi.render(scene, integrator=photographer, spp=passes.spp, seed=mi.UInt32(seed))
            total += np.array(image)
        exposure.progress(done, len(takes))
    total /= len(passes.seeds)
    # Each light's picture has brought the same coverage.
    radiance, alpha = total[..., :3], total[..., 3:] / len(scenes)
    return Layer(window, denoised(radiance) if exposure.denoise else radiance, alpha)


def _meshes(scene: Scene, mesh: Path | None) -> list[Mesh | None]:
    """The mesh of each object; None for a sphere, which Mitsuba has itself."""
    own = None if mesh is None else read_mesh(mesh)
    if own is not None:
        return [placed(own, obj) for obj in scene.objects]
    return [
        placed(_MADE[obj.shape](), obj) if obj.shape in _MADE else None for obj in scene.objects
    ]


_MADE = {"teapot": tessellate, "disc": disc}
"""Meshes by shape."""


def _shape(obj: Placed, mesh: Mesh | None, bsdf: Any) -> Any:
    if mesh is not None:
        return _mesh(obj.shape, mesh, bsdf)
    x, y, z = obj.at
    radius = obj.height / 2
    # Its tangent runs around the vertical.
    return {"type": "sphere", "center": [x, y, z + radius], "radius": radius, "bsdf": bsdf}


def _mesh(kind: str, mesh: Mesh, bsdf: Any) -> Any:
    props = mi.Properties()
    props["mesh_bsdf"] = _both_sides(bsdf)
    has_tangents = _is_anisotropic(bsdf)
    mesh = brushed(mesh).unshared() if has_tangents else mesh
    shape = mi.Mesh(
        kind,
        len(mesh.positions),
        len(mesh.faces),
        has_vertex_normals=True,
        has_vertex_texcoords=has_tangents,
        props=props,
    )
    parameters = mi.traverse(shape)
    arrays = {
        "vertex_positions": mesh.positions,
        "vertex_normals": mesh.normals,
        "faces": mesh.faces,
    }
    if has_tangents:
        arrays["vertex_texcoords"] = np.asarray(mesh.uv)
    for name, array in arrays.items():
        buffer: Any = type(parameters[name])
        parameters[name] = buffer(array.ravel())
    parameters.update()
    return shape


def _is_anisotropic(bsdf: Any) -> bool:
    return mi.has_flag(bsdf.flags(), mi.BSDFFlags.Anisotropic)


def _both_sides(bsdf: Any) -> Any:
    """Sheets, open shapes and meshes whose faces point anywhere show the material from behind too."""
    if mi.has_flag(bsdf.flags(), mi.BSDFFlags.BackSide):
        return bsdf
    return mi.load_dict({"type": "twosided", "bsdf": bsdf})


def _lights(scene: Scene, env: Path | None) -> list[dict[str, Any]]:
    if scene.points and env is None:
        return [_point(light) for light in scene.points]
    bitmap = mi.Bitmap(studio() if env is None else as_bright_as_the_studio(read_environment(env)))
    T = mi.ScalarTransform4f
    # Mitsuba's environments have y up and their middle at +z; ours show +y there.
    to_world = T().rotate([0, 0, 1], 180) @ T().rotate([1, 0, 0], 90)
    return [{"type": "envmap", "bitmap": bitmap, "to_world": to_world}]


def _point(light: PointLight) -> dict[str, Any]:
    return {
        "type": "point",
        "position": list(light.at),
        "intensity": {"type": "rgb", "value": light.intensity},
    }


def _box(obj: Placed) -> np.ndarray:
    """Corners of the cube around a sphere."""
    signs = np.array(np.meshgrid([-1, 1], [-1, 1], [0, 2])).reshape(3, -1).T
    return np.array(obj.at) + signs * obj.height / 2


def _sensor(
    camera: Camera, size: tuple[int, int], window: Window | None = None, *, widened: float = 1.0
) -> dict[str, Any]:
    film: dict[str, Any] = {
        "type": "hdrfilm",
        "width": size[0],
        "height": size[1],
        "pixel_format": "rgba",
        "component_format": "float32",
        # A box keeps the samples of a pixel apart from its neighbours': the denoiser wants that, and it is the fastest.
        "rfilter": {"type": "box"},
    }
    if window is not None:
        film |= {
            "crop_offset_x": window.x,
            "crop_offset_y": window.y,
            "crop_width": window.width,
            "crop_height": window.height,
        }
    return {
        "type": "perspective",
        "fov": fov_degrees(camera, size, widened),
        "fov_axis": "x",
        "to_world": mi.ScalarTransform4f(camera_to_world(camera)),
        "sampler": {"type": "multijitter"},
        "film": film,
    }
