"""The explorer: a page in the browser, and the API behind it.

    serve(library)          run it on this machine and open the browser
    create_app(library)     the ASGI application alone

Everything the page is told is described in `schema`, once: OpenAPI shows it at ``/api/docs.json``, and the TypeScript
types of the viewer are made from it.
"""

from .app import create_app
from .page import Page
from .run import serve

__all__ = ["Page", "create_app", "serve"]
