"""The explorer of some materials of a library as a folder: those that are named, or those that look most different."""

from collections.abc import Sequence
from pathlib import Path

from ..batch import require_own
from ..library import Library, Subset
from ..look import Looks, most_different
from ..tasks import HERE, Work
from .page import Page
from .static import Exported, export

N_EXPORTED = 8
"""Materials that a folder carries where nobody says how many."""


def export_some(
    library: Library,
    folder: Path,
    names: Sequence[str] = (),
    *,
    n: int | None = None,
    force: bool = False,
    work: Work = HERE,
) -> tuple[Exported, Sequence[str]]:
    """Write the explorer of the materials called ``names``, or else of ``n`` that look most different; gives their names.

    Raises
    ------
    OutputError
        As `export`.
    """
    if not force:
        require_own(folder, "view")  # before anything is computed
    if not names:
        looks = Looks.fit(library, work=work)
        names = most_different(looks, min(N_EXPORTED, len(library)) if n is None else n)
    return export(Subset(library, names), folder, Page.load(), force=force, work=work), names
