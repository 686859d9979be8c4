"""How materials, recipes and routes show themselves in a notebook: as lit spheres, registered with IPython where it runs.

Beside the sphere of one material stand its main attributes. Not methods of those classes: a table knows nothing of the
pictures that are made of it.
"""

import sys
from base64 import b64encode
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .brdf import Brdf
    from .recipes import Recipe
    from .space import Route

SIDE_BY_SIDE = "display: flex; align-items: center; gap: 1.5em"

N_SPHERES = 9
"""Spheres that show a route, its ends among them."""


def register() -> None:
    """Tell the IPython shell that is running, if one is, how to show what this package makes."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    if shell is None or shell.display_formatter is None:
        return
    formatters = shell.display_formatter.formatters
    for module, name in (("brdf.brdf", "Brdf"), ("recipes.recipe", "Recipe")):
        formatters["text/html"].for_type_by_name(f"halfway.{module}", name, material_html)
    formatters["image/png"].for_type_by_name("halfway.space.routes", "Route", route_png)


def material_html(what: "Brdf | Recipe") -> str | None:
    """The sphere of a material, and its main attributes; None, for text alone, where its library is out of reach."""
    from .errors import HalfwayError
    from .instruments import described, of_table, table_of
    from .look import table_png

    try:
        table = table_of(what)
    except (HalfwayError, OSError):
        return None
    picture = b64encode(table_png(table)).decode()
    numbers = "\n".join(described(of_table(table)))
    return (
        f'<div style="{SIDE_BY_SIDE}"><img alt="" src="data:image/png;base64,{picture}"/>'
        f"<pre>{numbers}</pre></div>"
    )


def route_png(route: "Route") -> bytes | None:
    """Spheres along a route; None, for text alone, where its library is out of reach."""
    import numpy as np

    from .errors import HalfwayError
    from .library import open_library
    from .look import recipes_png

    weights = route.at(np.linspace(0, 1, N_SPHERES))
    try:
        library = open_library(route.library)
        return recipes_png(library, route.names, weights, route.blend)
    except (HalfwayError, OSError):
        return None
