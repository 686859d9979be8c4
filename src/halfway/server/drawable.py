"""What the page can draw."""

from shlex import quote

from ..errors import LibraryError
from ..library import Library


def require_drawable(library: Library) -> None:
    """Refuse a library whose tables have an axis of phi_h, which the page does not draw.

    Raises
    ------
    LibraryError
        Says what to do.
    """
    if not library.grid.is_isotropic:
        means = f"halfway library build {quote(library.address)} --grid 90x30x36 -o means.brdflib"
        raise LibraryError(
            f"{library.name} depends on phi_h (it is anisotropic): the explorer draws tables without phi_h only. "
            f"Build a library of the means over turns with `{means}`, or use `halfway render`."
        )
