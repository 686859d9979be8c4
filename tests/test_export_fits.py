"""Fits as files: what a strict reader of each format finds in them."""

import base64
import json
import struct
from importlib import import_module
from typing import Any

import numpy as np
import pytest
from fits import NAMES, OPENPBR, a_fit
from numpy.testing import assert_allclose

from halfway.errors import OutputError
from halfway.export.fits import write_fit
from halfway.export.gltf import to_glb, to_gltf
from halfway.export.materialx import identifier
from halfway.fit import Gltf, OpenPbr, Principled

BYTES = {5126: 4, 5123: 2}
COMPONENTS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}
# Of each extension, the factors and what they may be: KHR_materials_ior, _specular, _clearcoat, _anisotropy.
EXTENSIONS = {
    "KHR_materials_ior": {"ior"},
    "KHR_materials_specular": {"specularFactor", "specularColorFactor"},
    "KHR_materials_clearcoat": {"clearcoatFactor", "clearcoatRoughnessFactor"},
    "KHR_materials_anisotropy": {"anisotropyStrength", "anisotropyRotation"},
}


PLAIN = Gltf(np.array([0.8, 0.4, 0.2]), metallic=0.3, roughness=0.4)
RICH = Gltf(
    np.array([0.8, 0.4, 0.2]), 0.1, 0.5, 1.7, 0.9, np.array([1, 0.5, 0.25]), 0.6, 0.125
)  # fmt: skip
BRUSHED = Gltf(
    np.array([0.8, 0.4, 0.2]),
    metallic=1.0,
    roughness=0.3,
    anisotropy_strength=0.5,
    anisotropy_rotation=1.25,
)


@pytest.mark.parametrize(
    ("model", "node"), [(OPENPBR, "open_pbr_surface"), (RICH, "gltf_pbr")], ids=["openpbr", "gltf"]
)
def test_a_materialx_document_is_valid_and_holds_the_fit(model, node, tmp_path):
    mx: Any = import_module("MaterialX")
    write_fit(tmp_path / "a.mtlx", a_fit(model))
    document, library = mx.createDocument(), mx.createDocument()
    mx.loadLibraries(mx.getDefaultDataLibraryFolders(), mx.getDefaultDataSearchPath(), library)
    mx.readFromXmlFile(document, str(tmp_path / "a.mtlx"))
    document.setDataLibrary(library)
    assert document.validate() == (True, "")
    (surface,) = document.getNodes(node)
    left_out = model.grain if model.is_isotropic else ("tangent_rotation",)
    parameters = {name: x for name, x in model.parameters().items() if name not in left_out}
    for name, value in parameters.items():
        written = surface.getInputValue(name)
        assert_allclose(written.asTuple() if isinstance(value, list) else written, value, rtol=1e-6)
    (material,) = document.getMaterialNodes()
    assert material.getConnectedNode("surfaceshader").getName() == surface.getName()
    assert "40.0 dB" in material.getDocString()


def test_a_turned_tangent_is_a_node_of_its_own(tmp_path):
    """Turned as MaterialX's own graph turns that of glTF: less than 0 is counter-clockwise."""
    mx: Any = import_module("MaterialX")
    turned = OpenPbr(
        np.array([0.5, 0.4, 0.3]),
        base_metalness=1.0,
        specular_roughness_anisotropy=0.5,
        tangent_rotation=np.pi / 6,
    )
    write_fit(tmp_path / "a.mtlx", a_fit(turned))
    document = mx.createDocument()
    mx.readFromXmlFile(document, str(tmp_path / "a.mtlx"))
    (surface,) = document.getNodes("open_pbr_surface")
    node = surface.getConnectedNode("geometry_tangent")
    assert node.getCategory() == "rotate3d"
    assert_allclose(node.getInputValue("amount"), -30, rtol=1e-6)
    sources = [node.getConnectedNode(port).getCategory() for port in ("in", "axis")]
    assert sources == ["tangent", "normal"]


@pytest.mark.parametrize("name", NAMES)
def test_a_name_in_materialx_is_a_usd_identifier_beside_the_true_one(name, tmp_path):
    """USD's MaterialX reader makes a prim of each name: the binding must parse, and a prim of that name be made."""
    from pxr import Sdf, Usd

    mx: Any = import_module("MaterialX")
    write_fit(tmp_path / "a.mtlx", a_fit(OPENPBR, name))
    document = mx.createDocument()
    mx.readFromXmlFile(document, str(tmp_path / "a.mtlx"))
    (material,) = document.getMaterialNodes()
    (surface,) = document.getNodes("open_pbr_surface")
    for made in (material.getName(), surface.getName()):
        assert made.isascii()
        assert Sdf.Path.IsValidIdentifier(made)
        assert Usd.Stage.CreateInMemory().DefinePrim(f"/MaterialX/Materials/{made}").IsValid()
    shown = "".join(c if c.isprintable() else "\ufffd" for c in name)
    assert material.getAttribute("uiname") == shown
    assert material.getDocString().startswith(f"{shown}, as OpenPBR")


def test_names_that_look_alike_stay_apart():
    assert len({identifier(name) for name in NAMES}) == len(NAMES)
    assert [identifier(name) for name in ("gold-paint", "my_gold", "001")] == ["gold_paint", "my_gold", "_001"]  # fmt: skip


@pytest.mark.parametrize("model", [PLAIN, RICH, BRUSHED], ids=["plain", "rich", "brushed"])
def test_a_gltf_keeps_the_rules_of_the_specification(model):
    document = json.loads(to_gltf(a_fit(model)))
    (buffer,) = document["buffers"]
    head, data = buffer["uri"].split(",")
    assert head == "data:application/octet-stream;base64"
    require_valid(document, base64.b64decode(data))


@pytest.mark.parametrize("model", [PLAIN, RICH, BRUSHED], ids=["plain", "rich", "brushed"])
def test_a_glb_is_the_same_in_a_binary_container(model):
    data = to_glb(a_fit(model))
    magic, version, n_bytes = struct.unpack_from("<4sII", data)
    assert (magic, version, n_bytes) == (b"glTF", 2, len(data))
    n_json, kind = struct.unpack_from("<I4s", data, 12)
    assert (kind, n_json % 4) == (b"JSON", 0)
    n_bin, kind = struct.unpack_from("<I4s", data, 20 + n_json)
    assert (kind, n_bin % 4, 28 + n_json + n_bin) == (b"BIN\0", 0, len(data))
    document = json.loads(data[20 : 20 + n_json])
    mesh = data[28 + n_json :]
    require_valid(document, mesh)
    text = json.loads(to_gltf(a_fit(model)))
    del text["buffers"][0]["uri"]
    assert document == text


def require_valid(document: dict[str, Any], data: bytes) -> None:
    """Rules of sections 3 and 5 that concern what we write: references, sizes, bounds, units, ranges, extensions."""
    assert document["asset"]["version"] == "2.0"
    assert document["buffers"][0]["byteLength"] <= len(data)
    arrays = [accessed(document, i, data) for i in range(len(document["accessors"]))]
    for accessor, array in zip(document["accessors"], arrays, strict=True):
        if "min" in accessor:
            assert_allclose(array.min(axis=0), accessor["min"])
            assert_allclose(array.max(axis=0), accessor["max"])
    indices, positions, *tangents = arrays
    for t in tangents:
        assert_allclose(np.linalg.norm(t[:, :3], axis=1), 1, atol=1e-6)
        assert_allclose(np.einsum("nk,nk->n", t[:, :3], positions), 0, atol=1e-6)
        assert_allclose(t[:, 1], 0)  # level
        assert (t[:, 3] == 1).all()
    assert bool(tangents) == ("KHR_materials_anisotropy" in document["extensionsUsed"])
    assert indices.max() < len(positions) < 65535
    assert_allclose(np.linalg.norm(positions, axis=1), 1, atol=1e-6)  # they are the normals too
    a, b, c = positions[indices.reshape(-1, 3)].transpose(1, 0, 2)
    faces = np.cross(b - a, c - a)
    assert (np.einsum("nk,nk->n", faces, a + b + c) > 0).all()  # counter-clockwise from outside
    # A closed surface: its volume, by the divergence theorem, is nearly the sphere's.
    assert_allclose(np.einsum("nk,nk->", a, faces) / 6, 4 / 3 * np.pi, rtol=0.02)
    assert document["scenes"][document["scene"]]["nodes"] == list(range(len(document["nodes"])))
    for node in document["nodes"]:
        if "rotation" in node:
            assert_allclose(np.linalg.norm(node["rotation"]), 1, atol=1e-6)
    require_valid_material(document)


def require_valid_material(document: dict[str, Any]) -> None:
    (material,) = document["materials"]
    used = set(document["extensionsUsed"])
    assert len(document["extensionsUsed"]) == len(used)
    extensions = material.get("extensions", {})
    assert used == {"KHR_lights_punctual", *extensions}
    for name, values in extensions.items():
        assert set(values) == EXTENSIONS[name]
    surface = material["pbrMetallicRoughness"]
    factors = [surface["metallicFactor"], surface["roughnessFactor"], *surface["baseColorFactor"]]
    assert all(0 <= factor <= 1 for factor in factors)
    assert extensions.get("KHR_materials_ior", {"ior": 1.5})["ior"] >= 1
    lights = document["extensions"]["KHR_lights_punctual"]["lights"]
    assert all(light["type"] == "directional" and light["intensity"] >= 0 for light in lights)


def accessed(document: dict[str, Any], i: int, data: bytes) -> np.ndarray:
    accessor = document["accessors"][i]
    view = document["bufferViews"][accessor["bufferView"]]
    start, size = view.get("byteOffset", 0), BYTES[accessor["componentType"]]
    n = COMPONENTS[accessor["type"]]
    assert start % 4 == 0
    assert start + view["byteLength"] <= document["buffers"][view["buffer"]]["byteLength"]
    assert accessor["count"] * n * size <= view["byteLength"]
    kind = "<f4" if size == 4 else "<u2"
    array = np.frombuffer(data, kind, accessor["count"] * n, start)
    return array.reshape(-1, n) if n > 1 else array


def test_a_light_shines_away_from_where_it_stands():
    """A light shines along -z of its node; the first comes from the upper left, before the sphere."""
    document = json.loads(to_gltf(a_fit(PLAIN)))
    x, y, z, w = document["nodes"][2]["rotation"]
    back = np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
    assert_allclose(back, np.array([-4, 6, 5]) / np.sqrt(77), atol=1e-12)


def test_what_does_nothing_is_left_out():
    (material,) = json.loads(to_gltf(a_fit(PLAIN)))["materials"]
    assert "extensions" not in material
    (material,) = json.loads(to_gltf(a_fit(RICH)))["materials"]
    assert material["pbrMetallicRoughness"] == {
        "baseColorFactor": [0.8, 0.4, 0.2, 1.0],
        "metallicFactor": 0.1,
        "roughnessFactor": 0.5,
    }
    assert material["extensions"] == {
        "KHR_materials_ior": {"ior": 1.7},
        "KHR_materials_specular": {"specularFactor": 0.9, "specularColorFactor": [1, 0.5, 0.25]},
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.6, "clearcoatRoughnessFactor": 0.125},
    }


@pytest.mark.parametrize(
    ("file", "model", "message"),
    [
        ("a.mtlx", Principled(PLAIN.base_color), "MaterialX has no node for the model principled"),
        ("a.glb", OPENPBR, "glTF has no material for the model openpbr: expected gltf"),
        ("a.obj", PLAIN, "suffix '.obj', which names no format of fitted models: expected .mtlx"),
    ],
)
def test_a_format_that_cannot_hold_the_model_says_so(file, model, message, tmp_path):
    with pytest.raises(OutputError, match=message):
        write_fit(tmp_path / file, a_fit(model))
    assert not list(tmp_path.iterdir())


def test_json_holds_any_model(tmp_path):
    write_fit(tmp_path / "a.json", a_fit(Principled(PLAIN.base_color, roughness=0.25)))
    document = json.loads((tmp_path / "a.json").read_text())
    assert (document["model"], document["parameters"]["roughness"]) == ("principled", 0.25)
