"""OBJ files as programs write them; what a mesh is made of once it is read, and where a scene puts it."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from halfway.errors import RenderError
from halfway.render.assets import read_mesh
from halfway.render.mesh import placed
from halfway.render.scenes import Placed

POINTS = ["v 0 0 0", "v 1 0 0", "v 0 1 0", "v 0 0 1"]
FACES = ["f 1 3 2", "f 1 2 4", "f 1 4 3", "f 2 3 4"]
NORMALS = ["vn 0 0 -1", "vn 0 -1 0", "vn -1 0 0", "vn 3 3 3"]
SHARP = ["f 1//1 3//1 2//1", "f 1//2 2//2 4//2", "f 1//3 4//3 3//3", "f 2//4 3//4 4//4"]


def read(folder, content):
    content = content if isinstance(content, bytes) else "\n".join(content).encode()
    (folder / "x.obj").write_bytes(content)
    return read_mesh(folder / "x.obj")


def volume(mesh):
    a, b, c = np.moveaxis(mesh.positions[mesh.faces].astype(float), 1, 0)
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


@pytest.mark.parametrize(
    "content",
    [
        [*POINTS, *FACES],
        [*POINTS, *FACES, ""],
        [*POINTS, "f -4 -2 -3", "f -4 -3 -1", "f -4 -1 -2", "f -3 -2 -1"],
        # Counted back from where the face stands: the first comes before the last point.
        [*POINTS[:3], "f -3 -1 -2", POINTS[3], "f -4 -3 -1", "f -4 -1 -2", "f 2 3 -1"],
        [line.replace(" ", "\t") for line in [*POINTS, *FACES]],
        [f"  {line} \t" for line in [*POINTS, *FACES]],
        [*POINTS, "vt 0 0", "f 1/1 3/1 2/1", "f 1/1/ 2/1/ 4/1/", "f 1// 4/ 3", "f 2/1 3 4/1"],
        ["\ufeff" + POINTS[0], *POINTS[1:], "mtllib ../../secret.mtl", "o a", "g b c", "usemtl d", "s 1", *FACES, "l 1 2", "p 3"],
        [*POINTS, "f 1 \\", "3 2", *FACES[1:]],
        ["# f 1 2 3 \\", *(line + " # why 1" for line in [*POINTS, *FACES])],
        [f"{POINTS[0]} 1.0", *(line + " .5 .25 1" for line in POINTS[1:]), *FACES],
        "\r\n".join([*POINTS, "f 1 \\", "3 2", *FACES[1:]]).encode(),
        "\r".join([*POINTS, *FACES]).encode(),
        [*POINTS, "vp 1 2", "vn 0 0 1", *FACES, "f 1 2", "f 4"],
        [*FACES, *POINTS],
    ],
    ids=["plain", "last line", "counted back", "back from there", "tabs", "blanks", "textures", "names", "goes on",
         "comments", "colours", "DOS", "old Mac", "too few corners", "faces first"],
)  # fmt: skip
def test_the_same_tetrahedron(tmp_path, content):
    mesh = read(tmp_path, content)
    assert len(mesh.positions) == 4
    assert len({frozenset(face) for face in mesh.faces.tolist()}) == len(mesh.faces) == 4
    assert volume(mesh) == pytest.approx(1 / 6)
    assert_allclose(
        mesh.positions[0], (-0.5, 0.5, -0.5)
    )  # of (0, 0, 0), z up, the middle at the origin


def test_hard_edges_stay_hard_and_what_has_no_normal_gets_one(tmp_path):
    mesh = read(tmp_path, [*POINTS, *NORMALS, *SHARP])
    assert len(mesh.positions) == 12
    a, b, c = np.moveaxis(mesh.positions[mesh.faces], 1, 0)
    across = np.cross(b - a, c - a)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    for corner in range(3):
        assert_allclose(mesh.normals[mesh.faces[:, corner]], across, atol=1e-6)
    mixed = read(tmp_path, [*POINTS, *NORMALS, *SHARP[:2], *FACES[2:]])
    assert_allclose(np.linalg.norm(mixed.normals, axis=1), 1, atol=1e-6)
    assert volume(mixed) == pytest.approx(1 / 6)


@pytest.mark.parametrize("side", [1, -1])
def test_faces_and_normals_may_point_inward(tmp_path, side):
    """Either of them: the mesh is that of the faces and normals that point outward."""
    right = read(tmp_path, [*POINTS, *NORMALS, *SHARP])
    normals = [f"vn {' '.join(str(side * float(x)) for x in line.split()[1:])}" for line in NORMALS]
    inward = [" ".join(["f", *reversed(line.split()[1:])]) for line in SHARP]
    turned = read(tmp_path, [*POINTS, *normals, *inward])
    assert volume(turned) == pytest.approx(1 / 6)
    assert_allclose(turned.normals, right.normals, atol=1e-7)


def test_a_sheet_that_is_there_from_both_sides_has_normals(tmp_path):
    """Its faces cancel at every corner."""
    mesh = read(tmp_path, [*POINTS[:3], "f 1 2 3", "f 3 2 1"])
    assert_allclose(np.abs(mesh.normals), [(0, 1, 0)] * 3)


def test_a_mesh_far_from_its_origin_keeps_its_shape(tmp_path):
    """Surveyors' coordinates: single precision has steps of half a metre there."""
    points = [f"v {x} {y} {z}" for x, y, z in 4.5e6 + np.eye(4, 3, -1)]
    mesh = read(tmp_path, [*points, *FACES])
    assert volume(mesh) == pytest.approx(1 / 6, rel=1e-6)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ([*POINTS], "has 0 faces, none of three corners or more"),
        ([*POINTS, "f 1 2"], "has 1 faces, none of three corners or more"),
        ([*FACES], "has faces of points 0 to 3: expected 0 to -1"),
        ([*POINTS, "f 1 2 5"], "has faces of points 0 to 4: expected 0 to 3"),
        ([*POINTS, "f 1 2 0"], "has faces of points -1 to 1: expected 0 to 3"),
        ([*POINTS, "f 1 2 -5"], "has faces of points -2 to 1: expected 0 to 3"),
        ([*POINTS, "f 1//1 2 3"], "has faces of normals -1 to 0"),
        ([*POINTS, *NORMALS, "f 1//-5 2 3"], "has faces of normals -2 to -1: expected 0 to 3"),
        ([*POINTS, "f 1 2 x"], "has a face of something else than numbers"),
        ([*POINTS, "f 1 2 1_0"], "has a face of something else than numbers"),
        ([*POINTS, "f 1 2 /3"], "has a face of something else than numbers"),
        ([*POINTS, f"f 1 2 {10**30}"], "has a face of something else than numbers"),
        ([*POINTS, "f 1 2 3.5"], "has a face of something else than numbers"),
        ([*POINTS, "v 1 2", *FACES], "has a line v or vn of something else than numbers"),
        ([*POINTS, "v 1,5 2,0 3,0", *FACES], "has a line v or vn of something else than numbers"),
        (["v nan 0 0", *POINTS[1:], *FACES], "has coordinates that are missing"),
        (["v 0 0 0"] * 4 + FACES, "is 0 wide: expected more than a point"),
        (b"", "has 0 faces"),
        (b"\0\xff" * 100, "has 0 faces"),
    ],
)
def test_a_damaged_mesh_says_what_is_wrong(tmp_path, content, message):
    with pytest.raises(RenderError, match=message) as said:
        read(tmp_path, content)
    assert str(said.value).isprintable()


SHEETS = {
    "on the ground": [(0, 0, 0), (0, 0, 4), (2, 0, 4), (2, 0, 0)],
    "upright": [(0, 0, 0), (4, 0, 0), (4, 2, 0), (0, 2, 0)],
    "a thin board": [(0, 0, 0), (0, 0, 4), (2, 0.01, 4), (2, 0, 0)],
}


@pytest.mark.parametrize("points", SHEETS.values(), ids=SHEETS)
@pytest.mark.parametrize("shape", ["sphere", "teapot"])
def test_a_sheet_is_as_large_as_there_is_room(tmp_path, points, shape):
    mesh = read(tmp_path, [*(f"v {x} {y} {z}" for x, y, z in points), "f 1 2 3 4"])
    place = Placed(shape, at=(1.0, 2.0, 0.0), height=2.0, turn_degrees=30.0)
    positions = placed(mesh, place).positions
    assert_allclose(positions[:, 2].min(), 0, atol=1e-6)
    radius = np.hypot(*(positions[:, :2] - [1, 2]).T).max()
    height = positions[:, 2].max()
    assert max(2 * radius / place.width, height / place.height) == pytest.approx(1, rel=1e-6)
