"""From a space's name to the space."""

from pathlib import Path

from ..components import Pca
from ..errors import SpaceError
from ..library import Library
from ..look import Looks, body_colours
from ..tasks import THREADS, Engine, Track, silent
from .anchored import DETOUR, AnchoredSpace
from .spaces import LinearSpace, PaperSpace, Space

SPACES = ("anchored", "paper", "linear")


def anchored_space(
    library: Library,
    *,
    n_components: int = 3,
    detour: float = DETOUR,
    cache: Path | None = None,
    track: Track = silent,
    engine: Engine = THREADS,
) -> AnchoredSpace:
    """The anchored space, fitted to ``library``; ``cache`` keeps what is dear to fit."""
    return AnchoredSpace.fit(
        library,
        Pca.fit(library, cache=cache, track=track, engine=engine),
        Looks.fit(library, cache=cache, track=track, engine=engine),
        body_colours(library, cache=cache, track=track, engine=engine),
        n_components=n_components,
        detour=detour,
    )


def make_space(
    name: str,
    library: Library,
    *,
    n_components: int = 3,
    detour: float = DETOUR,
    cache: Path | None = None,
    track: Track = silent,
    engine: Engine = THREADS,
) -> Space:
    """The space called ``name``, fitted to ``library``; ``cache`` keeps what is dear to fit.

    Raises
    ------
    SpaceError
        When there is no such space.
    """
    match name:
        case "anchored":
            return anchored_space(
                library,
                n_components=n_components,
                detour=detour,
                cache=cache,
                track=track,
                engine=engine,
            )
        case "linear":
            return LinearSpace(library.name, library.names)
        case "paper":
            pca = Pca.fit(library, cache=cache, track=track, engine=engine)
            return PaperSpace.fit(library, pca, n_components=n_components)
        case _:
            raise SpaceError(f"there is no space {name!r}: expected one of {', '.join(SPACES)}.")
