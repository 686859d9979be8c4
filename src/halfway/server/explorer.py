"""What the explorer knows: a library, its spaces and pictures, and how to answer for them.

No HTTP here. What is dear is computed once: the principal components and the thumbnails when the explorer is made, a
space when it is first asked for. Tables are kept in bounded number.
"""

from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Lock

import numpy as np

from ..components import Pca
from ..errors import OutputError, OutsideHullError, RecipeError, SpaceError
from ..formats import MerlFile, encode_header, write_brdf
from ..library import Library
from ..look import Looks
from ..recipes import Mixer, Recipe
from ..render import SCENES, studio
from ..space import (
    SPACES,
    AnchoredSpace,
    DelaunayWalk,
    PaperSpace,
    Route,
    Space,
    Triangulation,
    make_space,
    nearest_in_hull,
    perceptual,
)
from ..tasks import HERE, Work, silent
from .blocks import Block
from .embedding import look_at
from .schema import (
    Axis,
    LibrarySummary,
    Material,
    Place,
    PlaceView,
    PointLight,
    RecipeDocument,
    RouteView,
    SpaceSummary,
    SpaceView,
    WeightTable,
)

N_TABLES = 16
"""Tables kept ready to be sent, 11.7 MB each on the MERL grid."""
MAX_STOPS = 32
INSIDE = 1e-6
"""A place counts as reached within this share of the extent of each coordinate."""
TEXTS = {
    "anchored": "one recipe for all channels; keeps body colours on the straight way between them",
    "paper": "one triangulation per channel, of its first three scores",
    "linear": "the two end materials in plain proportion",
}
PACES = ("perceptual", "uniform")
SUFFIXES = {"merl": ".binary", "bsdf": ".bsdf"}
"""Formats to take a material home in."""


class Explorer:
    """Answers for one library."""

    def __init__(self, library: Library, *, work: Work = HERE) -> None:
        self.library = library
        self._work = work
        self._pca = Pca.fit(library, work=work)
        self.pictures = Looks.fit(library, work=work)
        # The page opens with the first space; the others are made when they are asked for.
        self._spaces = {SPACES[0]: make_space(SPACES[0], library, work=work)}
        self._making = Lock()
        self._tables: OrderedDict[str, Block] = OrderedDict()
        self._mixer = Mixer(library, n_rows=8)
        self._lock = Lock()

    def warm(self) -> None:
        """Make what the first route needs: compiled metrics and solvers take a second to load."""
        self.route(SPACES[0], [self.library.names[0], self.library.names[-1]], PACES[0])

    def summary(self) -> LibrarySummary:
        """What is being explored."""
        library = self.library
        colours = np.median(self.pictures.images, axis=1).clip(0).tolist()
        return LibrarySummary(
            version=version("halfway"),
            name=library.name,
            description=library.origin.description,
            source=library.origin.source,
            licence=library.origin.licence,
            checksum=library.checksum,
            grid=[Axis.model_validate(vars(axis)) for axis in library.grid.axes],
            materials=[
                Material(name=name, colour=(r, g, b))
                for name, (r, g, b) in zip(library.names, colours, strict=True)
            ],
            spaces=[SpaceSummary(name=name, text=TEXTS.get(name, "")) for name in SPACES],
            paces=list(PACES),
            thumbnail_size=self.pictures.scene.size,
            lights=[
                PointLight(at=light.at, intensity=light.intensity)
                for light in SCENES["spheres"].points
            ],
            exports=list(SUFFIXES),
        )

    def space_view(self, name: str) -> SpaceView:
        """The space called ``name``, to be looked at."""
        return look_at(self.space(name), self._pca)

    def route(self, space: str, stops: Sequence[str], pace: str) -> RouteView:
        """The route through ``stops``, as the page takes it."""
        return to_view(self.way(space, stops, pace))

    def way(self, space: str, stops: Sequence[str], pace: str) -> Route:
        """The route through ``stops``."""
        if len(stops) > MAX_STOPS:
            raise SpaceError(
                f"a route of {len(stops)} stops is too long: expected at most {MAX_STOPS}."
            )
        if pace not in PACES:
            raise SpaceError(f"there is no pace {pace!r}: expected {' or '.join(PACES)}.")
        route = Route.through(self.space(space), stops)
        return perceptual(route, self.pictures) if pace == "perceptual" else route

    def place(self, place: Place) -> PlaceView:
        """The material at a free place of a space."""
        space = self.space(place.space)
        point = np.array(place.point)
        match space:
            case AnchoredSpace():
                recipe = space.recipe(point, clamp=True)
                reached = self._dense(recipe)[0] @ space.points
                inside = bool(
                    np.abs((reached - point) / np.ptp(space.points, axis=0)).max() < INSIDE
                )
                return _to_view(recipe, reached, inside=inside)
            case PaperSpace():
                n_axes = space.triangulations[0].points.shape[1]
                if point.size != 3 * n_axes:
                    raise SpaceError(
                        f"the point has {point.size} coordinates: expected {n_axes} for each channel."
                    )
                return _place_in_each_channel(space, point.reshape(3, n_axes))
            case _:
                raise SpaceError(
                    f"the space {place.space!r} has no places between its routes: choose another space."
                )

    def table(self, name: str) -> Block:
        """The table of one material."""
        with self._lock:
            if name in self._tables:
                self._tables.move_to_end(name)
                return self._tables[name]
        block = Block.of_table(self.library.brdf(name))
        with self._lock:
            self._tables[name] = block
            while len(self._tables) > N_TABLES:
                self._tables.popitem(last=False)
        return block

    def thumbnails(self) -> Block:
        """Pictures of all materials on a lit sphere, (N, size, size, RGBA), linear, black beside the sphere."""
        mask = self.pictures.scene.mask()
        pictures = np.zeros((len(self.library), *mask.shape, 3), np.float32)
        pictures[:, mask] = self.pictures.images.clip(0)
        return Block.of(pictures, np.broadcast_to(mask, pictures.shape[:-1]))

    def environment(self) -> Block:
        """The studio of soft boxes as a latitude-longitude picture; the top row looks up, the middle column to +y."""
        picture = studio()
        return Block.of(picture, np.ones(picture.shape[:-1]))

    def export(self, format: str, document: RecipeDocument) -> list[bytes | memoryview]:
        """The file of a recipe, in parts: what ``halfway mix`` writes."""
        if format not in SUFFIXES:
            raise OutputError(
                f"{format!r} is no format to export: expected {' or '.join(SUFFIXES)}."
            )
        recipe = Recipe.from_json(document.model_dump())
        if recipe.library != self.library.name:
            raise RecipeError(
                f"the recipe is of the library {recipe.library!r}, and this explorer shows {self.library.name!r}: "
                "open that library with `halfway view`."
            )
        table = self._mixer.mix(recipe)
        if format == "merl":
            merl = MerlFile.from_table(table)
            return [
                encode_header(merl.grid),
                np.ascontiguousarray(merl.samples, "<f8").data.cast("B"),
            ]
        with TemporaryDirectory(prefix="halfway-") as folder:
            path = Path(folder) / f"table{SUFFIXES[format]}"
            write_brdf(path, table)
            return [path.read_bytes()]

    def _dense(self, recipe: Recipe) -> np.ndarray:
        """Weights over all materials, (3, N)."""
        weights = np.zeros((3, len(self.library)))
        weights[:, [self.library.index(name) for name in recipe.names]] = recipe.weights
        return weights

    def space(self, name: str) -> Space:
        """The space called ``name``, made when it is first asked for."""
        with self._making:
            if name not in self._spaces:
                self._spaces[name] = make_space(
                    name, self.library, work=replace(self._work, track=silent)
                )
            return self._spaces[name]


def _place_in_each_channel(space: PaperSpace, point: np.ndarray) -> PlaceView:
    """The material at a point (3, k) of the paper's space, or the nearest in the channels that are outside their hull."""
    try:
        return _to_view(space.recipe(point), point.ravel(), inside=True)
    except OutsideHullError:
        nearest = np.stack(
            [_nearest(t, x) for t, x in zip(space.triangulations, point, strict=True)]
        )
    reached = np.stack([w @ t.points for w, t in zip(nearest, space.triangulations, strict=True)])
    recipe = Recipe.from_dense(space.library, space.names, nearest)
    return _to_view(recipe, reached.ravel(), inside=False)


def _nearest(triangulation: Triangulation | DelaunayWalk, x: np.ndarray) -> np.ndarray:
    """Weights at ``x``, or at the nearest point of the hull, each score in units of its spread."""
    try:
        return triangulation.weights(x)
    except OutsideHullError:
        spread = triangulation.points.std(axis=0)
        return nearest_in_hull(triangulation.points / spread, x / spread)


def _to_view(recipe: Recipe, point: np.ndarray, *, inside: bool) -> PlaceView:
    """A place with its recipe."""
    document = RecipeDocument.model_validate(recipe.to_json())
    return PlaceView(recipe=document, point=point.tolist(), inside=inside)


def to_view(route: Route) -> RouteView:
    """The route as its knots, with the materials that carry weight anywhere on it."""
    used = np.flatnonzero(route.weights.any(axis=(0, 1)))
    r, g, b = route.weights[:, :, used].clip(0, 1).tolist()
    return RouteView(
        library=route.library,
        space=route.space,
        pace=route.pace,
        stops=list(route.stops),
        stop_t=route.stop_ts.tolist(),
        crossings=_crossings(route),
        knots=route.knots.tolist(),
        names=[route.names[i] for i in used],
        weights=WeightTable(r=r, g=g, b=b),
    )


def _crossings(route: Route) -> list[float]:
    """The inner knots at which the set of materials that carry weight changes."""
    carries = route.weights > 0
    pieces = carries[:, :-1] | carries[:, 1:]
    changes = (pieces[:, 1:] != pieces[:, :-1]).any(axis=(0, 2))
    return route.knots[1:-1][changes].tolist()
