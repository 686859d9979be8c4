"""From a space's name to the space."""

from pathlib import Path

from ..errors import SpaceError
from ..library import Library, Pca
from ..tasks import Track, silent
from .spaces import LinearSpace, PaperSpace, Space

SPACES = ("paper", "linear")


def make_space(
    name: str,
    library: Library,
    *,
    n_components: int = 3,
    cache: Path | None = None,
    track: Track = silent,
) -> Space:
    """The space called ``name``, fitted to ``library``; ``cache`` keeps what is dear to fit.

    Raises
    ------
    SpaceError
        When there is no such space.
    """
    match name:
        case "linear":
            return LinearSpace(library.name, library.names)
        case "paper":
            pca = Pca.fit(library, cache=cache, track=track)
            return PaperSpace.fit(library, pca, n_components=n_components)
        case _:
            raise SpaceError(f"there is no space {name!r}: expected one of {', '.join(SPACES)}.")
