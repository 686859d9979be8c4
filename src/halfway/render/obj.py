r"""OBJ files of polygons, text.

    v X Y Z                    a point; what follows, such as a colour, is left out
    vn X Y Z                   a normal
    vt U V                     texture coordinates
    f P P P ...                a polygon of corners P, P/T, P//N or P/T/N

P, T and N count from 1; below 0 they count back from the last of theirs read so far. A line goes on behind a backslash. Groups,
materials, lines and curves are left out; no other file is opened.

Source: Wavefront Technologies, "Advanced Visualizer Manual", appendix B1, "Object Files".
"""

import re
from itertools import compress

import numpy as np

from .polygons import MeshFault, Polygons

_NUMBERS = b"0123456789+-"


def parse_obj(content: bytes) -> Polygons:
    """The polygons of an OBJ file; a `MeshFault` where a point, a normal or a face is not numbers."""
    text = re.sub(rb"#[^\r\n]*", b"", content.removeprefix(b"\xef\xbb\xbf"))
    text = re.sub(rb"\\\r?\n", b" ", text).translate(bytes.maketrans(b"\t\r", b" \n"))
    lines = [line.strip() for line in text.split(b"\n")]
    v, vn, vt, f = (
        np.array([line.startswith(word) for line in lines])
        for word in (b"v ", b"vn ", b"vt ", b"f ")
    )
    points, normals = (_vectors([*compress(lines, kind)]) for kind in (v, vn))
    of_point, of_texture, of_normal, sizes = _corners([line[2:] for line in compress(lines, f)])
    return Polygons(
        points,
        normals,
        _from_zero(of_point, np.repeat(np.cumsum(v)[f], sizes)),
        _from_zero(of_normal, np.repeat(np.cumsum(vn)[f], sizes)),
        sizes,
        _textures([*compress(lines, vt)]),
        _from_zero(of_texture, np.repeat(np.cumsum(vt)[f], sizes)),
    )


def _vectors(lines: list[bytes]) -> np.ndarray:
    if not lines:
        return np.zeros((0, 3))
    try:
        return np.loadtxt(lines, usecols=(1, 2, 3), ndmin=2)
    except ValueError as error:
        raise MeshFault(
            "has a line v or vn of something else than numbers: expected three of them"
        ) from error


def _textures(lines: list[bytes]) -> np.ndarray:
    """Texture coordinates; none where a line is something else, for a mesh is whole without."""
    try:
        return np.loadtxt(lines, usecols=(1, 2), ndmin=2) if lines else np.zeros((0, 2))
    except ValueError:
        return np.zeros((0, 2))


def _corners(faces: list[bytes]) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Point, texture and normal of each corner as the file counts them, 0 for none; and how many corners each face has."""
    if not faces:
        nothing = np.zeros(0, np.int64)
        return nothing, nothing, nothing, nothing
    text = b"\n".join(b" ".join(face.split()) for face in faces)
    text = re.sub(rb"/(?![-+\d])", b"/0", text)
    after = np.frombuffer(text.translate(None, b"0123456789+-") + b"\n", np.uint8)  # each number
    try:
        numbers = np.array(re.split(rb"[ \n/]", text), np.int64)
        if len(numbers) != len(after):
            raise ValueError
        corner = np.concatenate([[0], np.cumsum(after != ord("/"))[:-1]])  # of each number
        starts = np.flatnonzero(np.diff(corner, prepend=-1))
        n_numbers = np.bincount(corner)
        of_texture, of_normal = (
            np.where(n_numbers > i, np.take(numbers, starts + i, mode="clip"), 0) for i in (1, 2)
        )
        sizes = np.diff(corner[after == ord("\n")], prepend=-1)
        return numbers[starts], of_texture, of_normal, sizes
    except (ValueError, OverflowError) as error:
        raise MeshFault(
            "has a face of something else than numbers: expected corners such as 1, 1/2, 1//3 or 1/2/3"
        ) from error


def _from_zero(indices: np.ndarray, n_read: np.ndarray) -> np.ndarray:
    """Indices from 0, and -1 for none; ``n_read`` is how many the file has before."""
    back = n_read + indices
    # One that counts back beyond the first must not be taken for none.
    return np.where(indices < 0, np.where(back < 0, -2, back), indices - 1)
