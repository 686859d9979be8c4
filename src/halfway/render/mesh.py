"""Triangle meshes as plain arrays."""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from .scenes import Placed


class Mesh(NamedTuple):
    """Triangles whose corners go counter-clockwise seen from outside."""

    positions: np.ndarray  # (n_vertices, 3), float32
    normals: np.ndarray  # (n_vertices, 3), float32, unit, outward
    faces: np.ndarray  # (n_faces, 3), uint32
    uv: np.ndarray | None = (
        None  # (n_faces, 3, 2), float32: texture coordinates of each face's corners
    )
    """The tangent of the surface points to where the first of them grows; None where nothing says."""

    @classmethod
    def of(
        cls,
        positions: np.ndarray,
        normals: np.ndarray,
        faces: np.ndarray,
        uv: np.ndarray | None = None,
    ) -> "Mesh":
        """A mesh of arrays of any real and integer types."""
        return cls(
            positions.astype(np.float32),
            normals.astype(np.float32),
            faces.astype(np.uint32),
            None if uv is None else uv.astype(np.float32),
        )

    def unshared(self) -> "Mesh":
        """The same with vertices of its own for each face, so that the nth has the nth texture coordinates."""
        corners = self.faces.ravel()
        faces = np.arange(len(corners)).reshape(-1, 3)
        return Mesh.of(self.positions[corners], self.normals[corners], faces, self.uv)


def joined(meshes: Sequence[Mesh]) -> Mesh:
    """All the triangles of several meshes with texture coordinates."""
    starts = np.cumsum([0, *(len(mesh.positions) for mesh in meshes[:-1])])
    return Mesh.of(
        np.concatenate([mesh.positions for mesh in meshes]),
        np.concatenate([mesh.normals for mesh in meshes]),
        np.concatenate([mesh.faces + start for mesh, start in zip(meshes, starts, strict=True)]),
        np.concatenate([mesh.uv for mesh in meshes if mesh.uv is not None]),
    )


def placed(mesh: Mesh, obj: Placed) -> Mesh:
    """The mesh where a scene wants it: as large as there is room for it, turned, the middle of its foot at its place."""
    positions = mesh.positions.astype(float)
    low, high = positions.min(axis=0), positions.max(axis=0)
    positions -= np.array([*(low + high)[:2] / 2, low[2]])
    width = 2 * np.hypot(positions[:, 0], positions[:, 1]).max()
    scale = 1 / max((high - low)[2] / obj.height, width / obj.width)
    turn = np.radians(obj.turn_degrees)
    c, s = np.cos(turn), np.sin(turn)
    rotation = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    return Mesh.of(
        positions * scale @ rotation.T + np.array(obj.at),
        mesh.normals @ rotation.T,
        mesh.faces,
        mesh.uv,
    )


def brushed(mesh: Mesh) -> Mesh:
    """The mesh with texture coordinates of its own, or else with tangents that run level, as grooves do that a vertical lathe cuts.

    They are those of each triangle, counter-clockwise seen from above; along x where it lies level.
    """
    if mesh.uv is not None:
        return mesh
    a, b, c = np.moveaxis(mesh.positions[mesh.faces].astype(float), 1, 0)
    n = np.cross(b - a, c - a)
    t = np.stack([-n[:, 1], n[:, 0], 0 * n[:, 0]], axis=-1)
    is_level = np.linalg.norm(t, axis=-1) <= 1e-6 * np.linalg.norm(n, axis=-1)
    t[is_level] = (1, 0, 0)
    axes = np.stack([unit(t), unit(np.cross(n, t))], axis=1)
    corners = np.stack([a, b, c], axis=1) - a[:, None]
    return mesh._replace(uv=np.einsum("fcx,fux->fcu", corners, axes).astype(np.float32))


def sweep(
    *,
    width: float = 60.0,
    front: float = 40.0,
    wall: float = 9.0,
    radius: float = 5.0,
    height: float = 40.0,
) -> Mesh:
    """A photographer's sweep of paper: a floor that curves up into a wall at y = ``wall``."""
    turn = np.linspace(0, np.pi / 2, 33)
    y = np.concatenate([[-front], wall - radius + radius * np.sin(turn), [wall]])
    z = np.concatenate([[0], radius - radius * np.cos(turn), [height]])
    ny = np.concatenate([[0], -np.sin(turn), [-1]])
    nz = np.concatenate([[1], np.cos(turn), [0]])
    n = len(y)
    sides = (-width / 2, width / 2)
    positions = np.concatenate([np.stack([np.full(n, x), y, z], axis=-1) for x in sides])
    normals = np.tile(np.stack([np.zeros(n), ny, nz], axis=-1), (2, 1))
    i = np.arange(n - 1)
    faces = np.concatenate(
        [np.stack([i, i + n, i + n + 1], axis=-1), np.stack([i, i + n + 1, i + 1], axis=-1)]
    )
    return Mesh.of(positions, normals, faces)


def disc(*, lean_degrees: float = 25.0, thickness: float = 0.06, n: int = 512) -> Mesh:
    """A thin disc of diameter 1 that stands on its rim and leans back from -y; tangents run around its middle."""
    profile = np.array([(0, 1), (0.5, 1), (0.5, 0), (0, 0)]) * (1, thickness)
    turn = 2 * np.pi * np.arange(n + 1) / n
    around = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=-1)
    meshes: list[Mesh] = []
    for (r0, z0), (r1, z1) in pairwise(profile):
        positions = np.stack([around * r + (0, 0, z) for r, z in ((r0, z0), (r1, z1))])
        normal = around * (z0 - z1) + np.array([0, 0, r1 - r0])
        meshes.append(sheet(positions, np.broadcast_to(unit(normal), positions.shape)))
    whole = joined(meshes)
    tilt = np.radians(90 - lean_degrees)
    c, s = np.cos(tilt), np.sin(tilt)
    rotation = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    return whole._replace(
        positions=whole.positions @ rotation.T, normals=whole.normals @ rotation.T
    )


def sheet(positions: np.ndarray, normals: np.ndarray) -> Mesh:
    """Two triangles per quad of arrays of shape (along, around, 3), without empty ones; u grows around."""
    n, m = positions.shape[:2]
    index = np.arange(n * m).reshape(n, m)
    a, b, c, d = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    faces = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)]).reshape(-1, 3)
    flat = positions.reshape(-1, 3)
    edges = flat[faces] - flat[np.roll(faces, 1, axis=1)]
    faces = faces[(np.linalg.norm(edges, axis=-1) > 1e-9).all(axis=1)]
    uv = np.stack([faces % m / (m - 1), faces // m / (n - 1)], axis=-1)
    return Mesh.of(flat, normals.reshape(-1, 3), faces, uv)


def outward(
    positions: np.ndarray, normals: np.ndarray, faces: np.ndarray, uv: np.ndarray | None = None
) -> Mesh:
    """A mesh of a file with y up, turned to z up; faces turned so that the volume inside is positive.

    Normals are turned to the side of their faces, whatever a file says. Where one is missing, of length 0, it is made from
    the faces, weighted by area.
    """
    positions, normals = (
        v[:, [0, 2, 1]] * np.array([1.0, -1.0, 1.0]) for v in (positions, normals)
    )
    a, b, c = np.moveaxis(positions[faces], 1, 0)
    across = np.cross(b - a, c - a)
    if np.einsum("ij,ij->", a - positions.mean(axis=0), across) < 0:
        faces, across = faces[:, ::-1], -across
        uv = None if uv is None else uv[:, ::-1]
    own = _of_faces(len(positions), faces, across)
    given = np.linalg.norm(normals, axis=1, keepdims=True) > 0
    other_side = np.einsum("ij,ij->i", normals, own)[:, None] < 0
    normals = np.where(given, np.where(other_side, -normals, normals), own)
    return Mesh.of(positions, unit(normals), faces, uv)


def unit(v: np.ndarray) -> np.ndarray:
    """Vectors of length 1 along others; 0 where they are 0."""
    length = np.linalg.norm(v, axis=-1, keepdims=True)
    return v / np.where(length > 0, length, 1)


def _of_faces(n_vertices: int, faces: np.ndarray, across: np.ndarray) -> np.ndarray:
    """A normal for each vertex, of its faces; of one of them where they cancel, as those of a sheet that is there from both sides."""
    total, one = np.zeros((2, n_vertices, 3))
    for corner in range(3):
        np.add.at(total, faces[:, corner], across)
        one[faces[:, corner]] = across
    size = np.abs(total).max(axis=1, keepdims=True)
    return np.where(size > 1e-6 * np.abs(one).max(axis=1, keepdims=True), total, one)
