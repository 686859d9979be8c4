"""New materials from measured ones.

The names below load when first used, so that ``import halfway`` and ``halfway --help`` are immediate.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from ._display import register

if TYPE_CHECKING:
    from .brdf import Brdf, TabularBrdf, directional_albedo, tabulate
    from .components import Pca
    from .control import find, reach
    from .errors import HalfwayError
    from .formats import read_brdf, write_brdf
    from .halfdiff import MERL, Grid, HalfDiff, from_half_diff, to_half_diff
    from .instruments import attributes
    from .library import Library, build_library, open_library
    from .measurements import Measurements
    from .people import distances
    from .recipes import Recipe, mix
    from .recovery import plan, recover
    from .render import picture
    from .space import LinearSpace, PaperSpace, Route, Space, make_space, route

_HOMES = {
    "brdf": ("Brdf", "TabularBrdf", "directional_albedo", "tabulate"),
    "errors": ("HalfwayError",),
    "halfdiff": ("MERL", "Grid", "HalfDiff", "from_half_diff", "to_half_diff"),
    "components": ("Pca",),
    "control": ("find", "reach"),
    "formats": ("read_brdf", "write_brdf"),
    "instruments": ("attributes",),
    "library": ("Library", "build_library", "open_library"),
    "measurements": ("Measurements",),
    "people": ("distances",),
    "recipes": ("Recipe", "mix"),
    "recovery": ("plan", "recover"),
    "render": ("picture",),
    "space": ("LinearSpace", "PaperSpace", "Route", "Space", "make_space", "route"),
}

__all__ = [
    "MERL",
    "Brdf",
    "Grid",
    "HalfDiff",
    "HalfwayError",
    "Library",
    "LinearSpace",
    "Measurements",
    "PaperSpace",
    "Pca",
    "Recipe",
    "Route",
    "Space",
    "TabularBrdf",
    "attributes",
    "build_library",
    "directional_albedo",
    "distances",
    "find",
    "from_half_diff",
    "make_space",
    "mix",
    "open_library",
    "picture",
    "plan",
    "reach",
    "read_brdf",
    "recover",
    "route",
    "tabulate",
    "to_half_diff",
    "write_brdf",
]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return import_module("importlib.metadata").version(__name__)
    for home, names in _HOMES.items():
        if name in names:
            return getattr(import_module(f".{home}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__


register()
