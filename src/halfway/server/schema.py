"""What the page and the server say to each other, as JSON.

One description for both sides: FastAPI checks and documents it, and ``viewer/scripts/make_types.py`` writes the
TypeScript types from it. The words are those of the package: material, space, route, recipe, stop, knot.
"""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

Channel = Literal["r", "g", "b"]
Vector = tuple[float, float, float]
Weight = Annotated[float, Field(ge=0, le=1)]
WeightsByName = dict[str, Weight]
Factor = Annotated[float, Field(ge=0)]


class Model(BaseModel):
    """Finished when it exists; nothing unknown is taken."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Problem(Model):
    """What went wrong, in one line that says what to do."""

    error: str


class ProgressView(Model):
    """How far what is being computed is."""

    label: str
    done: int
    total: int
    seconds: float
    """That it took until now."""


class NotYet(Model):
    """An answer that is still being computed: ask again."""

    error: str
    progress: ProgressView | None


class Material(Model):
    """One measured material of the library."""

    name: str


class Axis(Model):
    """One axis of the grid; see `halfway.halfdiff.Axis`."""

    angle: str
    size: int
    stop: float
    power: int
    periodic: bool


class SpaceSummary(Model):
    """A space that routes can go through."""

    name: str
    text: str
    """One line on what it is."""
    usual_blend: str
    """How its recipes are mixed unless a person says otherwise."""


class PointLight(Model):
    """A point light; world coordinates have z up, y away from the camera."""

    at: Vector
    intensity: float


class LibrarySummary(Model):
    """What is being explored."""

    format: Literal[1] = 1
    version: str
    name: str
    address: str
    """What opens it."""
    description: str
    """One line; says "stand-in" where the materials are fits and not measurements."""
    source: str
    licence: str
    checksum: str
    grid: list[Axis]
    """On which tables are sent: the library's, or a coarser one."""
    small_grid: list[Axis]
    """Of the small tables of mixes."""
    materials: list[Material]
    spaces: list[SpaceSummary]
    blends: list[str]
    paces: list[str]
    lights: list[PointLight]
    """Of the scene of three point lights."""
    exports: list[str]
    """Formats of ``/api/export/{format}``."""
    recolours: bool = True
    """Whether tables of recipes whose body is scaled are to be had."""
    notice: str = ""
    """One line that the page says from the start; empty for none."""


class EmbeddingView(Model):
    """The materials as points, whose first three coordinates can be looked at."""

    name: str
    channel: Channel | Literal["all"]
    """Whose weights place a mix in it."""
    axes: list[str]
    """What the coordinates are."""
    points: list[list[float]]
    """In the library's order; the point of a mix is the mix of the points."""
    edges: list[tuple[int, int]]
    """Of the triangulation, or of the hull where the triangulation has more dimensions; empty where there is neither."""


class SpaceView(Model):
    """A space, to be looked at: one embedding, or one per channel."""

    name: str
    has_points: bool
    """Whether a mix stands at any point between the materials."""
    embeddings: list[EmbeddingView]


class WeightTable(Model):
    """Weights at the knots of a leg, per channel: ``[knot][name]``."""

    r: list[list[Weight]]
    g: list[list[Weight]]
    b: list[list[Weight]]


class PaceView(Model):
    """How far a leg has come, at some t of it; linear between."""

    t: list[float]
    """Ascending from 0 to 1."""
    length: list[float]
    """Ascending from 0 to how long the leg is beside others."""


class LegView(Model):
    """The way from one material to another in a space, as weights at knots between which they are linear in t."""

    names: list[str]
    """The materials that carry weight anywhere on it."""
    knots: list[float]
    """Ascending from 0 to 1."""
    weights: WeightTable
    paces: dict[str, PaceView]
    """For each pace: equal lengths take equal times."""


class ChannelWeights(Model):
    """A recipe's weights where the channels differ."""

    r: WeightsByName
    g: WeightsByName
    b: WeightsByName


class RecipeDocument(Model):
    """A recipe: barycentric weights over materials, how they are mixed, and what the body of that is multiplied by."""

    library: str
    blend: str = "linear"
    weights: ChannelWeights | WeightsByName
    body_scale: tuple[Factor, Factor, Factor] | None = None
    """In each channel; null for one that is as it was mixed."""


class Point(Model):
    """A point of a space: the coordinates of its embeddings, one embedding after another."""

    space: str
    blend: str | None = None
    """That of the space; its usual one unless another is named."""
    point: Annotated[list[float], Field(min_length=1, max_length=24)]


class PositionView(Model):
    """The material at a point of a space."""

    recipe: RecipeDocument
    point: list[float]
    """The point asked for, or the nearest that is a mix."""
    inside: bool
    """Whether the point asked for is a mix."""


class AttributeView(Model):
    """An attribute, and its values over the library; see `halfway.instruments`."""

    name: str
    label: str
    unit: str
    needs: str
    """Another attribute that has to be asked for beside it; none if empty."""
    values: list[float | None]
    """In the library's order; null for a material that has none."""


class AttributesView(Model):
    """The attributes that are one number."""

    attributes: list[AttributeView]


class Wanted(Model):
    """A recipe that is like another one, and has these attributes and perceived qualities."""

    like: RecipeDocument
    """Its blend is that of both."""
    set: Annotated[dict[str, float | str], Field(max_length=24)]
    """Numbers, and colours as #rrggbb."""
    release: Annotated[list[str], Field(max_length=24)] = []
    """What of the highlight need not be held beside another body colour."""
    ranges: Annotated[list[str], Field(max_length=24)] = []
    """Attributes of which the ends are wanted, too."""
    draft: bool = False
    """Whether a recipe will do that has them roughly, where its blend is not linear: it is found sooner."""


class GivenUp(Model):
    """An attribute that should have stayed what it was."""

    name: str
    was: str
    now: str


class FoundView(Model):
    """The recipe that misses least of what is wanted."""

    recipe: RecipeDocument
    attributes: dict[str, float | None]
    """That it has, with the perceived qualities that are wanted."""
    missed: list[str]
    """The numbers that are wanted and that it does not have, nearly enough; empty in a draft."""
    body: str
    """The body colour that it has, as #rrggbb."""
    difference: float | None
    """Of that from the one that is wanted, in CIEDE2000; null where none is."""
    given_up: list[GivenUp]
    """What of the highlight, or the colour, was held and could not be; empty in a draft."""
    ranges: dict[str, tuple[float, float]]
    """How far each goes with the others held, of linear mixes; without those that no mix has beside them, and none beside perceived qualities."""


class AlikeView(Model):
    """How different people would find each material from a recipe; see `halfway.people.Impressions`."""

    distances: list[float]
    """In the library's order."""


class PerceivedView(Model):
    """How a material is perceived in one respect; see `halfway.people.Perceived`."""

    name: str
    value: float
    """About 0, not at all, to 1, very."""
    trust: str
    """high, fair or low."""


class PerceptionView(Model):
    """How people would perceive a recipe."""

    perceived: list[PerceivedView]


class Added(Model):
    """A measurement that is a material of the library now."""

    name: str


class AlikeFile(Model):
    """How different people would find each two materials of a static explorer."""

    distances: list[list[float]]


class BlockFile(Model):
    """What a file of numbers holds; see `halfway.server.blocks`."""

    shape: list[int]
    scale: Vector


class Folder(Model):
    """A static explorer: the library, and what its files hold (see `halfway.server.static`)."""

    format: Literal[1] = 1
    library: LibrarySummary
    thumbnails: BlockFile
    environment: BlockFile
    tables: list[BlockFile]
    """In the library's order."""


class ChartView(Model):
    """The simplices between the materials in one chart of a space."""

    simplices: list[list[int]]
    """Their vertices, in the library's order."""
    barycentric: list[list[list[float]]]
    """For each simplex what takes (x, 1) to the weights of its vertices: none is negative where x is inside."""


class ChartsFile(Model):
    """The charts of a space of a static explorer: one for all channels, or one for each."""

    charts: list[ChartView]
