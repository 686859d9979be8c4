"""The HTTP face of the explorer: parse, one call, answer.

    GET  /                                       the page, and its files
    GET  /api/library                            what is being explored
    GET  /api/spaces/{space}                     a space as points to look at
    GET  /api/legs/{space}/{start}/{stop}        the way from one material to another: weights at knots
    POST /api/position                           the recipe at a point of a space
    GET  /api/tables/{material}                  a table as half floats (`blocks`)
    GET  /api/thumbnails                         small pictures of all materials, as half floats
    GET  /api/environment                        the studio, as half floats
    POST /api/export/{format}                    a recipe's file: merl or bsdf
    GET  /api/docs.json                          this, as OpenAPI

Every mistake is answered as ``{"error": "one line"}``.
"""

from collections.abc import AsyncIterator, Iterable
from importlib.metadata import version
from threading import Thread
from typing import Annotated, Any

from fastapi import FastAPI, Path, Request, Response
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse, StreamingResponse
from starlette.exceptions import HTTPException

from ..errors import HalfwayError
from ..library import Library
from ..tasks import HERE, Work
from .blocks import Block
from .explorer import SUFFIXES, Explorer
from .guard import LOOPBACK, Guard
from .page import Page
from .schema import (
    LegView,
    LibrarySummary,
    Point,
    PositionView,
    Problem,
    RecipeDocument,
    SpaceView,
)

Name = Annotated[str, Path(max_length=200)]
MISTAKES: dict[int | str, dict[str, Any]] = {400: {"model": Problem}, 404: {"model": Problem}}
BYTES: dict[int | str, dict[str, Any]] = {
    **MISTAKES,
    200: {"content": {"application/octet-stream": {}}},
}
CHUNK = 1 << 20


def create_app(
    library: Library,
    *,
    page: Page | None = None,
    work: Work = HERE,
    hosts: Iterable[str] = LOOPBACK,
    warm: bool = False,
) -> FastAPI:
    """The application that answers for ``library``.

    Without a ``page`` it is the API alone. ``warm`` prepares, beside the first answers, what the first route would wait for.
    """
    return app_of(Explorer(library, work=work), page=page, hosts=hosts, warm=warm)


def app_of(
    explorer: Explorer,
    *,
    page: Page | None = None,
    hosts: Iterable[str] = LOOPBACK,
    warm: bool = False,
) -> FastAPI:
    """The application that answers for a library by its `Explorer`; `create_app` makes both."""
    if warm:
        Thread(target=explorer.warm, daemon=True).start()
    app = FastAPI(
        title="halfway",
        version=version("halfway"),
        openapi_url="/api/docs.json",
        docs_url=None,
        redoc_url=None,
        responses=MISTAKES,
    )
    app.add_middleware(Guard, hosts=tuple(hosts))
    _answer_mistakes(app)
    _add_queries(app, explorer)
    _add_blocks(app, explorer)
    if page is not None:
        _add_page(app, page)
    return app


def _add_queries(app: FastAPI, explorer: Explorer) -> None:
    @app.get("/api/library")
    def library() -> LibrarySummary:
        return explorer.summary()

    @app.get("/api/spaces/{space}")
    def space(space: Name) -> SpaceView:
        return explorer.space_view(space)

    @app.get("/api/legs/{space}/{start}/{stop}")
    def leg(space: Name, start: Name, stop: Name) -> LegView:
        return explorer.leg(space, start, stop)

    @app.post("/api/position")
    def position(point: Point) -> PositionView:
        return explorer.position(point)

    @app.post("/api/export/{format}", response_class=Response, responses=BYTES)
    def export(format: Name, recipe: RecipeDocument) -> StreamingResponse:
        parts = explorer.export(format, recipe)
        headers = {
            "Content-Length": str(sum(map(len, parts))),
            "Content-Disposition": f'attachment; filename="halfway{SUFFIXES[format]}"',
        }
        return StreamingResponse(
            _chunks(parts), media_type="application/octet-stream", headers=headers
        )


def _add_blocks(app: FastAPI, explorer: Explorer) -> None:
    checksum = explorer.library.checksum[:16]

    @app.get("/api/tables/{material}", response_class=Response, responses=BYTES)
    def table(material: Name, request: Request) -> Response:
        # The checksum names every sample of the library, so an answer that the browser kept is good.
        etag = f'"{checksum}-1"'
        if request.headers.get("if-none-match") == etag:
            explorer.library.index(material)
            return Response(status_code=304, headers={"ETag": etag})
        return _block(explorer.table(material), etag)

    @app.get("/api/thumbnails", response_class=Response, responses=BYTES)
    def thumbnails() -> Response:
        return _block(explorer.thumbnails())

    @app.get("/api/environment", response_class=Response, responses=BYTES)
    def environment() -> Response:
        return _block(explorer.environment())


def _add_page(app: FastAPI, page: Page) -> None:
    @app.get("/{path:path}", include_in_schema=False)
    def asset(path: str, request: Request) -> Response:
        found = page.assets.get(path or "index.html")
        if found is None:
            raise HTTPException(404)
        headers = {"ETag": found.etag, "Cache-Control": "no-cache"}
        if request.headers.get("if-none-match") == found.etag:
            return Response(status_code=304, headers=headers)
        return Response(found.body, media_type=found.media_type, headers=headers)


def _answer_mistakes(app: FastAPI) -> None:
    @app.exception_handler(HalfwayError)
    def mistake(_: Request, error: HalfwayError) -> JSONResponse:
        return JSONResponse({"error": str(error)}, 400)

    @app.exception_handler(RequestValidationError)
    def malformed(_: Request, error: RequestValidationError) -> JSONResponse:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        return JSONResponse(
            {"error": f"the request's {where} is not as expected: {first['msg']}."}, 400
        )

    @app.exception_handler(HTTPException)
    def refused(request: Request, error: HTTPException) -> JSONResponse:
        text = (
            f"{request.method} {request.url.path} is nothing this server answers: {error.detail}."
        )
        return JSONResponse({"error": text}, error.status_code)

    @app.exception_handler(Exception)
    def broken(_: Request, error: Exception) -> JSONResponse:
        text = f"the server failed ({type(error).__name__}): see its terminal. This is a fault of halfway, please report it."
        return JSONResponse({"error": text}, 500)


def _block(block: Block, etag: str | None = None) -> Response:
    headers = {**block.headers, "Cache-Control": "no-cache", **({"ETag": etag} if etag else {})}
    return Response(block.body, media_type="application/octet-stream", headers=headers)


async def _chunks(parts: list[bytes | memoryview]) -> AsyncIterator[bytes]:
    for part in parts:
        for start in range(0, len(part), CHUNK):
            yield bytes(part[start : start + CHUNK])
