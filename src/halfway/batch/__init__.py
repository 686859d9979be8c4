"""Folders of many files: written so that nothing is lost when a run is killed, and read again to see that all is there."""

from .batch import Batch, Written
from .filling import filling, keeping, require_own
from .manifest import Checksum, Manifest, Verdict, verify

__all__ = [
    "Batch",
    "Checksum",
    "Manifest",
    "Verdict",
    "Written",
    "filling",
    "keeping",
    "require_own",
    "verify",
]
