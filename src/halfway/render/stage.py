"""A scene set up in Mitsuba, ready to be photographed.

Imported only after `halfway.render.variant.load_mitsuba` has chosen a variant.
"""

from pathlib import Path
from typing import Any

import mitsuba as mi
import numpy as np

from .assets import read_mesh
from .camera import Window, camera_to_world, fov_degrees, window
from .environment import read_environment
from .exposure import Exposure, Layer
from .mesh import Mesh, placed, sweep
from .scenes import Camera, Material, Placed, PointLight, Scene
from .studio import as_bright_as_the_studio, studio
from .teapot import tessellate
from .variant import compiles
from .wardrobe import Files, Tables

PAPER = 0.4
"""Reflectance of the ground."""


class Stage:
    """The objects, lights and camera of a scene; its parts are compiled when first used."""

    def __init__(
        self, scene: Scene, *, size: tuple[int, int], env: Path | None, mesh: Path | None
    ) -> None:
        self._scene = scene
        self._size = size
        self._meshes = _meshes(scene, mesh)
        self._lights = _lights(scene, env)
        self._wardrobe = Tables() if compiles(str(mi.variant())) else Files()
        self._scenes: dict[bool, list[Any]] = {}

    def objects(self, materials: list[Material], exposure: Exposure) -> Layer:
        """The objects under direct light. No light leaves the frame around them, so no more of it is rendered."""
        self._dress(materials)
        return _photograph(self._dressed(ground=False), _direct(), exposure, self._size)

    def whole(self, materials: list[Material], exposure: Exposure, *, bounces: int) -> Layer:
        """Objects and ground, with ``bounces`` of light between them."""
        self._dress(materials)
        integrator = {"type": "path", "max_depth": bounces + 1, "hide_emitters": True}
        return _photograph(
            self._dressed(ground=self._scene.ground), integrator, exposure, self._size
        )

    def backdrop(self, exposure: Exposure) -> Layer:
        """The ground under direct light with the shadows of the objects, which are black."""
        black = mi.load_dict({"type": "diffuse", "reflectance": 0.0})
        scene = self._load([black] * self._scene.n_materials, ground=self._scene.ground)
        return _photograph(scene, _direct(), exposure, self._size)

    def _dress(self, materials: list[Material]) -> None:
        if self._wardrobe.change(materials):
            self._scenes = {}

    def _dressed(self, *, ground: bool) -> list[Any]:
        if ground not in self._scenes:
            self._scenes[ground] = self._load(self._wardrobe.bsdfs, ground=ground)
        return self._scenes[ground]

    def _load(self, bsdfs: list[Any], *, ground: bool) -> list[Any]:
        """One scene for each light: their pictures add up, and no sample goes to choosing between lights."""
        window = None if ground else self._window()
        sensor = _sensor(self._scene.camera, self._size, window)
        description: dict[str, Any] = {"type": "scene", "sensor": sensor}
        for i, (place, mesh) in enumerate(zip(self._scene.objects, self._meshes, strict=True)):
            description[f"object_{i}"] = _shape(place, mesh, bsdfs[place.material])
        if ground:
            paper = mi.load_dict({"type": "diffuse", "reflectance": PAPER})
            description["ground"] = _mesh("ground", sweep(), paper)
        return [mi.load_dict({**description, "light": light}) for light in self._lights]

    def _window(self) -> Window:
        corners = [
            _box(place) if mesh is None else mesh.positions
            for place, mesh in zip(self._scene.objects, self._meshes, strict=True)
        ]
        return window(self._scene.camera, self._size, np.concatenate(corners))


def _direct() -> dict[str, Any]:
    return {"type": "direct", "hide_emitters": True}


def _photograph(
    scenes: list[Any], integrator: dict[str, Any], exposure: Exposure, size: tuple[int, int]
) -> Layer:
    """The layer of scenes that differ in their light, in the frame of ``size``; empty around the sensor's window."""
    if exposure.guides:
        aovs = "albedo:albedo,normal:sh_normal"
        integrator = {"type": "aov", "aovs": aovs, "inner": integrator}
    photographer = mi.load_dict(integrator)
    film = scenes[0].sensors()[0].film()
    (x, y), (width, height) = (tuple(map(int, v)) for v in (film.crop_offset(), film.crop_size()))
    passes = exposure.passes(width * height)
    takes = [(seed, scene) for seed in passes.seeds for scene in scenes]
    total = np.zeros((height, width, 10 if exposure.guides else 4), np.float32)
    for done, (seed, scene) in enumerate(takes, start=1):
        image = mi.render(scene, integrator=photographer, spp=passes.spp, seed=mi.UInt32(seed))
        total += np.array(image)
        exposure.progress(done, len(takes))
    total /= len(passes.seeds)
    # Each light's picture has brought the same coverage and guides.
    total[..., 3:] /= len(scenes)
    frame = np.zeros((size[1], size[0], 10), np.float32)
    frame[y : y + height, x : x + width, : total.shape[2]] = total
    return Layer(frame[..., :3], frame[..., 3:4], frame[..., 4:7], frame[..., 7:10])


def _meshes(scene: Scene, mesh: Path | None) -> list[Mesh | None]:
    """The mesh of each object; None for a sphere, which Mitsuba has itself."""
    own = None if mesh is None else read_mesh(mesh)
    if own is not None:
        return [placed(own, place) for place in scene.objects]
    return [
        placed(tessellate(), place) if place.shape == "teapot" else None for place in scene.objects
    ]


def _shape(place: Placed, mesh: Mesh | None, bsdf: Any) -> Any:
    if mesh is not None:
        return _mesh(place.shape, mesh, bsdf)
    x, y, z = place.at
    radius = place.height / 2
    return {"type": "sphere", "center": [x, y, z + radius], "radius": radius, "bsdf": bsdf}


def _mesh(kind: str, mesh: Mesh, bsdf: Any) -> Any:
    props = mi.Properties()
    props["mesh_bsdf"] = _both_sides(bsdf)
    shape = mi.Mesh(
        kind, len(mesh.positions), len(mesh.faces), has_vertex_normals=True, props=props
    )
    parameters = mi.traverse(shape)
    arrays = {
        "vertex_positions": mesh.positions,
        "vertex_normals": mesh.normals,
        "faces": mesh.faces,
    }
    for name, array in arrays.items():
        buffer: Any = type(parameters[name])
        parameters[name] = buffer(array.ravel())
    parameters.update()
    return shape


def _both_sides(bsdf: Any) -> Any:
    """Sheets, open shapes and meshes whose faces point anywhere show the material from behind too."""
    if mi.has_flag(bsdf.flags(), mi.BSDFFlags.BackSide):
        return bsdf
    return mi.load_dict({"type": "twosided", "bsdf": bsdf})


def _lights(scene: Scene, env: Path | None) -> list[dict[str, Any]]:
    if scene.points:
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


def _box(place: Placed) -> np.ndarray:
    """Corners of the cube around a sphere."""
    signs = np.array(np.meshgrid([-1, 1], [-1, 1], [0, 2])).reshape(3, -1).T
    return np.array(place.at) + signs * place.height / 2


def _sensor(camera: Camera, size: tuple[int, int], window: Window | None) -> dict[str, Any]:
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
        "fov": fov_degrees(camera, size),
        "fov_axis": "x",
        "to_world": mi.ScalarTransform4f(camera_to_world(camera)),
        "sampler": {"type": "multijitter"},
        "film": film,
    }
