"""What leaves the package: routes as tables, reports."""

from . import figures
from .fits import MODEL_OF, model_of, write_fit
from .report import Report, TableRow, write_report
from .routes import Written, write_route
from .scenes import write_scene

__all__ = [
    "MODEL_OF",
    "Report",
    "TableRow",
    "Written",
    "figures",
    "model_of",
    "write_fit",
    "write_report",
    "write_route",
    "write_scene",
]
