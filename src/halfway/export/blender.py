"""A file for the Blender extension: materials, the ways between them, and all that Blender needs without this package's dependencies.

    NAME.brdfspace            a zip
        space.json            format, library, grid, blend, materials (name, scale, picture, table, the node's inputs), stops, ways
        tables/000.npy        float16, shape (3, *grid): value / scale in 1/sr, NaN where unmeasured
        pictures/000.png      a lit sphere

A way goes from one stop to another in the anchored space: knots of t, and at each the weights of materials by name, linear between.
Materials that are no stops are there where a way passes them.
"""

import io
import json
import zipfile
from collections.abc import Sequence
from dataclasses import asdict
from functools import partial
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from ..brdf import TabularBrdf, half_scale, tabulate
from ..errors import OutputError
from ..files import replacing
from ..halfdiff import Grid
from ..library import Library
from ..recipes import NamedBrdf
from ..space import Space, make_space
from ..tasks import Work

GRID = Grid.merl(90, 30, 36)
"""Of the tables: .6 MB a material. A finer one of a library's is sampled on it."""
MODEL = "cycles"
SUFFIX = ".brdfspace"
LEAST_WEIGHT = 5e-3
"""What has less at a knot is left out there, and its table with it."""


def write_blender(folder: Path, materials: Sequence[NamedBrdf], work: Work) -> Path:
    """Write a ``.brdfspace`` of some materials of one library into ``folder``; its path.

    Raises
    ------
    OutputError
        When they are not of one library, or are mixes, or depend on phi_h, or the file cannot be written.
    """
    library, stops = _one_library(materials)
    if not library.grid.is_isotropic:
        raise OutputError(
            f"{library.name} depends on phi_h (it is anisotropic): a file for Blender holds tables without it. "
            "Build a library of the means over turns with `halfway library build --grid 90x30x36`."
        )
    space = make_space("anchored", library, work=work)
    pairs = list(combinations(stops, 2))
    ways = list(work.run(partial(_way, space), pairs, label="Ways"))
    names = [*stops, *_passed(ways, set(stops))]
    kept = list(work.run(partial(_kept, library), names, label="Materials"))
    document = {
        "format": 1,
        "library": {"name": library.name, "checksum": library.checksum, **asdict(library.origin)},
        "grid": list(GRID.shape),
        "blend": str(space.blend),
        "model": MODEL,
        "materials": [facts for facts, _, _ in kept],
        "stops": stops,
        "ways": ways,
    }
    path = folder / f"{Path(library.name).name.replace(':', '-') or 'library'}{SUFFIX}"
    with (
        replacing(path) as temporary,
        zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED) as file,
    ):
        file.writestr("space.json", json.dumps(document, indent=1, ensure_ascii=False))
        for i, (_, table, picture) in enumerate(kept):
            file.writestr(f"tables/{i:03}.npy", table)
            file.writestr(f"pictures/{i:03}.png", picture)
    return path


def _one_library(materials: Sequence[NamedBrdf]) -> tuple[Library, list[str]]:
    stops: dict[str, Library] = {}
    for material in materials:
        recipe, library = material.recipe, material.library
        if library is None or recipe is None or recipe.material is None:
            raise OutputError(
                f"{material.label} is no material of a library: expected materials of one library, between which Blender can "
                "go. Blender opens tables by themselves with File, Import."
            )
        stops[recipe.material] = library
    libraries = {library.checksum: library for library in stops.values()}
    if len(libraries) != 1:
        raise OutputError(
            f"the materials are of {len(libraries)} libraries: expected one. Export each by itself."
        )
    return next(iter(libraries.values())), list(stops)


def _way(space: Space, pair: tuple[str, str]) -> dict[str, Any]:
    start, stop = pair
    way = space.leg(space.names.index(start), space.names.index(stop))
    # One recipe for all channels.
    rows = np.where(way.weights[0] > LEAST_WEIGHT, way.weights[0], 0)
    rows /= rows.sum(axis=1, keepdims=True)
    weights = [{space.names[i]: float(row[i]) for i in np.flatnonzero(row)} for row in rows]
    return {"from": start, "to": stop, "knots": way.knots.tolist(), "weights": weights}


def _passed(ways: Sequence[dict[str, Any]], stops: set[str]) -> list[str]:
    used = {name for way in ways for weights in way["weights"] for name in weights}
    return sorted(used - stops)


def _kept(library: Library, name: str) -> tuple[dict[str, Any], bytes, bytes]:
    from ..fit import fit  # what optimises takes a second to load
    from ..look import table_png

    brdf = library.brdf(name)
    table = tabulate(brdf, GRID, name=name)
    scale = half_scale(float(np.nanmax(table.values)))
    values = (table.values / np.float32(scale)).astype(np.float16)
    fitted = fit(brdf, MODEL, name=name)
    facts = {"name": name, "scale": scale, "fit": fitted.to_json()}
    return facts, _npy(values), table_png(TabularBrdf(table.values, GRID, name=name))


def _npy(array: np.ndarray) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, array)
    return buffer.getvalue()
