"""What leaves the package: routes as tables, reports."""

from . import figures
from .fits import MODEL_OF, model_of, write_fit
from .materials import recipe_beside, write_material, write_materials
from .report import Report, TableRow, write_report
from .routes import Written, write_route
from .scene_folders import write_scenes
from .scenes import write_scene

__all__ = [
    "MODEL_OF",
    "Report",
    "TableRow",
    "Written",
    "figures",
    "model_of",
    "recipe_beside",
    "write_fit",
    "write_material",
    "write_materials",
    "write_report",
    "write_route",
    "write_scene",
    "write_scenes",
]
