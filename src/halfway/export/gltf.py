"""A fitted model as a glTF 2.0 asset: a sphere that wears it, three lights and a camera.

    .gltf    JSON, with the mesh inside as a data URI
    .glb     the same in a binary container:  "glTF", version 2, length;  then chunks of (length, type, data), padded to 4 bytes

Nothing lies beside the file. An extension is used where its parameters do something: KHR_materials_ior, KHR_materials_specular,
KHR_materials_clearcoat, KHR_materials_anisotropy for the material, whose sphere has tangents then, level around the vertical; KHR_lights_punctual for the lights, whose unit is the lux. What a viewer without an exposure
shows as well lit is some lux; Blender takes that for moonlight (divided by 683 lm/W), unless it imports "Unitless".

Source: Khronos Group, glTF 2.0 specification, sections 3 (concepts), 4 (GLB), 5 (properties), and the extensions named above.
"""

import base64
import json
import struct
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from ..errors import OutputError
from ..fit import Fit, Gltf

N_RINGS, N_SEGMENTS = 32, 64
_LIGHTS = (((-4.0, 6.0, 5.0), 2.4), ((5.5, 2.0, 4.0), 0.8), ((4.5, 5.0, -3.0), 1.4))
"""Where directional lights come from, and how bright they are."""
_CAMERA_DISTANCE, _FIELD_OF_VIEW = 6.0, 0.4

FLOAT, UNSIGNED_SHORT = 5126, 5123
VERTICES, INDICES = 34962, 34963
"""The numbers of the specification, sections 5.1 and 5.11."""


def to_gltf(fit: Fit) -> bytes:
    """The asset as JSON, UTF-8, the mesh inside."""
    buffer = base64.b64encode(_sphere_of(fit).data).decode()
    document = _document(fit, {"uri": f"data:application/octet-stream;base64,{buffer}"})
    return json.dumps(document, indent=1).encode()


def to_glb(fit: Fit) -> bytes:
    """The asset as one binary file."""
    text = json.dumps(_document(fit, {}), separators=(",", ":")).encode()
    chunks = b"".join(
        struct.pack("<I4s", len(data), kind) + data
        for kind, data in (
            (b"JSON", _padded(text, b" ")),
            (b"BIN\0", _padded(_sphere_of(fit).data, b"\0")),
        )
    )
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def to_material(model: Gltf, name: str) -> dict[str, Any]:
    """The model as a glTF material."""
    colour, f0 = model.base_color.tolist(), model.specular_color.tolist()
    material: dict[str, Any] = {
        "name": name or "material",
        "pbrMetallicRoughness": {
            "baseColorFactor": [*colour, 1.0],
            "metallicFactor": model.metallic,
            "roughnessFactor": model.roughness,
        },
    }
    extensions = {
        "KHR_materials_ior": (model.ior != 1.5, {"ior": model.ior}),
        "KHR_materials_specular": (
            model.specular < 1 or min(f0) < 1,
            {"specularFactor": model.specular, "specularColorFactor": f0},
        ),
        "KHR_materials_clearcoat": (
            model.clearcoat > 0,
            {
                "clearcoatFactor": model.clearcoat,
                "clearcoatRoughnessFactor": model.clearcoat_roughness,
            },
        ),
        "KHR_materials_anisotropy": (
            not model.is_isotropic,
            {
                "anisotropyStrength": model.anisotropy_strength,
                "anisotropyRotation": model.anisotropy_rotation,
            },
        ),
    }
    used = {name: values for name, (matters, values) in extensions.items() if matters}
    return {**material, "extensions": used} if used else material


class Mesh(NamedTuple):
    """A sphere of radius 1: 16-bit indices, then positions, which are the normals too; then tangents, if it has them."""

    indices: np.ndarray
    positions: np.ndarray
    tangents: np.ndarray | None

    @property
    def data(self) -> bytes:
        """The buffer."""
        return b"".join(part.tobytes() for part in self if part is not None)


def _document(fit: Fit, buffer: dict[str, Any]) -> dict[str, Any]:
    if not isinstance(fit.model, Gltf):
        raise OutputError(
            f"glTF has no material for the model {fit.model_name}: expected gltf. Fit it with --model gltf."
        )
    mesh = _sphere_of(fit)
    material = to_material(fit.model, fit.name)
    camera = {"yfov": _FIELD_OF_VIEW, "znear": 0.1, "zfar": 100.0, "aspectRatio": 1.0}
    lights = [{"type": "directional", "intensity": intensity} for _, intensity in _LIGHTS]
    return {
        "asset": {"version": "2.0", "generator": "halfway"},
        "extensionsUsed": ["KHR_lights_punctual", *material.get("extensions", {})],
        "extensions": {"KHR_lights_punctual": {"lights": lights}},
        "scene": 0,
        "scenes": [{"nodes": list(range(2 + len(_LIGHTS)))}],
        "nodes": [
            {"name": "sphere", "mesh": 0},
            {"name": "camera", "camera": 0, "translation": [0.0, 0.0, _CAMERA_DISTANCE]},
            *(_light(i, direction) for i, (direction, _) in enumerate(_LIGHTS)),
        ],
        "cameras": [{"type": "perspective", "perspective": camera}],
        "materials": [{**material, "extras": {"fit": fit.to_json()["error"]}}],
        **_geometry(mesh),
        "buffers": [{**buffer, "byteLength": len(mesh.data)}],
    }


def _geometry(mesh: Mesh) -> dict[str, Any]:
    """The sphere as glTF says where it is in the buffer."""
    bounds = {"min": [-1.0, -1.0, -1.0], "max": [1.0, 1.0, 1.0]}
    parts = [
        (mesh.indices, INDICES, UNSIGNED_SHORT, {"type": "SCALAR"}),
        (mesh.positions, VERTICES, FLOAT, {"type": "VEC3", **bounds}),
    ]
    attributes = {"POSITION": 1, "NORMAL": 1}
    if mesh.tangents is not None:
        parts.append((mesh.tangents, VERTICES, FLOAT, {"type": "VEC4"}))
        attributes["TANGENT"] = 2
    accessors, views, start = [], [], 0
    for i, (part, target, component, shape) in enumerate(parts):
        accessors.append({"bufferView": i, "componentType": component, "count": len(part), **shape})
        offset = {"byteOffset": start} if start else {}
        views.append({"buffer": 0, **offset, "byteLength": part.nbytes, "target": target})
        start += part.nbytes
    primitive = {"attributes": attributes, "indices": 0, "material": 0}
    return {
        "meshes": [{"name": "sphere", "primitives": [primitive]}],
        "accessors": accessors,
        "bufferViews": views,
    }


def _sphere_of(fit: Fit) -> Mesh:
    return _sphere(with_tangents=not fit.model.is_isotropic)


@cache
def _sphere(*, with_tangents: bool) -> Mesh:
    ring, segment = (x.ravel() for x in np.mgrid[0 : N_RINGS + 1, 0 : N_SEGMENTS + 1])
    theta, phi = np.pi * ring / N_RINGS, 2 * np.pi * segment / N_SEGMENTS
    sin = np.where(ring % N_RINGS, np.sin(theta), 0)
    positions = np.stack([sin * np.sin(phi), np.cos(theta), sin * np.cos(phi)], axis=-1)
    # Eighths of a turn meet the axes exactly, so that the bounds are 1.
    positions = np.round(positions, 9).astype("<f4")
    corner = (np.arange(N_RINGS)[:, None] * (N_SEGMENTS + 1) + np.arange(N_SEGMENTS)).ravel()
    below = corner + N_SEGMENTS + 1
    upper = np.stack([corner, below, corner + 1], axis=-1)[N_SEGMENTS:]
    lower = np.stack([corner + 1, below, below + 1], axis=-1)[:-N_SEGMENTS]
    indices = np.concatenate([upper, lower]).ravel().astype("<u2")
    tangents = np.stack([np.cos(phi), 0 * phi, -np.sin(phi), np.ones_like(phi)], axis=-1)
    return Mesh(indices, positions, tangents.astype("<f4") if with_tangents else None)


def _light(i: int, direction: tuple[float, float, float]) -> dict[str, Any]:
    """A node that turns -z, where a light shines to, away from ``direction``."""
    x, y, z = np.array(direction) / np.linalg.norm(direction)
    # The shortest turn of +z to the direction, as a quaternion (x, y, z, w).
    turn = np.array([-y, x, 0, 1 + z])
    rotation = (turn / np.linalg.norm(turn)).tolist()
    return {
        "name": f"light {i + 1}",
        "rotation": rotation,
        "extensions": {"KHR_lights_punctual": {"light": i}},
    }


def _padded(data: bytes, filler: bytes) -> bytes:
    return data + filler * (-len(data) % 4)
