"""Pictures of many materials: one file with all of them, an animation, or a folder with a file for each.

Materials come in rows. With direct light the pictures of mixes are mixed from those of their ingredients (`basis`),
where that takes fewer renders.
"""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TypeVar

import numpy as np

from ..recipes import Blend, NamedBrdf, file_names
from ..tasks import HERE, Work
from . import pictures
from .basis import BasisPictures
from .frames import Frame, Written, write_frames
from .renderer import Renderer

T = TypeVar("T")
Rows = Sequence[Sequence[NamedBrdf]]


def in_rows(groups: Sequence[Sequence[T]]) -> list[list[T]]:
    """Groups of several that have one length as rows, such as routes; anything else as one row."""
    if len(groups[0]) > 1 and len({len(group) for group in groups}) == 1:
        return [list(group) for group in groups]
    return [[item for group in groups for item in group]]


def write_pictures(
    path: Path,
    renderer: Renderer,
    rows: Rows,
    *,
    labels: Sequence[str] = (),
    most: int | None = None,
    suffix: str = ".png",
    fps: float = 12,
    exposure: float = 0.0,
    work: Work = HERE,
) -> str:
    """Write pictures of materials, and say what was written.

    Parameters
    ----------
    path : path
        A picture of all; an animation, where its suffix is one's and there are several; without a suffix a folder with a
        file of each, in which what an earlier run made of the same is kept.
    labels : sequence of str
        What each of several rows is.
    most : int, optional
        Materials of a row in one picture, evenly chosen; None makes a sheet about as wide as high.
    suffix : str
        Of the files in a folder.

    Raises
    ------
    OutputError
        When the suffix is of no known kind, the exposure shows nothing, or the files cannot be written.
    """
    pictures.require_exposure(exposure)
    if not path.suffix:
        materials = _flat(rows)
        done = _write_folder(path, renderer, materials, suffix, exposure, work)
        text = _counted(done.n_written, "picture")
        kept = f", {done.n_kept:,} kept" if done.n_kept else ""
    elif path.suffix.lower() in pictures.ANIMATED and len(_flat(rows)) > 1:
        n_frames = _write_animation(path, renderer, rows, labels, fps, exposure, work)
        text, kept = _counted(n_frames, "frame"), ""
    else:
        n_images = _write_sheet(path, renderer, rows, labels, most, exposure, work)
        text, kept = _counted(n_images, "picture"), ""
    return f"{text} of the {renderer.scene.name} scene{kept}"


def _write_folder(
    folder: Path,
    renderer: Renderer,
    materials: Sequence[NamedBrdf],
    suffix: str,
    exposure: float,
    work: Work,
) -> Written:
    """Write a picture of each material, called as it is; those that an earlier run made are kept."""
    picture = _pictures(renderer, materials, work)
    frames = [
        Frame(name, material.of, partial(picture, material))
        for name, material in zip(file_names(materials, suffix), materials, strict=True)
    ]
    return write_frames(folder, renderer, frames, exposure=exposure, work=work)


def _write_animation(
    path: Path,
    renderer: Renderer,
    rows: Rows,
    labels: Sequence[str],
    fps: float,
    exposure: float,
    work: Work,
) -> int:
    """Write an animation whose frames show a material of each row, side by side under ``labels``; gives their number."""
    picture = _pictures(renderer, _flat(rows), work)
    columns = list(zip(*rows, strict=True))

    def frame(column: Sequence[NamedBrdf]) -> np.ndarray:
        images = list(map(picture, column))
        one = len(images) == 1
        return images[0] if one else pictures.strip(images, labels=labels, exposure=exposure)

    frames = map(frame, work.track(columns, "Frames", len(columns)))
    pictures.animate(path, frames, fps=fps, exposure=exposure)
    return len(columns)


def _write_sheet(
    path: Path,
    renderer: Renderer,
    rows: Rows,
    labels: Sequence[str],
    most: int | None,
    exposure: float,
    work: Work,
) -> int:
    """Write one picture of all materials; gives how many it is made of.

    They dress a scene together where it takes so many. Else each has a picture of its own: rows of at most ``most``,
    evenly chosen, or, without ``most``, a sheet about as wide as high.
    """
    rows = [_spread(row, most) if most else row for row in rows]
    materials = _flat(rows)
    if len(materials) > 1 and len(materials) == renderer.scene.n_materials:
        images = [renderer.picture([material.table() for material in materials])]
    else:
        picture = _pictures(renderer, materials, work)
        images = list(map(picture, work.track(materials, "Pictures", len(materials))))
    if len(images) == 1:
        pictures.write(path, images[0], exposure=exposure)
    else:
        columns = len(rows[0]) if most or len(rows) > 1 else None
        titles = _titles(rows, labels)
        tiles = pictures.sheet(images, labels=titles, columns=columns, exposure=exposure)
        pictures.write(path, tiles)
    return len(images)


def _pictures(
    renderer: Renderer, materials: Sequence[NamedBrdf], work: Work
) -> Callable[[NamedBrdf], np.ndarray]:
    """What gives the picture of one of ``materials``; mixes of few materials from the pictures of those."""
    libraries = {id(material.library): material.library for material in materials}
    names = {name for material in materials if material.recipe for name in material.recipe.names}
    (library, *others) = libraries.values()
    pictures_mix = renderer.linear and all(
        material.recipe and material.recipe.blend is Blend.LINEAR for material in materials
    )
    if library is None or others or not pictures_mix or len(names) > len(materials):
        return lambda material: renderer.picture(material.table())
    basis = BasisPictures(renderer, library.brdf, work=work)

    def picture(material: NamedBrdf) -> np.ndarray:
        assert material.recipe is not None  # a material of a library has one
        return basis.picture(material.recipe)

    return picture


def _spread(row: Sequence[NamedBrdf], n: int) -> list[NamedBrdf]:
    """About ``n`` of the row, evenly spread, both ends among them."""
    if len(row) <= n:
        return list(row)
    return [row[round(i * (len(row) - 1) / max(1, n - 1))] for i in range(n)]


def _titles(rows: Rows, labels: Sequence[str]) -> list[str]:
    if len(rows) == 1:
        return [material.label for material in rows[0]]
    pairs = zip(labels, rows, strict=True)
    return [f"{label}, {material.label}" for label, row in pairs for material in row]


def _flat(rows: Rows) -> list[NamedBrdf]:
    return [material for row in rows for material in row]


def _counted(n: int, what: str) -> str:
    return f"{n:,} {what}" if n == 1 else f"{n:,} {what}s"
