"""Basis images: one picture of each material of a library, on a small lit sphere.

Direct light is linear in the BRDF, so the picture of a recipe is the same weighted sum of the materials' pictures:

    picture(a) = sum_i a_i picture_i         per channel

(exactly where the materials are measured on the same cells). A hundred pictures along a route cost milliseconds. The pictures
of another blend's mixes are made of small tables, a few milliseconds each.
"""

from dataclasses import dataclass, replace
from functools import lru_cache, partial

import numpy as np
from jaxtyping import Float, Float32

from ..errors import LibraryError
from ..halfdiff import Grid
from ..library import Library
from ..recipes import Blend, Recipe
from ..tasks import HERE, Work
from .appearance import appearance, cielab_difference
from .lit_sphere import PACING_SCENE, FilledSphere, SphereOperator, SphereScene
from .small_tables import SmallTables

THINNING = 4
"""Every so many pixels are enough to choose materials by."""
N_AT_ONCE = 32
"""Mixes whose pictures are made together, where pictures do not mix."""


@dataclass(frozen=True, eq=False)
class Looks:
    """The pictures of all materials of a library in one scene."""

    names: tuple[str, ...]
    """The materials, in the library's order."""
    scene: SphereScene
    planes: Float32[np.ndarray, "3 N n_pixels"]
    """Linear RGB, 1 is the white of the display; only the pixels of the sphere, in the order of ``scene.mask()``."""
    tables: SmallTables
    step: int = 1
    """Every so many pixels of the scene are there."""

    @classmethod
    def fit(
        cls, library: Library, scene: SphereScene = PACING_SCENE, *, work: Work = HERE
    ) -> "Looks":
        """The pictures of ``library``; kept in the cache under the library's checksum."""
        key = f"basis-1-{scene.fingerprint()}-{library.checksum}"
        planes = work.cached(key, lambda: {"planes": _planes(library, scene, work)})["planes"]
        planes.flags.writeable = False
        return cls(library.names, scene, planes, SmallTables(library, work=work))

    @property
    def images(self) -> Float32[np.ndarray, "N n_pixels 3"]:
        """Linear RGB of each material; a view."""
        return np.moveaxis(self.planes, 0, -1)

    def thinned(self, step: int) -> "Looks":
        """Every so many pixels of the pictures, which are enough to measure differences with; contiguous."""
        planes = np.ascontiguousarray(self.planes[..., ::step])
        return replace(self, planes=planes, step=step * self.step)

    def mix(
        self, weights: Float[np.ndarray, "3 *k N"], blend: Blend
    ) -> Float32[np.ndarray, "*k n_pixels 3"]:
        """Linear RGB of recipes, given by their weights over all materials; axes between stay."""
        if blend is Blend.LINEAR:
            return self._sum(weights)
        flat = weights.reshape(3, -1, weights.shape[-1])
        chunks = (
            self.of_tables(self.tables.mix(flat[:, start : start + N_AT_ONCE], blend))
            for start in range(0, flat.shape[1], N_AT_ONCE)
        )
        return np.concatenate(list(chunks)).reshape(*weights.shape[1:-1], -1, 3)

    def of_tables(
        self, tables: Float32[np.ndarray, "3 k p"]
    ) -> Float32[np.ndarray, "k n_pixels 3"]:
        """Linear RGB of small tables, as ``self.tables.mix`` gives them."""
        return _sphere(self.scene, self.tables.grid, self.step).pictures(tables)

    def _sum(self, weights: Float[np.ndarray, "3 *k N"]) -> Float32[np.ndarray, "*k n_pixels 3"]:
        """Direct light is linear in the BRDF: the picture of a linear mix is the mix of the pictures."""
        used = np.flatnonzero(weights.any(axis=tuple(range(weights.ndim - 1))))
        few = weights[..., used].astype(np.float32)
        out = np.empty((*weights.shape[1:-1], self.planes.shape[-1], 3), np.float32)
        for channel, (w, plane) in enumerate(zip(few, self.planes, strict=True)):
            out[..., channel] = w @ plane[used]
        return out

    def picture(self, recipe: Recipe) -> Float32[np.ndarray, "size size 3"]:
        """Linear RGB of one recipe as a square picture, 0 beside the sphere."""
        mask = self.scene.mask()
        picture = np.zeros((*mask.shape, 3), np.float32)
        picture[mask] = self.of(recipe)
        return picture

    def of(self, recipe: Recipe) -> Float32[np.ndarray, "n_pixels 3"]:
        """Linear RGB of one recipe."""
        if recipe.pictures_mix:
            return self._sum(recipe.dense(self.names))
        return self.of_tables(self.tables.of(recipe)[:, None])[0]


@lru_cache(maxsize=6)
def _sphere(scene: SphereScene, grid: Grid, step: int) -> FilledSphere:
    return FilledSphere.of(scene, grid, step=step)


def most_different(images: Looks, n: int) -> list[str]:
    """The names of ``n`` materials that look as different as can be, in the library's order.

    First the one that looks least like the mean of all, then each time the one that is farthest from those chosen: mean
    CIELAB difference on the lit sphere of ``images``.

    Reference: T. F. Gonzalez, "Clustering to Minimize the Maximum Intercluster Distance", Theoretical Computer Science 38,
    1985.

    Raises
    ------
    LibraryError
        When the library has fewer than ``n``, or ``n`` is less than 2.
    """
    if not 2 <= n <= len(images.names):
        raise LibraryError(
            f"{n} materials cannot be chosen: expected 2 to {len(images.names)}, which is all there are."
        )
    looks = appearance(images.images[:, ::THINNING])
    distance = cielab_difference(looks, looks.mean(axis=0))
    chosen: list[int] = []
    for _ in range(n):
        chosen.append(int(np.argmax(distance)))
        to_chosen = cielab_difference(looks, looks[chosen[-1]])
        distance = to_chosen if len(chosen) == 1 else np.minimum(distance, to_chosen)
    return [images.names[i] for i in sorted(chosen)]


def _planes(
    library: Library, scene: SphereScene, work: Work
) -> Float32[np.ndarray, "3 N n_pixels"]:
    draw = partial(_draw, library, SphereOperator.of(scene, library.grid))
    pictures = list(work.run(draw, range(len(library)), label="Basis images"))
    return np.ascontiguousarray(np.moveaxis(np.stack(pictures), -1, 0))


def _draw(library: Library, operator: SphereOperator, i: int) -> Float32[np.ndarray, "n_pixels 3"]:
    return operator.picture(library.row(i))
