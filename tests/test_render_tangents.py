"""Where the tangent of a surface points: to where its first texture coordinate grows, or else level around the vertical."""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose
from roughconductor import anisotropic

from halfway.render import Renderer
from halfway.render.assets import read_mesh
from halfway.render.mesh import Mesh, brushed, disc, placed
from halfway.render.scenes import Placed
from halfway.render.teapot import tessellate

SHEET = ["v 0 0 0", "v 1 0 0", "v 1 1 0", "v 0 1 0"]
"""Upright, y up."""
ALONG_X = ["vt 0 0", "vt 1 0", "vt 1 1", "vt 0 1"]
ALONG_Y = ["vt 0 1", "vt 0 0", "vt 1 0", "vt 1 1"]
FACE = "f 1/1 2/2 3/3 4/4"


def read(folder, lines, name: str = "mesh.obj") -> Mesh:
    (folder / name).write_text("\n".join(lines))
    return read_mesh(folder / name)


def tangents(mesh: Mesh) -> np.ndarray:
    """Of each face, unit: where u grows and v does not."""
    a, b, c = np.moveaxis(mesh.positions[mesh.faces].astype(float), 1, 0)
    (du1, dv1), (du2, dv2) = (np.moveaxis(mesh.uv[:, i] - mesh.uv[:, 0], -1, 0) for i in (1, 2))
    area = du1 * dv2 - du2 * dv1
    t = (dv2[:, None] * (b - a) - dv1[:, None] * (c - a)) * np.sign(area)[:, None]
    return t / np.linalg.norm(t, axis=-1, keepdims=True)


def middles(mesh: Mesh) -> np.ndarray:
    return mesh.positions[mesh.faces].mean(axis=1)


def test_those_of_the_pot_run_around_its_axis():
    mesh = tessellate(8)
    at, t = middles(mesh), tangents(mesh)
    r = np.hypot(at[:, 0], at[:, 1])
    body = (np.abs(at[:, 1]) > 0.9) & (r > 0.3)  # neither handle nor spout
    around = np.stack([-at[:, 1], at[:, 0], 0 * r], axis=-1)[body] / r[body, None]
    # A step is 90 / 8 degrees, and the middle of a triangle is no more than half of one beside its middle.
    assert np.einsum("ij,ij->i", t[body], around).min() > np.cos(np.radians(90 / 16))


def test_those_of_a_disc_run_around_its_middle():
    mesh = placed(disc(n=64), Placed("disc", height=2.0))
    assert mesh.positions[:, 2].min() == pytest.approx(0, abs=1e-6)
    assert np.hypot(*mesh.positions[:, :2].T).max() == pytest.approx(1, rel=1e-6)
    a, b, c = np.moveaxis(mesh.positions[mesh.faces].astype(float), 1, 0)
    across = np.cross(b - a, c - a)
    normal = across / np.linalg.norm(across, axis=-1, keepdims=True)
    assert_allclose(np.einsum("ij,ikj->ik", normal, mesh.normals[mesh.faces]).min(), 1, atol=2e-3)
    front = normal @ [0, -1, 0.4663] > 1  # leaning back by 25 degrees
    out = middles(mesh)[front] - middles(mesh)[front].mean(axis=0)
    out /= np.linalg.norm(out, axis=-1, keepdims=True)
    expected = np.cross(normal[front], out)
    assert np.einsum("ij,ij->i", tangents(mesh)[front], expected).min() > np.cos(np.radians(6))


@pytest.mark.parametrize(("textures", "expected"), [(ALONG_X, (1, 0, 0)), (ALONG_Y, (0, 0, 1))])
def test_those_of_a_file_are_its_own(tmp_path, textures, expected):
    mesh = read(tmp_path, [*SHEET, *textures, FACE])
    assert_allclose(tangents(mesh), [expected] * 2, atol=1e-6)


@pytest.mark.parametrize("names", ["u v", "s t", "texture_u texture_v"])
def test_ply_files_have_them_under_several_names(tmp_path, names):
    first, second = names.split()
    header = ["ply", "format ascii 1.0", "element vertex 3"]
    header += [f"property float {name}" for name in ("x", "y", "z", first, second)]
    header += ["element face 1", "property list uchar int vertex_indices", "end_header"]
    mesh = read(tmp_path, [*header, "0 0 0 0 0", "1 0 0 0 1", "0 1 0 1 0", "3 0 1 2"], "mesh.ply")
    assert_allclose(tangents(mesh), [(0, 0, 1)], atol=1e-6)


def test_faces_that_are_turned_keep_their_texture_coordinates(tmp_path):
    points = ["v 0 0 0", "v 1 0 0", "v 0 1 0", "v 0 0 1", *ALONG_X[:3]]
    faces = ["f 1/1 3/3 2/2", "f 1/1 2/2 4/3", "f 1/1 4/3 3/2", "f 2/1 3/2 4/3"]
    inward = ["f " + " ".join(reversed(face.split()[1:])) for face in faces]
    right, turned = (read(tmp_path, [*points, *these]) for these in (faces, inward))
    of_corners = [
        {(*mesh.positions[i], *uv) for i, uv in zip(mesh.faces.ravel(), mesh.uv.reshape(-1, 2), strict=True)}
        for mesh in (right, turned)
    ]  # fmt: skip
    assert of_corners[0] == of_corners[1]


@pytest.mark.parametrize(
    "lines",
    [
        ["f 1 2 3 4"],
        [*ALONG_X, "f 1/1 2/2 3/3 4"],
        [*ALONG_X, "f 1/1 2/2 3/3 4/9"],
        [*ALONG_X[:3], "vt 0", FACE],
        [*ALONG_X[:3], "vt nan 0", FACE],
    ],
    ids=["none", "one is missing", "of none", "one number", "no number"],
)
def test_without_texture_coordinates_they_run_level(tmp_path, lines):
    mesh = read(tmp_path, [*SHEET, *lines])
    assert mesh.uv is None
    assert_allclose(np.abs(tangents(brushed(mesh))), [(1, 0, 0)] * 2, atol=1e-6)


def test_level_ones_are_counter_clockwise_from_above_and_along_x_on_level_faces():
    mesh = brushed(tessellate(8)._replace(uv=None))
    t, n = tangents(mesh), mesh.normals[mesh.faces].mean(axis=1)
    around = np.stack([-n[:, 1], n[:, 0], 0 * n[:, 0]], axis=-1)
    assert np.abs(t[:, 2]).max() < 1e-5
    assert np.median(np.einsum("ij,ij->i", t, around)) > 0.7
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    level = brushed(Mesh.of(corners, np.tile([0, 0, 1], (3, 1)), np.array([[0, 1, 2]])))
    assert_allclose(tangents(level), [(1, 0, 0)], atol=1e-6)


def test_a_sheet_whose_tangent_is_turned_is_one_whose_material_is(tmp_path):
    brdf = anisotropic(0.05, 0.3)
    pictures = []
    for textures, turn in ((ALONG_X, 90.0), (ALONG_Y, 0.0), (ALONG_X, 0.0)):
        read(tmp_path, [*SHEET, *textures, FACE])
        path = tmp_path / "mesh.obj"
        renderer = Renderer("spheres", size=(32, 32), spp=4, mesh=path, turn_degrees=turn)
        pictures.append(renderer.picture(brdf))
    assert_allclose(pictures[0], pictures[1], atol=2e-3 * pictures[1].max())
    assert np.abs(pictures[2] - pictures[1]).max() > 0.1 * pictures[1].max()


def test_a_mesh_that_does_not_say_is_said_where_it_matters(tmp_path):
    read(tmp_path, [*SHEET, "f 1 2 3 4"])
    renderer = Renderer("sphere", size=(8, 8), spp=1, mesh=tmp_path / "mesh.obj")
    with pytest.warns(UserWarning, match=r"mesh\.obj has no texture coordinates, which say where"):
        renderer.picture(anisotropic(0.2, 0.4))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        renderer.picture({"type": "diffuse"})
