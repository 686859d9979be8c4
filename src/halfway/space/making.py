"""From what a person asks for to spaces and routes."""

from collections.abc import Mapping
from functools import partial

from ..components import Pca
from ..errors import SpaceError
from ..library import Library, open_library
from ..look import Looks
from ..people import Impressions
from ..recipes import Blend, Recipe
from ..tasks import HERE, Work
from .anchored import DETOUR, AnchoredSpace
from .pace import by_people, perceptual
from .routes import Route
from .space import Space
from .spaces import LinearSpace, PaperSpace

SPACES: Mapping[str, type[Space]] = {
    kind.name: kind for kind in (AnchoredSpace, PaperSpace, LinearSpace)
}
"""By name, the default first."""
PACES = ("perceptual", "people", "uniform")
"""How t is spaced on a route: by equal visible steps, by steps that people would call equal, or evenly, as the paper does."""


def make_space(
    name: str,
    library: Library,
    *,
    n_components: int | None = None,
    detour: float = DETOUR,
    blend: Blend | str | None = None,
    looks: Looks | None = None,
    work: Work = HERE,
) -> Space:
    """The space called ``name``, fitted to ``library``.

    Parameters
    ----------
    n_components : int, optional
        Scores that span the space; without it 4 in the anchored space, or as many as few materials span, and 3 in the paper's.
    detour : float
        Longest way of the anchored space, as a multiple of the direct one.
    blend : Blend or str, optional
        How its recipes are mixed; without it ``lobes`` in the anchored space, ``linear`` in the others.
    looks : Looks, optional
        The library's, where they are at hand; the anchored space makes them otherwise.

    Raises
    ------
    SpaceError
        When there is no such space.
    RecipeError
        When there is no such blend.
    """
    mixed = _blend(name, blend)
    match name:
        case "anchored":
            return AnchoredSpace.fit(
                library,
                n_components=n_components,
                detour=detour,
                blend=mixed,
                looks=looks,
                work=work,
            )
        case "paper":
            pca = Pca.fit(library, work=work)
            return PaperSpace.fit(library, pca, n_components=n_components, blend=mixed)
        case _:
            return LinearSpace.of(library, blend=mixed)


def route(
    library: Library | str,
    *stops: str | Recipe,
    space: Space | str = "anchored",
    blend: Blend | str | None = None,
    pace: str = "perceptual",
    n_components: int | None = None,
    detour: float = DETOUR,
    work: Work = HERE,
) -> Route:
    """The route through two or more materials of a library.

    Parameters
    ----------
    library : Library or str
        Open, or as `open_library` takes it.
    stops : str or Recipe
        Names of materials, in turn; or recipes of the library, mixed as the route is, such as `halfway.find` finds.
    space : Space or str
        ``anchored``, straight in body colour and through real materials; ``paper``, the paper's; ``linear``, the ends alone;
        or one that was made.
    pace : str
        ``perceptual``, equal visible steps; ``people``, steps that people would call equal; ``uniform``, the paper's.
    blend, n_components, detour
        As `make_space` takes them.
    work : Work
        Where its tasks run, who sees how far it is, and where dear results are kept.

    Examples
    --------
    >>> import halfway
    >>> route = halfway.route("builtin:merl-abc", "teflon", "chrome", space="linear", pace="uniform")
    >>> route.recipe(0.5)
    Recipe('builtin:merl-abc', {'chrome': 0.5, 'teflon': 0.5})

    Raises
    ------
    SpaceError
        With fewer than two stops, one that follows itself, or no such space or pace.
    LibraryError
        When the library has no material of a name.
    """
    opened = open_library(library)
    if pace not in PACES:
        raise SpaceError(f"there is no pace {pace!r}: expected {', '.join(PACES)}.")
    # A mistake is told before a space is fitted.
    mixed = space.blend if isinstance(space, Space) else _blend(space, blend)
    for stop in stops:
        if isinstance(stop, str):
            opened.index(stop)
    Route.through(LinearSpace.of(opened, blend=mixed), stops)
    looks = Looks.fit(opened, work=work) if pace == "perceptual" else None
    fit = partial(make_space, n_components=n_components, detour=detour, blend=blend, work=work)
    fitted = fit(space, opened, looks=looks) if isinstance(space, str) else space
    way = Route.through(fitted, stops)
    if looks:
        return perceptual(way, looks)
    return by_people(way, Impressions.fit(opened, work=work)) if pace == "people" else way


def _blend(name: str, blend: Blend | str | None) -> Blend:
    """How the recipes of a space are mixed."""
    if name not in SPACES:
        raise SpaceError(f"there is no space {name!r}: expected one of {', '.join(SPACES)}.")
    return Blend(blend or SPACES[name].usual_blend)
