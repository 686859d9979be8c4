"""Pictures of many materials: one file with all of them, an animation, or a folder with a file for each.

Materials come in rows. With direct light the pictures of mixes are mixed from those of their ingredients (`basis`),
where that takes fewer renders. On a turntable the row of a material is its pictures from all sides.
"""

from collections.abc import Callable, Sequence
from functools import lru_cache, partial
from pathlib import Path
from typing import TypeVar

import numpy as np

from ..brdf import TabularBrdf
from ..recipes import NamedBrdf, file_names
from ..tasks import HERE, Work
from . import pictures
from .basis import BasisPictures
from .frames import Frame, write_frames
from .renderer import Renderer

T = TypeVar("T")
Rows = Sequence[Sequence[NamedBrdf]]
Shots = Sequence[Sequence[Frame]]


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
    n_turns: int = 0,
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
    n_turns : int
        Pictures of each material on a turntable, once around; 0: one, as the scene has it.

    Raises
    ------
    OutputError
        When the suffix is of no known kind, the exposure shows nothing, or the files cannot be written.
    """
    pictures.require_exposure(exposure)
    materials = [material for row in rows for material in row]
    is_animated = path.suffix.lower() in pictures.ANIMATED and max(n_turns, len(materials)) > 1
    is_sheet = path.suffix and not is_animated
    shown = [_spread(row, most) for row in rows] if is_sheet and most else rows
    if n_turns:
        shots = _turntable(renderer, materials, n_turns, suffix)
        labels = [material.label for material in materials]
    elif is_sheet and _is_dressed_by(outfit := [m for row in shown for m in row], renderer):
        shots = [[_together(renderer, outfit)]]
    else:
        shots = _each(renderer, shown, suffix, work)
    kept = ""
    if not path.suffix:
        frames = [frame for row in shots for frame in row]
        done = write_frames(path, renderer, frames, exposure=exposure, work=work)
        text = _counted(done.n_written, "picture")
        kept = f", {done.n_kept:,} kept" if done.n_kept else ""
    elif is_animated:
        text = _counted(_write_animation(path, shots, labels, fps, exposure, work), "frame")
    else:
        in_strip = most is not None
        text = _counted(_write_sheet(path, shots, labels, in_strip, exposure, work), "picture")
    return f"{text} of the {renderer.scene.name} scene{kept}"


def _each(renderer: Renderer, rows: Rows, suffix: str, work: Work) -> list[list[Frame]]:
    """A picture of each material, called as it is."""
    materials = [material for row in rows for material in row]
    picture = _pictures(renderer, materials, work)
    names = iter(file_names(materials, suffix))
    return [
        [
            Frame(next(names), material.of, partial(picture, material), material.label)
            for material in row
        ]
        for row in rows
    ]


def _is_dressed_by(materials: Sequence[NamedBrdf], renderer: Renderer) -> bool:
    """Whether the scene takes just so many, and not the same for all."""
    return 1 < len(materials) == renderer.scene.n_materials


def _together(renderer: Renderer, materials: Sequence[NamedBrdf]) -> Frame:
    """One picture of all materials, which dress the scene together."""
    return Frame(
        "together",
        [material.of for material in materials],
        lambda: renderer.picture([material.table() for material in materials]),
    )


def _turntable(
    renderer: Renderer, materials: Sequence[NamedBrdf], n: int, suffix: str
) -> list[list[Frame]]:
    """A row of ``n`` pictures of each material, or of all that dress the scene together, once around."""
    outfits = [materials] if _is_dressed_by(materials, renderer) else [[m] for m in materials]
    turned = lru_cache(maxsize=1)(renderer.turned)

    @lru_cache(maxsize=8)
    def tables(i: int) -> list[TabularBrdf]:
        return [material.table() for material in outfits[i]]

    def picture(i: int, degrees: float) -> np.ndarray:
        return turned(degrees).picture(tables(i))

    def frame(i: int, name: str, turn: int) -> Frame:
        degrees = 360 * turn / n
        of = {"materials": [material.of for material in outfits[i]], "turned_degrees": degrees}
        file = f"{name}-{turn:03d}{suffix}"
        return Frame(file, of, partial(picture, i, degrees), f"{degrees:.0f}°")

    names = file_names([outfit[0] for outfit in outfits], "")
    return [[frame(i, name, turn) for turn in range(n)] for i, name in enumerate(names)]


def _write_animation(
    path: Path, rows: Shots, labels: Sequence[str], fps: float, exposure: float, work: Work
) -> int:
    """Write an animation whose frames show one of each row, side by side under ``labels``; gives their number."""
    columns = list(zip(*rows, strict=True))

    def frame(column: Sequence[Frame]) -> np.ndarray:
        images = [shot.picture() for shot in column]
        one = len(images) == 1
        return images[0] if one else pictures.strip(images, labels=labels, exposure=exposure)

    frames = map(frame, work.track(columns, "Frames", len(columns)))
    pictures.animate(path, frames, fps=fps, exposure=exposure)
    return len(columns)


def _write_sheet(
    path: Path, rows: Shots, labels: Sequence[str], in_strip: bool, exposure: float, work: Work
) -> int:
    """Write one picture of all, row by row, or, of one row, as a sheet about as wide as high; gives how many it is made of."""
    shots = [shot for row in rows for shot in row]
    if len(shots) > 1:
        pictures.require_8_bit(path)
    images = [shot.picture() for shot in work.track(shots, "Pictures", len(shots))]
    if len(images) == 1:
        pictures.write(path, images[0], exposure=exposure)
    else:
        columns = len(rows[0]) if in_strip or len(rows) > 1 else None
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
        material.recipe and material.recipe.pictures_mix for material in materials
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


def _titles(rows: Shots, labels: Sequence[str]) -> list[str]:
    if len(rows) == 1:
        return [shot.label for shot in rows[0]]
    pairs = zip(labels, rows, strict=True)
    return [f"{label}, {shot.label}" for label, row in pairs for shot in row]


def _counted(n: int, what: str) -> str:
    return f"{n:,} {what}" if n == 1 else f"{n:,} {what}s"
