"""PLY files: as Mitsuba reads them, and what its reader would not survive; pictures that state more than they hold."""

import struct

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from halfway.errors import RenderError
from halfway.render.ply import read_ply
from halfway.render.variant import load_mitsuba

POINTS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
BINARY = "binary_little_endian"


def header(kind=BINARY, n_vertices=4, n_faces=4, more="", list_="list uchar int vertex_indices"):
    xyz = "".join(f"property float {axis}\n" for axis in "xyz")
    return f"ply\nformat {kind} 1.0\ncomment a tetrahedron\nelement vertex {n_vertices}\n{xyz}{more}element face {n_faces}\nproperty {list_}\nend_header\n".encode()


def vertices(order="<", points=POINTS):
    return b"".join(struct.pack(f"{order}3f", *p) for p in points)


def faces(order="<", faces=FACES):
    return b"".join(struct.pack(f"{order}B{len(f)}i", len(f), *f) for f in faces)


TEXT = "\n".join([*(f"{x} {y} {z}" for x, y, z in POINTS), *(f"3 {a} {b} {c}" for a, b, c in FACES)]).encode()  # fmt: skip


def read(tmp_path, content):
    (tmp_path / "x.ply").write_bytes(content)
    return read_ply(tmp_path / "x.ply")


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
    assert_allclose(mesh.positions, [(x, -z, y) for x, y, z in POINTS])
    a, b, c = np.moveaxis(mesh.positions[mesh.faces], 1, 0)
    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    assert volume == pytest.approx(1 / 6)


def test_equals_mitsuba(shared_data):
    mi = load_mitsuba()
    path = shared_data / "meshes" / "dragon_res3.ply"
    mesh = read_ply(path)
    with mi.variant_context("scalar_rgb"):
        theirs = mi.traverse(mi.load_dict({"type": "ply", "filename": str(path)}))
        positions = np.array(theirs["vertex_positions"]).reshape(-1, 3)
        indices = np.array(theirs["faces"]).reshape(-1, 3)
    assert_array_equal(mesh.positions, positions[:, [0, 2, 1]] * [1, -1, 1])
    assert_array_equal(np.sort(mesh.faces, axis=1), np.sort(indices, axis=1))


def test_normals_of_the_file_are_kept(tmp_path):
    more = "".join(f"property float n{axis}\n" for axis in "xyz")
    points = [(*p, 0, 0, 2) for p in POINTS]
    content = header(more=more) + b"".join(struct.pack("<6f", *p) for p in points) + faces()
    assert_allclose(read(tmp_path, content).normals, [(0, -1, 0)] * 4)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "does not begin as a PLY file"),
        (b"ply\nformat ascii 1.0\nend_header", "does not begin as a PLY file"),
        (header("ebcdic"), r"the line 'format ebcdic 1.0' in its header"),
        (header(n_vertices=2**31) + vertices() + faces(), "ends after .* bytes, its header says 25,769,"),
        (header(n_vertices=2**60) + vertices() + faces(), "the line 'element vertex 1152921504606846976'"),
        (header(n_vertices=-1) + vertices() + faces(), "the line 'element vertex -1'"),
        (header(n_faces=2**40) + vertices() + faces(), "it is truncated"),
        (header() + vertices() + faces()[:-1], "it is truncated"),
        (header(n_faces=1) + vertices() + faces(faces=[(0, 1, 2**30)]), "vertices 0 to 1073741824: expected some, of vertices 0 to 3"),
        (header(n_faces=1) + vertices() + faces(faces=[(0, 1, -5)]), "vertices -5 to 1: expected"),
        (header(n_faces=1) + vertices() + faces(faces=[(0, 1, 2, 3)]), "other than three corners"),
        (header(n_faces=0) + vertices(), "has 0 triangles of vertices none"),
        (header() + vertices(points=[*POINTS[:3], (0, 0, np.nan)]) + faces(), "without a finite place"),
        (header("ascii") + TEXT[:-2], "has 27 numbers, its header says 28 or more"),
        (header("ascii") + TEXT + b"x", "something else than numbers"),
        (header(more="property float x\n") + vertices() + faces(), "a property of 'vertex' twice"),
        (header(list_="list uchar int things"), "the line 'property list uchar int things'"),
        (b"ply\nformat ascii 1.0\nelement vertex 0\nend_header\n", "no vertices or no faces"),
    ],
)  # fmt: skip
def test_a_damaged_mesh_says_what_is_wrong(tmp_path, content, message):
    with pytest.raises(RenderError, match=message) as said:
        read(tmp_path, content)
    assert str(said.value).isprintable()


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("x.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 100000 +X 100000\n"),
        ("x.exr", b"\x76\x2f\x31\1\2\0\0\0dataWindow\0box2i\0\x10\0\0\0" + struct.pack("<4i", 0, 0, 99_999, 99_999)),
    ],
)  # fmt: skip
def test_a_picture_that_states_too_much_takes_no_memory(tmp_path, name, content):
    load_mitsuba()
    from halfway.render.assets import read_environment

    (tmp_path / name).write_bytes(content)
    with pytest.raises(
        RenderError, match=r"states 10,000,000,000 pixels in \d+ bytes: expected at most"
    ):
        read_environment(tmp_path / name)
