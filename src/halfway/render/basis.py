"""Routes from basis images: one render per measured material, however long the route.

With direct light the picture of a mix is the mix of the pictures, channel by channel (see `halfway.render.renderer`):

    picture(recipe)_c = sum_i w_c,i picture(material i)_c        c = r, g, b

so a route of any length costs one render for each measured material that it touches. All of them have the same noise, and
so no frame flickers against the next.
"""

from collections.abc import Callable, Iterable
from functools import lru_cache
from hashlib import sha256

import numpy as np

from ..brdf import TabularBrdf
from ..errors import RenderError
from ..recipes import Recipe
from ..tasks import HERE, Work
from .renderer import Renderer

MEMORY = 512 * 2**20
"""Bytes of basis images kept in memory: 170 of 512 x 512 pixels."""


class BasisPictures:
    """Pictures of recipes in one scene, from pictures of the materials that carry weight.

    Parameters
    ----------
    renderer : Renderer
        Of a scene with direct light. If it denoises, pictures are near to what it would make of the mix, not equal.
    table : callable
        The table of a material, by name.
    work : Work
        Shows progress; its cache keeps the pictures between runs, by scene and material.

    Raises
    ------
    RenderError
        When light bounces between the objects, for then pictures do not mix.

    Examples
    --------
    >>> import halfway
    >>> from halfway.render import BasisPictures, Renderer
    >>> library = halfway.open_library("builtin:merl-abc")
    >>> route = halfway.route(library, "teflon", "chrome", space="linear", pace="uniform")
    >>> basis = BasisPictures(Renderer("sphere", size=(64, 64), spp=16), library.brdf)
    >>> frames = [basis.picture(recipe) for recipe in route.recipes([0, 0.5, 1])]
    """

    def __init__(
        self, renderer: Renderer, table: Callable[[str], TabularBrdf], *, work: Work = HERE
    ) -> None:
        if not renderer.linear:
            raise RenderError(
                f"light bounces {renderer.bounces} times in this {renderer.scene.name}, so the picture of a mix "
                "is not the mix of the pictures: expected direct light. Use --bounces 1, or render every frame in full."
            )
        self._renderer = renderer
        self._table = table
        self._work = work
        self._scene = renderer.fingerprint()
        room = max(1, MEMORY // (12 * renderer.size[0] * renderer.size[1]))
        self._basis = lru_cache(room)(self._render)

    def render(self, names: Iterable[str]) -> None:
        """Have the pictures of these materials ready: rendered, or read from the cache."""
        different = list(dict.fromkeys(names))
        for name in self._work.track(different, "Basis images", len(different)):
            self._basis(name)

    def picture(self, recipe: Recipe) -> np.ndarray:
        """The picture of a recipe, float32, shape (height, width, 3): linear RGB radiance.

        Raises
        ------
        RenderError
            When its blend is not linear, for then the picture of the mix is not the mix of the pictures.
        """
        if not recipe.pictures_mix:
            raise RenderError(
                f"the pictures of a {recipe.blend} mix do not mix: expected a linear recipe, its body as it is. Render the mixed table."
            )
        width, height = self._renderer.size
        mixed = np.zeros((3, height, width), np.float32)
        for i, name in enumerate(recipe.names):
            planes = self._basis(name)
            for channel in range(3):
                if recipe.weights[channel, i] != 0:
                    mixed[channel] += np.float32(recipe.weights[channel, i]) * planes[channel]
        return np.ascontiguousarray(np.moveaxis(mixed, 0, -1))

    def _render(self, name: str) -> np.ndarray:
        """The picture of one material, its channels first."""
        table = self._table(name)
        material = sha256(f"{table.grid}".encode() + table.fingerprint()).hexdigest()[:32]
        arrays = self._work.cached(
            f"picture-{self._scene}-{material}",
            lambda: {"planes": np.moveaxis(self._renderer.picture(table), -1, 0)},
        )
        return np.ascontiguousarray(arrays["planes"])
