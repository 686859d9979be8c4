"""What a person brings and takes home: files of measurements in, files of a mixed table out.

merl, bsdf                       the table itself, as ``halfway mix`` writes it
mtlx, glb                        a fitted model, as ``halfway fit`` writes it, with how far off it is
mitsuba, pbrt-v4, pbrt-v2        a zip of the folder that ``halfway export`` fills
"""

from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple
from zipfile import ZIP_DEFLATED, ZipFile

import numpy as np

from ..brdf import Brdf, TabularBrdf
from ..errors import FormatError, HalfwayError, OutputError
from ..export import model_of, write_fit, write_scene
from ..fit import fit
from ..formats import MerlFile, encode_header, read_brdf, write_brdf
from ..halfdiff import Grid

SUFFIXES = {
    "merl": ".binary",
    "bsdf": ".bsdf",
    "mtlx": ".mtlx",
    "glb": ".glb",
    "mitsuba": "-mitsuba.zip",
    "pbrt-v4": "-pbrt-v4.zip",
    "pbrt-v2": "-pbrt-v2.zip",
}
"""Of the file of each format to take a material home in."""
WITHOUT_PHI_H = {"merl", "pbrt-v2"}
"""Formats that hold no table that depends on phi_h."""


class Taken(NamedTuple):
    """A file in parts, and a line on how well it stands for the table where it is not the table."""

    parts: list[bytes | memoryview]
    summary: str = ""


def offered(grid: Grid) -> list[str]:
    """The formats that hold tables on a grid."""
    return [each for each in SUFFIXES if grid.is_isotropic or each not in WITHOUT_PHI_H]


def written(table: TabularBrdf, format: str, *, origin: str = "") -> Taken:
    """The file of a table in one of the formats; an `OutputError` where there is no such format, or it cannot hold the table."""
    if format not in SUFFIXES:
        raise OutputError(f"{format!r} is no format to export: expected {', '.join(SUFFIXES)}.")
    if format == "merl":
        merl = MerlFile.from_table(table)
        samples = np.ascontiguousarray(merl.samples, "<f8")
        return Taken([encode_header(merl.grid), samples.data.cast("B")])
    with TemporaryDirectory(prefix="halfway-") as folder:
        path = Path(folder) / f"material{SUFFIXES[format]}"
        summary = _WRITERS.get(format, _scene)(path, table, origin)
        return Taken([path.read_bytes()], summary)


def read(name: str, content: bytes) -> Brdf:
    """The BRDF in a file called ``name``; a `FormatError` where it is none, or is damaged."""
    with TemporaryDirectory(prefix="halfway-") as folder:
        path = Path(folder) / name
        path.write_bytes(content)
        try:
            return read_brdf(path)
        except HalfwayError as error:
            raise FormatError(str(error).replace(str(path), name)) from None


def _table(path: Path, table: TabularBrdf, _: str) -> str:
    write_brdf(path, table)
    return ""


def _fit(path: Path, table: TabularBrdf, _: str) -> str:
    fitted = fit(table, model_of(path))
    write_fit(path, fitted)
    return fitted.summary


def _scene(path: Path, table: TabularBrdf, origin: str) -> str:
    renderer = path.stem.removeprefix("material-")
    folder = path.parent / renderer
    scene = write_scene(folder, table, renderer, name="mix", origin=origin)
    with ZipFile(path, "w", ZIP_DEFLATED, compresslevel=1) as archive:
        for file in sorted(folder.rglob("*")):
            archive.write(file, file.relative_to(folder))
    return f"unpack it, and there: {scene.command}"


_WRITERS: dict[str, Callable[[Path, TabularBrdf, str], str]] = {
    "bsdf": _table,
    "mtlx": _fit,
    "glb": _fit,
}
