"""What leaves the package: routes as tables, materials in other formats, reports."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import figures, recovered
    from .fits import MODEL_OF, model_of, write_fit
    from .materials import recipe_beside, write_material, write_materials, write_recipe
    from .pages import html_page, markdown_table
    from .report import Report, TableRow, write_report
    from .routes import write_route
    from .scene_folders import write_scenes
    from .scenes import write_scene
    from .tables import write_tables

__all__ = [
    "MODEL_OF",
    "Report",
    "TableRow",
    "figures",
    "html_page",
    "markdown_table",
    "model_of",
    "recipe_beside",
    "recovered",
    "write_fit",
    "write_material",
    "write_materials",
    "write_recipe",
    "write_report",
    "write_route",
    "write_scene",
    "write_scenes",
    "write_tables",
]

# Who writes a table does not wait for what draws figures.
_HOMES = {
    "fits": ("MODEL_OF", "model_of", "write_fit"),
    "materials": ("recipe_beside", "write_material", "write_materials", "write_recipe"),
    "pages": ("html_page", "markdown_table"),
    "report": ("Report", "TableRow", "write_report"),
    "routes": ("write_route",),
    "scene_folders": ("write_scenes",),
    "scenes": ("write_scene",),
    "tables": ("write_tables",),
}


def __getattr__(name: str) -> Any:
    if name in ("figures", "recovered"):
        return import_module(f".{name}", __name__)
    for home, names in _HOMES.items():
        if name in names:
            return getattr(import_module(f".{home}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
