"""A route as a folder: its recipes, and their tables as files.

    DIR/
        recipes.json
        000.binary, ...     and whatever `write_tables` makes of them

A folder holds one route: where recipes.json says the same as before, tables that are there are kept and the rest is written.
Where it says something else, the old route's tables go first.
"""

import json
from collections.abc import Sequence
from dataclasses import replace

from ..batch import Written
from ..library import Library, LibraryRef
from ..locations import Location
from ..space import Route
from ..tasks import HERE, Work
from .tables import write_tables

RECIPES = "recipes.json"


def write_route(
    folder: Location,
    route: Route,
    ts: Sequence[float],
    library: Library,
    *,
    format: str = "none",
    work: Work = HERE,
) -> Written:
    """Write recipes.json, and with ``format`` a table for each t.

    Parameters
    ----------
    format : str
        ``none``; ``merl`` or ``bsdf``, a file for each table; ``zarr``, all in one store.

    Raises
    ------
    OutputError
        As `write_tables`.
    """
    # The library may have moved since the route was made.
    document = replace(route, library=LibraryRef.of(library)).to_json(ts)
    return write_tables(
        folder,
        route.recipes(ts),
        library,
        by="route",
        format=format,
        of=document["recipes"],
        texts={RECIPES: json.dumps(document)},
        work=work,
    )
