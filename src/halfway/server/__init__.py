"""The explorer: a page in the browser, and the API behind it.

    serve(library)          run it on this machine and open the browser
    create_app(library)     the ASGI application alone

Everything the page is told is described in `schema`, once: OpenAPI shows it at ``/api/docs.json``, and the TypeScript
types of the viewer are made from it.
"""

from typing import TYPE_CHECKING, Any

from .page import Page
from .run import serve

if TYPE_CHECKING:
    from .app import create_app

__all__ = ["Page", "create_app", "serve"]


def __getattr__(name: str) -> Any:
    # The web framework takes half a second to load, in which the browser starts already: see `run`.
    if name == "create_app":
        from .app import create_app

        return create_app
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
