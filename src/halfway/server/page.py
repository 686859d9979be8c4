"""The page's files, read once: a request is answered from memory, and no path in it touches the disk.

The wheel carries the built page. A checkout builds it when it is absent or older than its source; see `building`.
"""

import gzip
import hashlib
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path

from ..errors import HalfwayError
from . import building

TYPES = {
    ".css": "text/css; charset=utf-8",
    ".exr": "image/x-exr",
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".json": "application/json",
    ".svg": "image/svg+xml",
}


@dataclass(frozen=True)
class Asset:
    """One file of the page."""

    body: bytes
    media_type: str
    etag: str

    @cached_property
    def packed(self) -> bytes:
        """The body by gzip."""
        return gzip.compress(self.body, mtime=0)


@dataclass(frozen=True)
class Page:
    """The files of the page by their path; ``index.html`` is the page itself."""

    assets: Mapping[str, Asset]

    @classmethod
    def load(cls) -> "Page":
        """The page that came with the package.

        Raises
        ------
        HalfwayError
            When this installation has none.
        """
        refresh(Path(__file__).parents[3])
        root = files("halfway.server") / "page"
        if not (root / "index.html").is_file():
            raise HalfwayError(
                "this installation of halfway has no explorer page: install it again from a wheel."
            )
        return cls(dict(_walk(root, "")))


def refresh(root: Path) -> None:
    """Build the page when this is a checkout whose page is absent or old."""
    if not (root / "viewer" / "package.json").is_file() or building.is_current(root):
        return
    print("building the explorer's page (once)", file=sys.stderr, flush=True)
    try:
        building.build(root)
    except RuntimeError as error:
        raise HalfwayError(str(error)) from None


def _walk(folder: Traversable, prefix: str) -> list[tuple[str, Asset]]:
    assets: list[tuple[str, Asset]] = []
    for entry in folder.iterdir():
        if entry.is_dir():
            assets += _walk(entry, f"{prefix}{entry.name}/")
            continue
        suffix = "." + entry.name.rpartition(".")[2]
        if suffix in TYPES:
            body = entry.read_bytes()
            etag = f'"{hashlib.sha256(body).hexdigest()[:16]}"'
            assets.append((prefix + entry.name, Asset(body, TYPES[suffix], etag)))
    return assets
