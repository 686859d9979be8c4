"""A scene set up in Mitsuba, ready to be photographed.

Imported only after `halfway.render.variant.load_mitsuba` has chosen a variant.
"""

from pathlib import Path
from typing import Any

import mitsuba as mi
import numpy as np

from ..brdf import TabularBrdf
from ..errors import RenderError
from ..halfdiff import Grid
from . import bsdf as tables_in_mitsuba
from .mesh import Mesh, outward, placed, sweep
from .sampling import buffer
from .scenes import Placed, PointLight, Scene
from .studio import studio
from .teapot import tessellate

BACKGROUND = 0.03
"""Radiance behind the objects of a scene without a ground."""
PAPER = 0.75
"""Reflectance of the ground."""


class Stage:
    """The objects, lights and camera of a scene; its parts are compiled when first used."""

    def __init__(
        self, scene: Scene, *, size: tuple[int, int], env: Path | None, mesh: Path | None
    ) -> None:
        self._scene = scene
        self._meshes = _meshes(scene, mesh)
        self._lights = _lights(scene, env)
        self._sensor = _sensor(scene, size)
        self._grids: list[Grid] = []
        self._bsdfs: list[Any] = []
        self._scenes: dict[bool, Any] = {}

    def objects(self, tables: list[TabularBrdf], *, spp: int, seed: int) -> np.ndarray:
        """The objects under direct light, black around them, shape (height, width, 3)."""
        self._dress(tables)
        integrator = mi.load_dict({"type": "direct", "hide_emitters": True})
        return self._render(self._dressed(ground=False), integrator, spp, seed)

    def whole(self, tables: list[TabularBrdf], *, bounces: int, spp: int, seed: int) -> np.ndarray:
        """Objects and ground with ``bounces`` of light between them, shape (height, width, 3)."""
        self._dress(tables)
        integrator = mi.load_dict({"type": "path", "max_depth": bounces + 1, "hide_emitters": True})
        scene = self._dressed(ground=self._scene.ground)
        return self._over_background(self._render(scene, integrator, spp, seed, alpha=True))

    def backdrop(self, *, spp: int, seed: int) -> np.ndarray:
        """The ground under direct light with the shadows of the objects, which are black."""
        black = mi.load_dict({"type": "diffuse", "reflectance": 0.0})
        scene = self._load([black] * self._scene.n_materials, ground=self._scene.ground)
        integrator = mi.load_dict({"type": "direct", "hide_emitters": True})
        return self._over_background(self._render(scene, integrator, spp, seed, alpha=True))

    def _dress(self, tables: list[TabularBrdf]) -> None:
        grids = [table.grid for table in tables]
        if grids != self._grids:
            self._scenes = {}
            self._bsdfs = [tables_in_mitsuba.TableBsdf(mi.Properties(), table) for table in tables]
            self._grids = grids
            return
        for bsdf, table in zip(self._bsdfs, tables, strict=True):
            parameters = mi.traverse(bsdf)
            parameters["table"] = buffer(tables_in_mitsuba.pack(table))
            parameters.update()

    def _dressed(self, *, ground: bool) -> Any:
        if ground not in self._scenes:
            self._scenes[ground] = self._load(self._bsdfs, ground=ground)
        return self._scenes[ground]

    def _load(self, bsdfs: list[Any], *, ground: bool) -> Any:
        description: dict[str, Any] = {"type": "scene", "sensor": self._sensor, **self._lights}
        for i, (place, mesh) in enumerate(zip(self._scene.objects, self._meshes, strict=True)):
            bsdf = bsdfs[place.material]
            description[f"object_{i}"] = _shape(place, mesh, bsdf)
        if ground:
            paper = {"type": "diffuse", "reflectance": PAPER}
            bsdf = mi.load_dict({"type": "twosided", "bsdf": paper})
            description["ground"] = _mesh("ground", sweep(), bsdf)
        return mi.load_dict(description)

    def _render(
        self, scene: Any, integrator: Any, spp: int, seed: int, *, alpha: bool = False
    ) -> np.ndarray:
        image = np.array(mi.render(scene, integrator=integrator, spp=spp, seed=mi.UInt32(seed)))
        return image if alpha else image[..., :3]

    def _over_background(self, rgba: np.ndarray) -> np.ndarray:
        return rgba[..., :3] + BACKGROUND * (1 - rgba[..., 3:])


def _meshes(scene: Scene, mesh: Path | None) -> list[Mesh | None]:
    """The mesh of each object; None for a sphere, which Mitsuba has itself."""
    own = None if mesh is None else _read_mesh(mesh)
    replaced = "teapot" if any(o.shape == "teapot" for o in scene.objects) else "sphere"
    shapes: list[Mesh | None] = []
    for place in scene.objects:
        if own is not None and place.shape == replaced:
            shapes.append(placed(own, place))
        elif place.shape == "teapot":
            shapes.append(placed(tessellate(), place))
        else:
            shapes.append(None)
    return shapes


def _read_mesh(path: Path) -> Mesh:
    """The triangles of a ``.ply`` or ``.obj`` file, y up in the file, faces turned outward."""
    kind = _require_file(path, "mesh", (".ply", ".obj"))
    try:
        shape = mi.load_dict({"type": kind, "filename": str(path)})
        parameters = mi.traverse(shape)
        faces = np.array(parameters["faces"]).reshape(-1, 3)
        positions = np.array(parameters["vertex_positions"]).reshape(-1, 3)
        normals = np.array(parameters["vertex_normals"]).reshape(-1, 3)
    except RuntimeError as error:
        raise RenderError(f"The mesh {path} cannot be read: {_first_line(error)}") from error
    if not len(faces) or not np.isfinite(positions).all():
        raise RenderError(
            f"The mesh {path} has {len(faces)} triangles and {np.isnan(positions).sum()} missing coordinates: "
            "expected one or more triangles and none missing."
        )
    return outward(positions, normals, faces)


def _read_environment(path: Path) -> Any:
    _require_file(path, "environment", (".hdr", ".exr"))
    try:
        bitmap = mi.Bitmap(str(path)).convert(
            mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False
        )
    except RuntimeError as error:
        raise RenderError(f"The environment {path} cannot be read: {_first_line(error)}") from error
    radiance = np.array(bitmap)
    if not np.isfinite(radiance).all() or radiance.max() <= 0:
        raise RenderError(
            f"The environment {path} has radiance from {radiance.min()} to {radiance.max()}: "
            "expected finite values, some above 0."
        )
    return bitmap


def _require_file(path: Path, what: str, suffixes: tuple[str, ...]) -> str:
    """The suffix without its dot."""
    if path.suffix.lower() not in suffixes:
        raise RenderError(
            f"The {what} {path} is of an unknown kind: expected {' or '.join(suffixes)}."
        )
    if not path.is_file():
        raise RenderError(f"The {what} {path} does not exist.")
    return path.suffix.lower()[1:]


def _first_line(error: Exception) -> str:
    return str(error).strip().splitlines()[-1]


def _shape(place: Placed, mesh: Mesh | None, bsdf: Any) -> Any:
    if mesh is not None:
        return _mesh(place.shape, mesh, bsdf)
    x, y, z = place.at
    radius = place.height / 2
    return {"type": "sphere", "center": [x, y, z + radius], "radius": radius, "bsdf": bsdf}


def _mesh(name: str, mesh: Mesh, bsdf: Any) -> Any:
    props = mi.Properties()
    props["mesh_bsdf"] = bsdf
    shape = mi.Mesh(
        name, len(mesh.positions), len(mesh.faces), has_vertex_normals=True, props=props
    )
    parameters = mi.traverse(shape)
    parameters["vertex_positions"] = mi.Float(mesh.positions.ravel())
    parameters["vertex_normals"] = mi.Float(mesh.normals.ravel())
    parameters["faces"] = mi.UInt32(mesh.faces.ravel())
    parameters.update()
    return shape


def _lights(scene: Scene, env: Path | None) -> dict[str, Any]:
    if scene.points:
        return {f"light_{i}": _point(light) for i, light in enumerate(scene.points)}
    bitmap = mi.Bitmap(studio()) if env is None else _read_environment(env)
    T = mi.ScalarTransform4f
    # Mitsuba's environments have y up and their middle at +z; ours show +y there.
    to_world = T().rotate([0, 0, 1], 180) @ T().rotate([1, 0, 0], 90)
    return {"environment": {"type": "envmap", "bitmap": bitmap, "to_world": to_world}}


def _point(light: PointLight) -> dict[str, Any]:
    return {
        "type": "point",
        "position": list(light.at),
        "intensity": {"type": "rgb", "value": light.intensity},
    }


def _sensor(scene: Scene, size: tuple[int, int]) -> dict[str, Any]:
    camera = scene.camera
    return {
        "type": "perspective",
        "fov": camera.fov_degrees,
        "fov_axis": "smaller",
        "to_world": mi.ScalarTransform4f().look_at(
            origin=list(camera.at), target=list(camera.target), up=[0, 0, 1]
        ),
        "sampler": {"type": "multijitter"},
        "film": {
            "type": "hdrfilm",
            "width": size[0],
            "height": size[1],
            "pixel_format": "rgba",
            "component_format": "float32",
        },
    }
