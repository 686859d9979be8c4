"""A material as a file, in whichever format the suffix names.

.binary             MERL: the table itself
.bsdf               RGL: resampled, for Mitsuba and pbrt-v4
.mtlx, .gltf, .glb  an analytic model, fitted

A MERL file has no room for words. So beside one that holds a mix stands its recipe, NAME.recipe.json, with the source and the
licence of what was mixed; it is read like any recipe.
"""

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from ..brdf import Brdf, TabularBrdf, lit_sphere, quality
from ..errors import OutputError
from ..files import write_text
from ..formats import write_brdf, write_rgl
from ..halfdiff import Grid
from ..library import Library
from ..recipes import NamedBrdf, Recipe, file_names
from ..tasks import HERE, Work
from .fits import MODEL_OF, write_fit

FORMAT = 3
"""Of a recipe's file; 1 had no blend, and was linear, 2 no body scale."""


def write_material(
    path: Path, material: NamedBrdf, *, grid: Grid | None = None, spectral: bool = False
) -> str:
    """Write a material, and say what the file holds and how near to the material that is.

    Parameters
    ----------
    grid : Grid, optional
        Sample it there first; by default a table stays as it is.
    spectral : bool
        Of a ``.bsdf``: with spectra, for pbrt-v4 and spectral Mitsuba.

    Raises
    ------
    OutputError
        When the suffix names no format, the format cannot hold the material, or the file cannot be written.
    """
    suffix = path.suffix.lower()
    if suffix == ".bsdf":
        brdf = material.table(grid) if grid else material.load()
        written = write_rgl(path, brdf, spectral=spectral, description=material.label)
        n_theta_i, side = written.resolution
        return (
            f"{n_theta_i} x {side} x {side}, {written.quality.psnr:.1f} dB on a lit sphere, "
            f"{written.quality.relative_l1:.2%} mean error"
        )
    if suffix in MODEL_OF and suffix != ".json":
        from ..fit import fit  # what optimises takes a second to load

        brdf = material.table(grid) if grid else material.load()
        fitted = fit(brdf, MODEL_OF[suffix], name=material.label)
        write_fit(path, fitted)
        return f"{fitted.name}, {fitted.summary}"
    brdf, table = material.load(), material.table(grid)
    write_brdf(path, table)
    if beside := recipe_beside(path, material):
        assert material.library is not None
        assert material.recipe is not None
        write_recipe(beside, material.library, material.recipe)
    return f"{material.label}, {table.grid} cells{_kept(brdf, table)}"


def _kept(brdf: Brdf, table: TabularBrdf) -> str:
    """How near a table is to an anisotropic material that is none: coarse grids, and those without phi_h, keep less."""
    if isinstance(brdf, TabularBrdf) or brdf.is_isotropic:
        return ""
    likeness = quality(lit_sphere(table), lit_sphere(brdf))
    return f", {likeness.psnr:.1f} dB of its own values on a lit sphere"


def recipe_beside(path: Path, material: NamedBrdf) -> Path | None:
    """The file beside ``path`` that says what was mixed; None where it holds no mix, or says so itself."""
    return (
        path.with_suffix(".recipe.json") if material.recipe and path.suffix == ".binary" else None
    )


def write_recipe(path: Path, library: Library, recipe: Recipe) -> None:
    """Write a recipe as JSON, with which library it is of, and that one's source and licence."""
    document = {
        "format": FORMAT,
        **recipe.to_json(),
        "library_address": library.address,
        "library_checksum": library.checksum,
        **asdict(library.origin),
    }
    write_text(path, json.dumps(document, indent=1, ensure_ascii=False) + "\n")


def write_materials(
    folder: Path,
    materials: Sequence[NamedBrdf],
    suffix: str,
    *,
    grid: Grid | None = None,
    spectral: bool = False,
    work: Work = HERE,
) -> list[Path]:
    """Write a file of each material into a folder, called as it is; see `write_material`.

    Raises
    ------
    OutputError
        As `write_material`.
    """
    if not materials:
        raise OutputError(f"{folder} would hold no materials: expected one or more.")
    paths = [folder / name for name in file_names(materials, suffix)]
    pairs = list(zip(paths, materials, strict=True))
    for path, material in work.track(pairs, "Converting", len(pairs)):
        write_material(path, material, grid=grid, spectral=spectral)
    return paths
