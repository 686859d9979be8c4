"""How tables, recipes and routes show themselves in a notebook: as lit spheres, registered with IPython where it runs.

Not methods of those classes: a table knows nothing of the pictures that are made of it.
"""

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .recipes import Recipe
    from .space import Route

N_SPHERES = 9
"""Spheres that show a route, its ends among them."""


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
    from .errors import HalfwayError
    from .library import open_library
    from .look import table_png
    from .recipes import mix

    try:
        return table_png(mix(open_library(recipe.library.address or recipe.library.name), recipe))
    except (HalfwayError, OSError):
        return None


def route_png(route: "Route") -> bytes | None:
    """Spheres along a route; None, for text alone, where its library is out of reach."""
    import numpy as np

    from .errors import HalfwayError
    from .library import open_library
    from .look import recipes_png

    weights = route.at(np.linspace(0, 1, N_SPHERES))
    try:
        library = open_library(route.library.address or route.library.name)
        return recipes_png(library, route.names, weights, route.blend)
    except (HalfwayError, OSError):
        return None
