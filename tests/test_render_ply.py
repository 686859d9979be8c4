"""PLY files: as Mitsuba reads them, as other programs write them, and what Mitsuba's reader would not survive."""

import struct

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from halfway.errors import RenderError
from halfway.render.assets import read_mesh
from halfway.render.variant import load_mitsuba

POINTS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
MIDDLE = np.array([0.5, -0.5, 0.5])
"""Of the tetrahedron's box, z up."""
BINARY = "binary_little_endian"


def header(kind=BINARY, n_vertices=4, n_faces=4, more="", list_="list uchar int vertex_indices"):
    xyz = "".join(f"property float {axis}\n" for axis in "xyz")
    return f"ply\nformat {kind} 1.0\ncomment a tetrahedron\nelement vertex {n_vertices}\n{xyz}{more}element face {n_faces}\nproperty {list_}\nend_header\n".encode()


def vertices(order="<", points=POINTS):
    return b"".join(struct.pack(f"{order}3f", *p) for p in points)


def faces(order="<", faces=FACES):
    return b"".join(struct.pack(f"{order}B{len(f)}i", len(f), *f) for f in faces)


TEXT = "\n".join([*(f"{x} {y} {z}" for x, y, z in POINTS), *(f"3 {a} {b} {c}" for a, b, c in FACES)]).encode()  # fmt: skip


def volume(mesh):
    """By the divergence theorem; positive where the faces point outward."""
    a, b, c = np.moveaxis(mesh.positions[mesh.faces].astype(float), 1, 0)
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def read(tmp_path, content):
    (tmp_path / "x.ply").write_bytes(content)
    return read_mesh(tmp_path / "x.ply")


@pytest.mark.parametrize(
    "content",
    [
        header() + vertices() + faces(),
        header("binary_big_endian") + vertices(">") + faces(">"),
        header("ascii") + TEXT,
        header().replace(b"\n", b"\r\n").replace(b"end_header\r\n", b"end_header\n") + vertices() + faces(),
    ],
    ids=["little", "big", "text", "lines of another system"],
)  # fmt: skip
def test_a_tetrahedron_comes_back_with_z_up_and_faces_outward(tmp_path, content):
    mesh = read(tmp_path, content)
    assert_allclose(mesh.positions + MIDDLE, [(x, -z, y) for x, y, z in POINTS])
    assert volume(mesh) == pytest.approx(1 / 6)


def test_equals_mitsuba(shared_data):
    mi = load_mitsuba()
    path = shared_data / "meshes" / "dragon_res3.ply"
    mesh = read_mesh(path)
    with mi.variant_context("scalar_rgb"):
        theirs = mi.traverse(mi.load_dict({"type": "ply", "filename": str(path)}))
        positions = np.array(theirs["vertex_positions"]).reshape(-1, 3)
        indices = np.array(theirs["faces"]).reshape(-1, 3)
    used, indices = np.unique(indices, return_inverse=True)  # 16 of its vertices are in no face
    positions = positions[used]
    middle = (positions.min(axis=0) + positions.max(axis=0)) / 2
    assert_allclose(
        mesh.positions, (positions - middle)[:, [0, 2, 1]] * [1, -1, 1], atol=3e-8
    )  # float32 at .25
    assert_array_equal(np.sort(mesh.faces, axis=1), np.sort(indices.reshape(-1, 3), axis=1))


def test_normals_of_the_file_are_kept(tmp_path):
    """But for the corner whose faces look the other way: a normal is on the side of its faces."""
    more = "".join(f"property float n{axis}\n" for axis in "xyz")
    points = [(*p, 0, 0, 2) for p in POINTS]
    content = header(more=more) + b"".join(struct.pack("<6f", *p) for p in points) + faces()
    assert_allclose(read(tmp_path, content).normals, [(0, 1, 0)] + [(0, -1, 0)] * 3)


CUBE = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
# The letter L, which no fan from its first corner cuts, as a floor and a ceiling with six walls.
L = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 2), (0, 2)]
L = L[3:] + L[:3]
LETTER = [(x, y, z) for z in (0, 1) for x, y in L]
LETTER_FACES = [tuple(range(6))[::-1], tuple(range(6, 12)), *((i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i) for i in range(6))]  # fmt: skip


@pytest.mark.parametrize(
    ("points", "polygons", "n_triangles", "expected"),
    [
        (CUBE, QUADS, 12, 1.0),
        (CUBE, [*QUADS[:5], QUADS[5][:3], (QUADS[5][0], *QUADS[5][2:])], 12, 1.0),
        (CUBE, [*QUADS, (0, 1), (2,), ()], 12, 1.0),
        (CUBE, [face[::-1] for face in QUADS], 12, 1.0),
        (LETTER, LETTER_FACES, 20, 4.0),
        (LETTER, [face[2:] + face[:2] for face in LETTER_FACES], 20, 4.0),
    ],
    ids=["quads", "mixed", "edges too", "inside out", "bent inward", "bent, from another corner"],
)
def test_polygons_become_triangles_of_the_same_solid(tmp_path, points, polygons, n_triangles, expected):  # fmt: skip
    content = header(n_vertices=len(points), n_faces=len(polygons)) + vertices(points=points) + faces(faces=polygons)  # fmt: skip
    mesh = read(tmp_path, content)
    assert len(mesh.faces) == n_triangles
    assert volume(mesh) == pytest.approx(expected)
    # No triangle folds over: their areas add up to the solid's.
    a, b, c = np.moveaxis(mesh.positions[mesh.faces], 1, 0)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    assert area == pytest.approx(6 if points is CUBE else 2 * 4 + 10)


COLOUR = "".join(f"property uchar {c}\n" for c in ("red", "green", "blue"))


@pytest.mark.parametrize(
    "content",
    [
        # MeshLab: texture coordinates of each face; here with different numbers of them.
        header(list_="list uchar int vertex_indices\nproperty list uchar float texcoord\nproperty int texnumber") + vertices()
        + b"".join(struct.pack(f"<B3iB{n}fi", 3, *f, n, *[0.5] * n, 0) for n, f in zip((6, 0, 6, 2), FACES, strict=True)),
        # A property before the corners, unsigned indices of two bytes, the other name.
        header(list_="uchar flags\nproperty list uint8 uint16 vertex_index") + vertices()
        + b"".join(struct.pack("<BB3H", 7, 3, *f) for f in FACES),
        header(more=COLOUR) + b"".join(struct.pack("<3f3B", *p, 1, 2, 3) for p in POINTS) + faces(),
        header().replace(b"float", b"double") + b"".join(struct.pack("<3d", *p) for p in POINTS) + faces(),
        header().replace(b"comment", b"comment \xe9\nobj_info by hand\ncomment").replace(b"element vertex", b"element\tvertex") + vertices() + faces(),
        # Faces before vertices, elements of other names around them.
        b"ply\nformat binary_little_endian 1.0\nelement camera 1\nproperty list int float m\nelement face 4\nproperty list char uint vertex_indices\n"
        b"element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement edge 1\nproperty int a\nend_header\n"
        + struct.pack("<i2f", 2, 0, 0) + b"".join(struct.pack("<b3I", 3, *f) for f in FACES) + vertices() + b"\0\0\0\0",
        header("ascii", more=COLOUR) + TEXT.replace(b"\n3 ", b"\n3 ").replace(b"0 0 0\n1", b"0 0 0 9 9 9\n1", 1).replace(b"1 0 0\n", b"1 0 0 9 9 9\n", 1).replace(b"0 1 0\n", b"0 1 0 9 9 9\n", 1).replace(b"0 0 1\n", b"0 0 1 9 9 9\n", 1),
        (header("ascii") + TEXT + b"\n").replace(b"\n", b"\r"),
        (header("ascii") + TEXT + b"\n").replace(b"\n", b"\r\n"),
    ],
    ids=["MeshLab", "flags", "colours", "double", "comments", "order", "text with colours", "old Mac", "DOS"],
)  # fmt: skip
def test_the_same_tetrahedron_as_other_programs_write_it(tmp_path, content):
    mesh = read(tmp_path, content)
    assert (len(mesh.positions), len(mesh.faces)) == (4, 4)
    assert volume(mesh) == pytest.approx(1 / 6)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "does not begin as a PLY file"),
        (b"ply\nformat ascii 1.0\nend_header", "does not begin as a PLY file"),
        (header("ebcdic"), "is of the format 'ebcdic 1.0': expected ascii, binary_little_endian"),
        (header(n_vertices=2**31) + vertices() + faces(), r"has 0.0% of what its header says, or less: it is truncated"),
        (header(n_vertices=2**60) + vertices() + faces(), "the line 'element vertex 1152921504606846976'"),
        (header(n_vertices=-1) + vertices() + faces(), "the line 'element vertex -1'"),
        (header(n_faces=2**40) + vertices() + faces(), "it is truncated"),
        (header() + vertices() + faces()[:-1], "it is truncated"),
        (header(n_faces=1) + vertices() + faces(faces=[(0, 1, 2**30)]), "faces of points 0 to 1,073,741,824: expected 0 to 3, counted from 0"),
        (header(n_faces=1) + vertices() + faces(faces=[(0, 1, -5)]), "points -5 to 1: expected"),
        (header(n_faces=1) + vertices() + faces(faces=[(0, 1)]), "has 1 faces, none of three corners or more"),
        (header(n_faces=1, list_="list char int vertex_indices") + vertices() + b"\xff", "has a list of -1 values"),
        (header(n_faces=1, list_="int vertex_indices") + vertices() + faces(), "one vertex_indices for each face"),
        (header("ascii") + TEXT.replace(b"1 2 3", b"1 2 nan"), "faces of points -1 to 3"),
        (header("ascii") + TEXT.replace(b"3 1 2 3", b"nan 1 2 3"), "has a list of nan values"),
        (header() + vertices(points=[(7, 7, 7)] * 4) + faces(), "is 0 wide: expected more than a point"),
        (header() + vertices(points=[*POINTS[:3], (0, 0, 1e35)]) + faces(), "missing or beyond 1e.30"),
        (header(n_faces=0) + vertices(), "has 0 faces, none of three corners"),
        (header() + vertices(points=[*POINTS[:3], (0, 0, np.nan)]) + faces(), "coordinates that are missing"),
        (header("ascii") + TEXT[:-2], "has 96.4% of what its header says"),
        (header("ascii") + TEXT + b"x", "something else than numbers"),
        (header(more="property float x\n") + vertices() + faces(), "a property of 'vertex' twice"),
        (header(list_="list uchar int things") + vertices() + faces(), "no faces vertex_indices"),
        (b"ply\nformat ascii 1.0\nelement vertex 0\nend_header\n", "no vertices x, y, z or no faces"),
    ],
)  # fmt: skip
def test_a_damaged_mesh_says_what_is_wrong(tmp_path, content, message):
    with pytest.raises(RenderError, match=message) as said:
        read(tmp_path, content)
    assert str(said.value).isprintable()
