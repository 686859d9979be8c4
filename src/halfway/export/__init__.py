"""What leaves the package: routes as tables, reports."""

from .report import Report, compare_spaces, write_report
from .routes import Written, write_route

__all__ = ["Report", "Written", "compare_spaces", "write_report", "write_route"]
