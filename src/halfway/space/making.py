"""From a space's name to the space."""

from ..components import Pca
from ..errors import SpaceError
from ..library import Library
from ..look import Looks, body_colours
from ..tasks import HERE, Work
from .anchored import DETOUR, AnchoredSpace
from .spaces import LinearSpace, PaperSpace, Space

SPACES = ("anchored", "paper", "linear")


def anchored_space(
    library: Library,
    *,
    n_components: int = 3,
    detour: float = DETOUR,
    work: Work = HERE,
) -> AnchoredSpace:
    """The anchored space, fitted to ``library``."""
    return AnchoredSpace.fit(
        library,
        Pca.fit(library, work=work),
        Looks.fit(library, work=work),
        body_colours(library, work=work),
        n_components=n_components,
        detour=detour,
    )


def make_space(
    name: str,
    library: Library,
    *,
    n_components: int = 3,
    detour: float = DETOUR,
    work: Work = HERE,
) -> Space:
    """The space called ``name``, fitted to ``library``.

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
                work=work,
            )
        case "linear":
            return LinearSpace(library.name, library.names)
        case "paper":
            pca = Pca.fit(library, work=work)
            return PaperSpace.fit(library, pca, n_components=n_components)
        case _:
            raise SpaceError(f"there is no space {name!r}: expected one of {', '.join(SPACES)}.")
