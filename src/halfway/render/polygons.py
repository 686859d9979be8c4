"""What mesh files hold, polygons whose corners may have normals of their own, made into triangles.

Programs keep quads and larger faces. Each polygon is cut into a fan from its first corner; one that bends inward, where the fan
would fold over, is cut by ears. A point that corners show with different normals (at a hard edge) becomes several vertices. Texture coordinates count where all corners have them.
"""

from typing import NamedTuple

import numpy as np

from .mesh import Mesh, outward

LARGEST, SMALLEST = 1e30, 1e-30
"""Of what single precision can place."""
FOLDED = -1e-6
"""Cosine of a triangle's normal and its polygon's, below which the fan folds over; above is rounding."""


class MeshFault(ValueError):  # noqa: N818 (it is caught where the file's name is known)
    """What is wrong with a mesh, as the end of a sentence."""


class Polygons(NamedTuple):
    """Polygons of points, y up, in the order of their corners."""

    points: np.ndarray  # (n_points, 3), float64
    normals: np.ndarray  # (n_normals, 3), float64, of any length
    corners: np.ndarray  # (n_corners,), int64: the point of each corner, polygon after polygon
    corner_normals: np.ndarray  # (n_corners,), int64: the normal of each corner; -1 for none
    sizes: np.ndarray  # (n_polygons,), int64: how many corners each has
    textures: np.ndarray  # (n_textures, 2), float64: texture coordinates
    corner_textures: np.ndarray  # (n_corners,), int64: those of each corner; -1 for none

    def mesh(self) -> Mesh:
        """The triangles, z up, faces turned outward.

        Raises
        ------
        MeshFault
            When there are none, a corner is of no point or no normal, or a coordinate is not finite.
        """
        self._require_whole()
        normals = np.concatenate(
            [self.normals, np.zeros((1, 3))]
        )  # the last for corners that have none
        key = self.corners * len(normals) + self.corner_normals % len(normals)
        keys, vertices = np.unique(key, return_inverse=True)
        point, normal = np.divmod(keys, len(normals))
        positions = self.points[point]
        low, high = positions.min(axis=0), positions.max(axis=0)
        if not SMALLEST < (high - low).max() < LARGEST:
            raise MeshFault(
                f"is {(high - low).max():g} wide: expected more than a point, and less than {LARGEST:g}"
            )
        # Surveyors' coordinates lie so far out that single precision would leave steps.
        positions = positions - (low + high) / 2
        triangles = self._triangles()
        return outward(positions, normals[normal], vertices[triangles], self._uv(triangles))

    def _uv(self, triangles: np.ndarray) -> np.ndarray | None:
        """Texture coordinates of the corners of triangles; None where one has none."""
        which = self.corner_textures[triangles]
        if ((which < 0) | (which >= len(self.textures))).any():
            return None
        uv = self.textures[which]
        return uv if (np.abs(uv) < LARGEST).all() else None

    def _require_whole(self) -> None:
        _require_among(self.corners, len(self.points), "points", 0)
        _require_among(self.corner_normals, len(self.normals), "normals", -1)
        used = self.points[self.corners]
        if not (np.abs(used) < LARGEST).all() or not np.isfinite(self.normals).all():
            raise MeshFault(
                f"has coordinates that are missing or beyond {LARGEST:g}: expected finite ones"
            )
        if not (self.sizes > 2).any():
            raise MeshFault(
                f"has {len(self.sizes):,} faces, none of three corners or more: expected one or more"
            )

    def _triangles(self) -> np.ndarray:
        """The corners of each triangle, shape (n, 3), as indices into `corners`."""
        n_each = np.maximum(self.sizes - 2, 0)
        polygon = np.repeat(np.arange(len(self.sizes)), n_each)
        starts = np.cumsum(self.sizes) - self.sizes
        first = starts[polygon]
        nth = np.arange(len(polygon)) - (np.cumsum(n_each) - n_each)[polygon]
        fans = np.stack([first, first + nth + 1, first + nth + 2], axis=-1)
        bent = self._bent(fans, polygon)
        cut = [
            starts[i] + _ears(self.points[self.corners[starts[i] :][: self.sizes[i]]]) for i in bent
        ]
        return np.concatenate([fans[~np.isin(polygon, bent)], *cut])

    def _bent(self, fans: np.ndarray, polygon: np.ndarray) -> np.ndarray:
        """The polygons whose fans fold over."""
        a, b, c = np.moveaxis(self.points[self.corners[fans]], 1, 0)
        across = np.cross(b - a, c - a)
        whole = np.stack(
            [np.bincount(polygon, axis, len(self.sizes)) for axis in across.T], axis=-1
        )[polygon]
        lengths = np.linalg.norm(across, axis=1) * np.linalg.norm(whole, axis=1)
        return np.unique(polygon[np.einsum("ij,ij->i", across, whole) < FOLDED * lengths])


def _ears(points: np.ndarray) -> np.ndarray:
    """The triangles of a polygon, shape (n, 3), seen along its normal."""
    from mapbox_earcut import triangulate_float64

    edges = points - points[0]
    normal = np.cross(edges[:-1], edges[1:]).sum(axis=0)
    flat = np.ascontiguousarray(np.delete(points, np.argmax(np.abs(normal)), axis=1))
    ears = triangulate_float64(flat, np.array([len(points)], np.uint32)).reshape(-1, 3)
    a, b, c = np.moveaxis(points[ears], 1, 0)
    turned = np.cross(b - a, c - a).sum(axis=0) @ normal < 0
    return ears[:, :: -1 if turned else 1].astype(np.int64)


def _require_among(indices: np.ndarray, n: int, what: str, least: int) -> None:
    if len(indices) and not (least <= indices.min() and indices.max() < n):
        raise MeshFault(
            f"has faces of {what} {indices.min():,} to {indices.max():,}: expected 0 to {n - 1:,}, counted from 0"
        )
