"""The explorer as a widget: the page that ``halfway view`` serves, with its place in the space tied to Python's.

The page asks the kernel for what it shows (see `messages`), and both hold the same traits: whoever changes one, the other
follows. The recipe is worked out here, from the place, so it is there before the page is, and without it.
"""

from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any

from anywidget import AnyWidget
from traitlets import Dict, Float, Instance, List, Unicode, default, observe, validate

from ..cache import user_folder
from ..errors import HalfwayError, SpaceError
from ..library import DEFAULT_LIBRARY, Library, open_library
from ..recipes import Blend, Recipe
from ..server import Explorer as Answers
from ..server import Point, app_of, refresh
from ..space import PACES, SPACES, LinearSpace, Route
from ..tasks import Work
from .messages import Answerer

WITH_CACHE = Work(cache=user_folder())
FAVOURITES = ("cherry-235", "gold-metallic-paint")
"""A pair that shows something, where the library has it."""


class Explorer(AnyWidget):
    """The explorer of a library, to be shown by the last line of a cell.

    ``space``, ``blend``, ``pace``, ``stops`` and ``t`` are traits: where it is. Set them to go elsewhere (another space keeps the
    blend), and observe them to follow the person.

    Parameters
    ----------
    library : str or Library
        As `open_library` takes it, or one that is open.
    stops : sequence of str
        The materials that the route goes through, two or more.
    t : float
        Where on the route to begin, in [0, 1].
    space, pace, blend : str
        As ``halfway route`` takes them; the usual blend of the space where none is named.
    work : Work
        Where it keeps what is dear to work out: the cache folder of ``halfway view`` unless told otherwise.

    Attributes
    ----------
    point : trait, list of float or None
        A free place of the space instead of one on the route: its coordinates as the page has them.
    recipe : trait, Recipe
        The material that it shows, on the route, at the free place, or as its page found it by numbers. Read-only; observe it to
        follow.
    route : Route
        The whole way.
    library : Library
        What is explored.

    Examples
    --------
    >>> from halfway.notebook import Explorer
    >>> explorer = Explorer(stops=["teflon", "gold-paint"], space="linear", pace="uniform")
    >>> explorer.t = 0.25
    >>> explorer.recipe.to_json()["weights"]
    {'gold-paint': 0.25, 'teflon': 0.75}
    """

    space = Unicode().tag(sync=True)
    blend = Unicode().tag(sync=True)
    pace = Unicode().tag(sync=True)
    stops = List(Unicode()).tag(sync=True)
    t = Float().tag(sync=True)
    point = List(Float(), allow_none=True, default_value=None).tag(sync=True)
    recipe = Instance(Recipe, read_only=True)
    # What the page shows instead of the place: found by numbers, or taken from its shortlist.
    _held = Dict(allow_none=True, default_value=None).tag(sync=True)

    _esm = Unicode().tag(sync=True)
    _css = Unicode().tag(sync=True)

    def __init__(
        self,
        library: str | Library = DEFAULT_LIBRARY,
        stops: Sequence[str] = (),
        *,
        t: float = 0.5,
        space: str = next(iter(SPACES)),
        pace: str = PACES[0],
        blend: str | None = None,
        work: Work = WITH_CACHE,
    ) -> None:
        self.library = open_library(library)
        self._answers = Answers(self.library, work=work)
        self._route: Route | None = None
        stops = list(stops) or self._favourites()
        usual = SPACES[space].usual_blend if space in SPACES else Blend.LINEAR
        super().__init__(space=space, blend=blend or usual, pace=pace, stops=stops, t=t)
        self._answerer = Answerer(app_of(self._answers), self.send)
        self.on_msg(self._receive)

    @property
    def route(self) -> Route:
        """The way through the stops."""
        way = (self.space, tuple(self.stops), self.pace, self.blend)
        # Several traits may change at once, and each of them says so.
        if self._route is None or _way_of(self._route) != way:
            self._route = self._answers.way(*way)
        return self._route

    def _receive(self, _: Any, message: dict[str, Any], __: list[Any]) -> None:
        self._answerer.receive(message)

    @observe("t")
    def _leave_the_free_place(self, _: Any) -> None:
        self.point = None

    @observe("space", "blend", "pace", "stops", "t", "point")
    def _leave_what_is_held(self, change: dict[str, Any]) -> None:
        if change["new"] is not None:  # the page leaves a free place for what it holds
            self._held = None

    @observe("space", "blend", "pace", "stops", "t", "point", "_held")
    def _show(self, _: Any) -> None:
        if self._held is not None:
            recipe = Recipe.from_json(self._held)
        elif self.point is None:
            recipe = self.route.recipe(self.t)
        else:
            asked = Point(space=self.space, blend=self.blend, point=self.point)
            position = self._answers.position(asked)
            recipe = Recipe.from_json(position.recipe.model_dump())
        self.set_trait("recipe", recipe)

    @validate("space", "pace")
    def _known(self, proposal: dict[str, Any]) -> str:
        name, kind = proposal["value"], proposal["trait"].name
        known = SPACES if kind == "space" else self._answers.summary().paces
        if name not in known:
            raise SpaceError(f"there is no {kind} {name!r}: expected one of {', '.join(known)}.")
        return name

    @validate("blend")
    def _mixable(self, proposal: dict[str, Any]) -> str:
        return str(Blend(proposal["value"]))

    @validate("stops")
    def _reachable(self, proposal: dict[str, Any]) -> list[str]:
        stops = proposal["value"]
        for stop in stops:
            self.library.index(stop)
        # The plainest way there says what no way can be.
        Route.through(LinearSpace.of(self.library), stops)
        return stops

    @validate("t")
    def _on_the_route(self, proposal: dict[str, Any]) -> float:
        t = proposal["value"]
        if not 0 <= t <= 1:
            raise SpaceError(
                f"t = {t:g} is off the route: expected 0 (first stop) to 1 (last stop)."
            )
        return t

    @default("_esm")
    def _module(self) -> str:
        return _bundled("widget.js")

    @default("_css")
    def _style(self) -> str:
        return _bundled("widget.css")

    def _favourites(self) -> list[str]:
        names = self.library.names
        return list(FAVOURITES if set(FAVOURITES) <= set(names) else (names[0], names[-1]))


def _way_of(route: Route) -> tuple[str, tuple[str, ...], str, str]:
    return route.space, route.stops, route.pace, str(route.blend)


def _bundled(name: str) -> str:
    """A file of the built widget; a checkout builds it when it is absent or old."""
    refresh(Path(__file__).parents[3])
    file = files("halfway.notebook") / "bundle" / name
    if not file.is_file():
        raise HalfwayError(
            "this installation of halfway has no notebook widget: install it again from a wheel."
        )
    return file.read_text("utf-8")
