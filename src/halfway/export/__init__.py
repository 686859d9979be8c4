"""What leaves the package: routes as tables, reports."""

from .report import Report, write_report
from .routes import Written, write_route

__all__ = ["Report", "Written", "write_report", "write_route"]
