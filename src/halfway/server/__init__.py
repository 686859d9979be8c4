"""The explorer: a page in the browser, and the API behind it.

    serve(library)          run it on this machine and open the browser
    create_app(library)     the ASGI application alone

Everything the page is told is described in `schema`, once: OpenAPI shows it at ``/api/docs.json``, and the TypeScript
types of the viewer are made from it.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .page import Page, refresh
from .run import serve

if TYPE_CHECKING:
    from .app import app_of, create_app
    from .choosing import export_some
    from .explorer import Explorer
    from .schema import Point
    from .static import export

__all__ = [
    "Explorer",
    "Page",
    "Point",
    "app_of",
    "create_app",
    "export",
    "export_some",
    "refresh",
    "serve",
]

# The web framework takes half a second to load, in which the browser starts already: see `run`.
_LATER = {
    "app": ("app_of", "create_app"),
    "choosing": ("export_some",),
    "explorer": ("Explorer",),
    "schema": ("Point",),
    "static": ("export",),
}


def __getattr__(name: str) -> Any:
    for module, names in _LATER.items():
        if name in names:
            return getattr(import_module(f".{module}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
