"""How tables, recipes and routes show themselves in a notebook: as lit spheres, registered with IPython where it runs.

Not methods of those classes: a table knows nothing of the pictures that are made of it.
"""

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

    from .library import LibraryRef
    from .recipes import Blend, Recipe
    from .space import Route


def register() -> None:
    """Tell the IPython shell that is running, if one is, how to show what this package makes."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    if shell is None or shell.display_formatter is None:
        return
    png = shell.display_formatter.formatters["image/png"]
    png.for_type_by_name("halfway.brdf.table", "TabularBrdf", _table)
    png.for_type_by_name("halfway.recipes.recipe", "Recipe", recipe_png)
    png.for_type_by_name("halfway.space.routes", "Route", route_png)


def _table(table: object) -> bytes:
    from .look import table_png

    return table_png(table)  # pyright: ignore[reportArgumentType] (IPython calls it for tables)


def recipe_png(recipe: "Recipe") -> bytes | None:
    """The sphere of a recipe; None, for text alone, where its library is out of reach."""
    return _recipes_png(recipe.library, recipe.names, recipe.weights[:, None], recipe.blend)


def route_png(route: "Route") -> bytes | None:
    """Spheres along a route; None, for text alone, where its library is out of reach."""
    import numpy as np

    from .look import N_SPHERES

    return _recipes_png(
        route.library, route.names, route.at(np.linspace(0, 1, N_SPHERES)), route.blend
    )


def _recipes_png(
    library: "LibraryRef", names: tuple[str, ...], weights: "np.ndarray", blend: "Blend"
) -> bytes | None:
    from .errors import HalfwayError
    from .library import open_library
    from .look import recipes_png

    try:
        return recipes_png(open_library(library.address or library.name), names, weights, blend)
    except (HalfwayError, OSError):
        return None
