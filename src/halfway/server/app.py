"""The HTTP face of the explorer: parse, one call, answer.

    GET  /                                       the page, and its files
    GET  /api/library                            what is being explored
    GET  /api/spaces/{space}                     a space as points to look at
    GET  /api/legs/{space}/{start}/{stop}        the way from one material to another: weights at knots
    POST /api/position                           the recipe at a point of a space
    GET  /api/attributes                         the attributes of all materials
    POST /api/find                               the recipe that is like another and has some attributes
    POST /api/perceived                          how people would perceive a recipe
    POST /api/alike                              how different people would find each material from a recipe
    GET  /api/tables/{material}                  a table as half floats (`blocks`)
    POST /api/mix                                the table of a recipe, as half floats; ?small=true: a small one
    GET  /api/thumbnails                         small pictures of all materials, with shared exponents
    POST /api/thumbnails                         such pictures of recipes
    GET  /api/environment                        the studio, as half floats
    POST /api/export/{format}                    a recipe's file (`taking`)
    POST /api/materials/{file}                   a measurement that is a material from now on: its file
    GET  /api/docs.json                          this, as OpenAPI

Spaces and legs take ``?blend=``; without it they are in the space's usual blend. Every mistake is answered as ``{"error": "one line"}``. What takes longer than the explorer's patience is answered with 202 and how far
it is (`NotYet`): ask again. ``?pace=people`` asks a leg for that pace, too. Large answers are compressed where the browser takes it, and name their content (ETag).
"""

from collections.abc import AsyncIterator, Callable, Iterable, Mapping
from importlib.metadata import version
from threading import Thread
from typing import Annotated, Any
from urllib.parse import quote

from fastapi import FastAPI, Path, Query, Request, Response
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse, StreamingResponse
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException

from ..errors import HalfwayError
from ..library import Library
from ..space import PACES
from ..tasks import HERE, Work
from .blocks import Block
from .explorer import Explorer
from .guard import LOOPBACK, Guard
from .making import NotYetError
from .page import Asset, Page
from .schema import (
    Added,
    AlikeView,
    AttributesView,
    FoundView,
    LegView,
    LibrarySummary,
    NotYet,
    PerceptionView,
    Point,
    PositionView,
    Problem,
    RecipeDocument,
    SpaceView,
    Wanted,
)
from .taking import SUFFIXES

Name = Annotated[str, Path(max_length=200)]
Pace = Annotated[str, Query(pattern=f"^({'|'.join(PACES)})$")]
MISTAKES: dict[int | str, dict[str, Any]] = {400: {"model": Problem}, 404: {"model": Problem}}
BYTES: dict[int | str, dict[str, Any]] = {
    **MISTAKES,
    200: {"content": {"application/octet-stream": {}}},
}
CHUNK = 1 << 20
REVALIDATED = "no-cache"
IMMUTABLE = "public, max-age=31536000, immutable"
"""Of files whose name has a hash of their content."""
HASHED = "assets/"


def create_app(
    library: Library,
    *,
    page: Page | None = None,
    work: Work = HERE,
    hosts: Iterable[str] = LOOPBACK,
    warm: bool = False,
    patience: float | None = None,
) -> FastAPI:
    """The application that answers for ``library``.

    Without a ``page`` it is the API alone. ``warm`` prepares, beside the first answers, what the first route would wait for;
    ``patience`` is that of `Explorer`.
    """
    explorer = Explorer(library, work=work, patience=patience)
    return app_of(explorer, page=page, hosts=hosts, warm=warm)


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
    _add_numbers(app, explorer)
    _add_blocks(app, explorer)
    if page is not None:
        _add_page(app, page)
    return app


def _add_queries(app: FastAPI, explorer: Explorer) -> None:
    @app.get("/api/library")
    def library() -> LibrarySummary:
        return explorer.summary()

    @app.get("/api/spaces/{space}")
    def space(space: Name, blend: str | None = None) -> SpaceView:
        return explorer.space_view(space, blend)

    @app.get("/api/legs/{space}/{start}/{stop}")
    def leg(
        space: Name, start: Name, stop: Name, blend: str | None = None, pace: Pace = PACES[0]
    ) -> LegView:
        return explorer.leg(space, start, stop, blend, pace)

    @app.post("/api/position")
    def position(point: Point) -> PositionView:
        return explorer.position(point)

    @app.post("/api/export/{format}", response_class=Response, responses=BYTES)
    def export(format: Name, recipe: RecipeDocument) -> StreamingResponse:
        parts, summary = explorer.export(format, recipe)
        headers = {
            "Content-Length": str(sum(map(len, parts))),
            "Halfway-Summary": quote(summary),
            "Content-Disposition": f'attachment; filename="halfway{SUFFIXES[format]}"',
        }
        return StreamingResponse(
            _chunks(parts), media_type="application/octet-stream", headers=headers
        )

    @app.post("/api/materials/{file}")
    async def add(file: Name, request: Request) -> Added:
        content = await request.body()
        return Added(name=await run_in_threadpool(explorer.add, file, content))


def _add_numbers(app: FastAPI, explorer: Explorer) -> None:
    @app.get("/api/attributes")
    def attributes() -> AttributesView:
        return explorer.attributes()

    @app.post("/api/find")
    def find(wanted: Wanted) -> FoundView:
        return explorer.find(wanted)

    @app.post("/api/perceived")
    def perceived(recipe: RecipeDocument) -> PerceptionView:
        return explorer.perceived(recipe)

    @app.post("/api/alike")
    def alike(recipe: RecipeDocument) -> AlikeView:
        return explorer.alike(recipe)


def _add_blocks(app: FastAPI, explorer: Explorer) -> None:
    def answer(request: Request, of: Callable[[], Block]) -> Response:
        # The checksum names every sample of the library, so an answer that the browser kept is good.
        etag = f'"{explorer.library.checksum[:16]}-2"'
        if request.headers.get("if-none-match") == etag:
            return _unchanged(etag, REVALIDATED)
        block = of()
        return _content(request, block, "application/octet-stream", etag, block.headers)

    @app.get("/api/tables/{material}", response_class=Response, responses=BYTES)
    def table(material: Name, request: Request) -> Response:
        explorer.library.index(material)
        return answer(request, lambda: explorer.table(material))

    @app.get("/api/thumbnails", response_class=Response, responses=BYTES)
    def thumbnails(request: Request) -> Response:
        return answer(request, explorer.thumbnails)

    @app.post("/api/mix", response_class=Response, responses=BYTES)
    def mix(recipe: RecipeDocument, small: bool = False) -> Response:
        return _plain(explorer.mixed(recipe, small=small))

    @app.post("/api/thumbnails", response_class=Response, responses=BYTES)
    def thumbnails_of(recipes: list[RecipeDocument]) -> Response:
        return _plain(explorer.thumbnails_of(recipes))

    @app.get("/api/environment", response_class=Response, responses=BYTES)
    def environment(request: Request) -> Response:
        return answer(request, explorer.environment)


def _add_page(app: FastAPI, page: Page) -> None:
    @app.get("/{path:path}", include_in_schema=False)
    def asset(path: str, request: Request) -> Response:
        file = page.assets.get(path or "index.html")
        if file is None:
            raise HTTPException(404)
        kept = IMMUTABLE if path.startswith(HASHED) else REVALIDATED
        if request.headers.get("if-none-match") == file.etag:
            return _unchanged(file.etag, kept)
        return _content(request, file, file.media_type, file.etag, {"Cache-Control": kept})


def _answer_mistakes(app: FastAPI) -> None:
    @app.exception_handler(HalfwayError)
    def mistake(_: Request, error: HalfwayError) -> JSONResponse:
        return JSONResponse({"error": str(error)}, 400)

    @app.exception_handler(NotYetError)
    def later(_: Request, error: NotYetError) -> JSONResponse:
        return JSONResponse(NotYet(error=str(error), progress=error.progress).model_dump(), 202)

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


def _content(
    request: Request, content: Asset | Block, media_type: str, etag: str, more: Mapping[str, str]
) -> Response:
    headers = {"Cache-Control": REVALIDATED, "ETag": etag, "Vary": "Accept-Encoding", **more}
    if "gzip" not in request.headers.get("accept-encoding", ""):
        return Response(content.body, media_type=media_type, headers=headers)
    headers["Content-Encoding"] = "gzip"
    return Response(content.packed, media_type=media_type, headers=headers)


def _plain(block: Block) -> Response:
    """An answer that is not asked for again: compressing it would take longer than sending it."""
    return Response(block.body, media_type="application/octet-stream", headers=block.headers)


def _unchanged(etag: str, kept: str) -> Response:
    return Response(status_code=304, headers={"ETag": etag, "Cache-Control": kept})


async def _chunks(parts: list[bytes | memoryview]) -> AsyncIterator[bytes]:
    for part in parts:
        for start in range(0, len(part), CHUNK):
            yield bytes(part[start : start + CHUNK])
