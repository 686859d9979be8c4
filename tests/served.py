"""An explorer that tests ask as the page does."""

from fastapi.testclient import TestClient

from halfway.library import Library
from halfway.server import Page, create_app
from halfway.server.page import Asset

HOST = "http://127.0.0.1:8765"
PAGE = Page({"index.html": Asset(b"<!doctype html>", "text/html; charset=utf-8", '"1"')})


def client_of(library: Library) -> TestClient:
    """Who asks an explorer of a library."""
    return TestClient(create_app(library, page=PAGE), base_url=HOST)


def recipe_of(blend: str) -> dict[str, object]:
    weights = {"material-1": 0.25, "material-2": 0.5, "material-5": 0.25}
    return {"library": "small", "blend": blend, "weights": weights}
