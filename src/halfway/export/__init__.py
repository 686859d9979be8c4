"""What leaves the package: routes as tables, batches of files and their manifests, reports."""

from .batch import Batch
from .manifest import Checksum, Manifest, Verdict, verify
from .report import Report, compare_spaces, write_report
from .routes import Written, write_route

__all__ = [
    "Batch",
    "Checksum",
    "Manifest",
    "Report",
    "Verdict",
    "Written",
    "compare_spaces",
    "verify",
    "write_report",
    "write_route",
]
