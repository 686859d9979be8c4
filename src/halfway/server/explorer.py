"""What the explorer knows: a library, its spaces and pictures, and how to answer for them.

No HTTP here. What is dear is computed once, when it is first asked for: the pictures of all materials, and each space. Tables are
kept in bounded number.
"""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import lru_cache, partial
from importlib.metadata import version
from itertools import product
from pathlib import PurePath
from threading import Lock

import numpy as np

from ..brdf import TabularBrdf
from ..components import Pca
from ..control import Control
from ..errors import HalfwayError, RecipeError, SpaceError
from ..halfdiff import Grid
from ..library import Joined, Library
from ..look import Looks, small_grid
from ..people import Impressions, apart
from ..recipes import Blend, Mixer, Recipe
from ..render import SCENES, studio
from ..space import PACES, SPACES, Embedding, Route, Scores, Space, lengths, make_space
from ..space import route as route_through
from ..tasks import HERE, Work
from .blocks import Block
from .drawable import bytes_on_card, coarsened, drawn, drawn_grid
from .finding import attributes_view, found_view, perception_view
from .making import Once, Progress
from .schema import (
    AlikeView,
    AttributesView,
    Axis,
    EmbeddingView,
    FoundView,
    LegView,
    LibrarySummary,
    Material,
    PaceView,
    PerceptionView,
    Point,
    PointLight,
    PositionView,
    RecipeDocument,
    SpaceSummary,
    SpaceView,
    Wanted,
    WeightTable,
)
from .taking import Taken, offered, read, written

N_AXES = 3
"""Scores that can be looked at together."""
TABLES_BYTES = 190e6
"""Of tables kept ready to be sent: 16 of the MERL grid."""
N_LEGS = 1000
"""Legs kept ready to be sent, some 10 kB each."""
QUICK_PACES = ("perceptual", "uniform")
"""Of `halfway.space.PACES`, those whose lengths take no time to speak of: every leg has them."""
MAX_STOPS = 32
MAX_PICTURES = 64


class Explorer:
    """What the page asks of a library: its spaces, routes, tables and pictures, without HTTP.

    ``patience`` is how many seconds an answer may wait for what is computed once, before `NotYetError` says how far that is;
    None waits for it. ``make`` makes its spaces, as `make_space` does.
    """

    def __init__(
        self,
        library: Library,
        *,
        work: Work = HERE,
        patience: float | None = None,
        make: Callable[..., Space] = make_space,
    ) -> None:
        self._patience = patience
        self._make = make
        self._progress = Progress(work.track)
        self._work = replace(work, track=self._progress)
        self._adding = Lock()
        self._begin(library)

    def _begin(self, library: Library) -> None:
        self.library = library
        progress = self._progress
        self._looks = Once(partial(Looks.fit, library, work=self._work), progress)
        self._thumbnails = Once(self._all_spheres, progress)
        self._spaces = {
            (name, blend): Once(
                partial(self._make, name, library, blend=blend, work=self._work), progress
            )
            for name, blend in product(SPACES, Blend)
        }
        self._scores = Once(self._first_scores, progress)
        n_tables = max(1, int(TABLES_BYTES // bytes_on_card(drawn_grid(library.grid))))
        self._block = lru_cache(n_tables)(partial(_block_of, library))
        self._leg = lru_cache(N_LEGS)(self._leg_of)
        self._mixer = Mixer(library, n_rows=12)
        control = partial(Control.of, library, mixer=self._mixer, work=self._work)
        self._control = Once(control, progress)
        self._impressions = Once(partial(Impressions.fit, library, work=self._work), progress)

    def warm(self) -> None:
        """Compute what the first route needs: compiled metrics and solvers take a second to load."""
        with suppress(HalfwayError):  # said to whoever asks
            self._thumbnails.get(None)
            pictures = self._looks.get(None)
            name, kind = next(iter(SPACES.items()))
            space = self._spaces[name, kind.usual_blend].get(None)
            leg_view(Route.through(space, [space.names[0], space.names[-1]]), pictures)

    @property
    def pictures(self) -> Looks:
        """Of all materials."""
        return self._looks.get(self._patience)

    def summary(self) -> LibrarySummary:
        """What is being explored."""
        library = self.library
        return LibrarySummary(
            version=version("halfway"),
            name=library.name,
            address=library.address,
            description=library.origin.description,
            source=library.origin.source,
            licence=library.origin.licence,
            checksum=library.checksum,
            grid=_axes(drawn_grid(library.grid)),
            small_grid=_axes(small_grid(library.grid)),
            materials=[Material(name=name) for name in library.names],
            spaces=[
                SpaceSummary(name=name, text=kind.summary, usual_blend=kind.usual_blend)
                for name, kind in SPACES.items()
            ],
            blends=list(Blend),
            paces=list(PACES),
            lights=[
                PointLight(at=light.at, intensity=light.intensity)
                for light in SCENES["spheres"].points
            ],
            exports=offered(library.grid),
            notice=coarsened(library),
        )

    def space_view(self, name: str, blend: str | None = None) -> SpaceView:
        """The space called ``name``, to be looked at; its first scores where it has no points of its own."""
        space = self.space(name, blend)
        shown = space.embeddings() or [self._scores.get(self._patience)]
        return SpaceView(
            name=space.name,
            has_points=bool(space.charts),
            embeddings=[EmbeddingView.model_validate(each, from_attributes=True) for each in shown],
        )

    def leg(
        self, space: str, start: str, stop: str, blend: str | None = None, pace: str = PACES[0]
    ) -> LegView:
        """The way from one material to another, of which the page makes its routes; with a ``pace`` that is not quick."""
        return self._leg(space, start, stop, blend, pace == "people")

    def way(self, space: str, stops: Sequence[str], pace: str, blend: str | None = None) -> Route:
        """The route through ``stops``."""
        if len(stops) > MAX_STOPS:
            raise SpaceError(
                f"a route of {len(stops)} stops is too long: expected at most {MAX_STOPS}."
            )
        return route_through(
            self.library, *stops, space=self.space(space, blend), pace=pace, work=self._work
        )

    def position(self, asked: Point) -> PositionView:
        """The material at a point of a space, or at the nearest that is a mix."""
        nearest = self.space(asked.space, asked.blend).at(asked.point, clamp=True)
        recipe = RecipeDocument.model_validate(nearest.recipe.to_json())
        return PositionView(recipe=recipe, point=nearest.point.tolist(), inside=nearest.inside)

    def attributes(self) -> AttributesView:
        """What instruments read off all materials."""
        return attributes_view(self._control.get(self._patience))

    def find(self, wanted: Wanted) -> FoundView:
        """The recipe that has what is wanted, or misses least of it."""
        return found_view(self._control.get(self._patience), self._recipe(wanted.like), wanted)

    def perceived(self, document: RecipeDocument) -> PerceptionView:
        """How people would perceive a recipe."""
        perception = self._impressions.get(self._patience).perception
        return perception_view(perception, self._mixer.mix(self._recipe(document)))

    def alike(self, document: RecipeDocument) -> AlikeView:
        """How different people would find each material from a recipe."""
        impressions, recipe = self._impressions.get(self._patience), self._recipe(document)
        point = impressions.of(recipe.material or self._mixer.mix(recipe))
        return AlikeView(distances=apart(impressions.points, point).tolist())

    def table(self, name: str) -> Block:
        """The table of one material."""
        return self._block(name)

    def mixed(self, document: RecipeDocument, *, small: bool = False) -> Block:
        """The table of a recipe; or a ``small`` one on a coarser grid, in milliseconds."""
        recipe = self._recipe(document)
        if not small:
            return Block.of_table(drawn(self._mixer.mix(recipe)))
        tables = self.pictures.tables
        values = tables.of(recipe)
        return Block.of_table(TabularBrdf(values.reshape(3, *tables.grid.shape), tables.grid))

    def thumbnails(self) -> Block:
        """Pictures of all materials on a lit sphere, linear (`Block.of_pictures`)."""
        return self._thumbnails.get(self._patience)

    def thumbnails_of(self, documents: Sequence[RecipeDocument]) -> Block:
        """Such pictures of recipes.

        Raises
        ------
        RecipeError
            When there is none, or too many.
        """
        if not 0 < len(documents) <= MAX_PICTURES:
            raise RecipeError(
                f"pictures of {len(documents)} recipes were asked for: expected 1 to {MAX_PICTURES}."
            )
        recipes = [self._recipe(document) for document in documents]
        return self._spheres(np.stack([self.pictures.of(each) for each in recipes]))

    def _all_spheres(self) -> Block:
        block = self._spheres(self._looks.get(None).images)
        # Two seconds for thousands: before they are asked for.
        _ = block.packed
        return block

    def _spheres(self, images: np.ndarray) -> Block:
        return Block.of_pictures(images, self._looks.get(None).scene.mask())

    def environment(self) -> Block:
        """The studio of soft boxes as a latitude-longitude picture; the top row looks up, the middle column to +y."""
        picture = studio()
        return Block.of(picture, np.ones(picture.shape[:-1]))

    def export(self, format: str, document: RecipeDocument) -> Taken:
        """The file of a recipe."""
        recipe = self._recipe(document)
        return written(self._mixer.mix(recipe), format, origin=self.library.origin.description)

    def add(self, file: str, content: bytes) -> str:
        """Take the measurement in a file in, beside the library's materials, until the explorer ends; what it is called."""
        brdf = read(PurePath(file).name, content)
        with self._adding:
            stem = PurePath(file).stem
            taken = [name for name in self.library.names if name.partition(" (")[0] == stem]
            name = f"{stem} ({len(taken) + 1})" if taken else stem
            self._begin(Joined(self.library, name, brdf))
        return name

    def _recipe(self, document: RecipeDocument) -> Recipe:
        recipe = Recipe.from_json(document.model_dump())
        if recipe.library.name != self.library.name:
            raise RecipeError(
                f"the recipe is of the library {recipe.library.name!r}, and this explorer shows {self.library.name!r}: "
                "open that library with `halfway view`."
            )
        return recipe

    def _first_scores(self) -> Embedding:
        """The first scores of all channels, of which nothing is a point to go to."""
        scores = Scores.joint(Pca.fit(self.library, work=self._work), N_AXES)
        axes = [name.replace("_", " ") for name in scores.names]
        return Embedding(scores.label, "all", axes, scores.points, [])

    def _leg_of(
        self, space: str, start: str, stop: str, blend: str | None, is_by_people: bool
    ) -> LegView:
        route = Route.through(self.space(space, blend), [start, stop])
        leg = leg_view(route, self.pictures)
        if not is_by_people:
            return leg
        people = _pace_view(route, self._impressions.get(self._patience))
        return leg.model_copy(update={"paces": {**leg.paces, "people": people}})

    def space(self, name: str, blend: str | None = None) -> Space:
        """The space called ``name``; with its usual blend unless another is named."""
        if name not in SPACES:
            # Says which there are.
            make_space(name, self.library)
        mixed = Blend(blend or SPACES[name].usual_blend)
        return self._spaces[name, mixed].get(self._patience)


def leg_view(route: Route, pictures: Looks) -> LegView:
    """A route of two stops as its knots, with the materials that carry weight anywhere on it."""
    used = route.used()
    r, g, b = route.way.weights[:, :, used].clip(0, 1).tolist()
    return LegView(
        names=[route.names[i] for i in used],
        knots=route.way.knots.tolist(),
        weights=WeightTable(r=r, g=g, b=b),
        paces={
            "perceptual": _pace_view(route, pictures),
            "uniform": PaceView(t=[0.0, 1.0], length=[0.0, 1.0]),
        },
    )


def _pace_view(route: Route, by: Looks | Impressions) -> PaceView:
    t, length = lengths(route, by)
    return PaceView(t=t.tolist(), length=length.tolist())


def _axes(grid: Grid) -> list[Axis]:
    return [Axis.model_validate(vars(axis)) for axis in grid.axes]


def _block_of(library: Library, name: str) -> Block:
    return Block.of_table(drawn(library.brdf(name)))
