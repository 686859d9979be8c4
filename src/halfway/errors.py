"""What can go wrong, as one tree.

    HalfwayError
    |- FormatError       a file is not what its format says
    |- LibraryError      a library cannot be built, opened or asked for this
    |- RecipeError       weights that are no recipe
    |- SpaceError        a space cannot be made, or a place in it not be reached
    |  `- OutsideHullError   the place is not between the materials
    |- ControlError      an attribute is none, or is asked for as it cannot be
    |  `- OutOfReachError    no mix has what is asked for
    |- RenderError       a picture cannot be made here
    |- FetchError        a data set cannot be downloaded, or is not what it should be
    |- RemoteError       storage on another machine cannot be read or written
    |- ClusterError      a cluster cannot be reached, is not fit for this, or was lost
    |- MissingExtraError an optional package is not installed
    `- OutputError       a result cannot be written

Every message is one line: which thing, what is wrong with numbers, what was expected, what to do.
"""

import unicodedata


def shown(text: str) -> str:
    r"""Text from elsewhere on one line, as a terminal shows it: what it would obey becomes an escape such as ``\\x1b``."""
    return "".join(
        c if c.isprintable() or unicodedata.category(c) == "Zs" else repr(c)[1:-1] for c in text
    )


class HalfwayError(Exception):
    """A mistake a user can mend; the message says how."""


class FormatError(HalfwayError):
    """A file is not what its format says."""


class LibraryError(HalfwayError):
    """A library cannot be built or opened, or has no such material."""


class RecipeError(HalfwayError):
    """Weights that are no recipe: negative, not summing to 1, or of unknown materials."""


class SpaceError(HalfwayError):
    """A space cannot be made of these materials, or a place in it cannot be reached."""


class OutsideHullError(SpaceError):
    """A point of a space that is no mix of its materials."""


class ControlError(HalfwayError):
    """An attribute that there is none of, or is asked for as it cannot be."""


class OutOfReachError(ControlError):
    """Attributes that no mix of a library has; the message says which, and how far it goes."""


class RenderError(HalfwayError):
    """A picture cannot be made: no usable renderer, an unknown scene, an unreadable mesh."""


class FetchError(HalfwayError):
    """A data set cannot be downloaded, or what came is not what was expected."""


class RemoteError(HalfwayError):
    """Storage on another machine cannot be reached, or refuses what it is asked for."""


class ClusterError(HalfwayError):
    """A cluster cannot be reached, its workers are not fit for this, or too many of them died."""


class MissingExtraError(HalfwayError):
    """A package that only some uses need is not installed; the message says how to get it."""

    def __init__(self, what: str, package: str, extra: str) -> None:
        super().__init__(
            f"{what} needs the package {package}, which is not installed: expected the extra {extra!r}. "
            f"Install it with `pip install {package}`."
        )


class OutputError(HalfwayError):
    """A result cannot be written: no room, no permission, or a file is in the way."""


class DegenerateSpaceWarning(UserWarning):
    """Materials coincide or lie in fewer dimensions than asked for; the space has fewer, and works."""
