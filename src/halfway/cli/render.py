"""``halfway render``: pictures of materials."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from . import options
from .console import say, track, work
from .options import DeviceName, Layout, PictureFormat, Quality

if TYPE_CHECKING:
    import numpy as np

    from ..render import Renderer
    from .materials import Material


def render(
    words: options.What,
    output: options.Image,
    scene: options.SceneName = "teapot",
    env: options.Environment = None,
    mesh: options.Mesh = None,
    size: options.Size = "384",
    quality: options.RenderQuality = Quality.normal,
    spp: options.Spp = None,
    denoise: options.Denoise = None,
    bounces: options.Bounces = None,
    n: options.InStrip = 8,
    layout: options.Arrangement = Layout.STRIP,
    exposure: options.Exposure = 0.0,
    seed: options.Seed = 0,
    device: options.Device = DeviceName.auto,
    fps: options.Fps = 12,
    format: options.Pictures = PictureFormat.png,
) -> None:
    """Render materials in Mitsuba 3.

    With direct light (teapot, spheres, sphere) a route costs one render per measured material it touches. Routes of one
    length stand below each other, and side by side in an animation. Into a folder, the same command again goes on
    where it stopped.

    \b
    halfway render gold-paint teflon -o two.png
    halfway render fabric -o fabric.webp --scene spheres
    halfway render fabric fabric-paper -o compared.webp
    halfway render fabric -o frames --format exr
    halfway render new.binary -o new.png --size 1024 --quality final
    halfway render teflon chrome gold-paint -o three.png --scene trio
    """
    from halfway.render import QUALITY, Renderer, pictures

    rows = _in_rows(words)
    materials = [material for row in rows for material in row]
    default = QUALITY[quality]
    renderer = Renderer(
        scene,
        size=_size(size),
        spp=default["spp"] if spp is None else spp,
        denoise=bool(default["denoise"]) if denoise is None else denoise,
        seed=seed,
        env=env,
        mesh=mesh,
        bounces=bounces,
        device=device.value,
    )
    if not output.suffix:
        _render_folder(output, renderer, materials, format, exposure)
    elif output.suffix in pictures.ANIMATED and len(materials) > 1:
        _animate(output, renderer, rows, words, fps, exposure)
    else:
        most = None if layout is Layout.SHEET else n
        _render_image(output, renderer, rows, words, most, exposure)


def _in_rows(words: Sequence[str]) -> list[list["Material"]]:
    """The materials of each word where all stand for equally many, such as routes; else all of them in one row."""
    from .materials import to_materials

    rows = [to_materials([word]) for word in words]
    if len(rows[0]) > 1 and len({len(row) for row in rows}) == 1:
        return rows
    return [[material for row in rows for material in row]]


def _render_folder(
    folder: Path,
    renderer: "Renderer",
    materials: Sequence["Material"],
    format: PictureFormat,
    exposure: float,
) -> None:
    from halfway.render import Frame, write_frames

    from .materials import file_names

    paint = _painter(renderer, materials)
    frames = [
        Frame(name, material.of, partial(paint, material))
        for name, material in zip(file_names(materials, f".{format}"), materials, strict=True)
    ]
    written = write_frames(folder, renderer, frames, exposure=exposure, work=work())
    kept = f", {written.n_kept:,} kept" if written.n_kept else ""
    pictures = "picture" if written.n_written == 1 else "pictures"
    say(f"{folder}: {written.n_written:,} {pictures} of the {renderer.scene.name} scene{kept}")


def _animate(
    output: Path,
    renderer: "Renderer",
    rows: Sequence[Sequence["Material"]],
    words: Sequence[str],
    fps: int,
    exposure: float,
) -> None:
    """A frame for each material of a row, beside those of the other rows."""
    from halfway.render import pictures

    paint = _painter(renderer, [material for row in rows for material in row])
    columns = list(zip(*rows, strict=True))
    labels = [Path(word).name for word in words]

    def frame(column: Sequence["Material"]) -> "np.ndarray":
        images = [paint(material) for material in column]
        one = len(images) == 1
        return images[0] if one else pictures.strip(images, labels=labels, exposure=exposure)

    frames = map(frame, track(columns, "Frames", len(columns)))
    pictures.animate(output, frames, fps=fps, exposure=exposure)
    say(f"{output}: {len(columns)} frames of the {renderer.scene.name} scene")


def _render_image(
    output: Path,
    renderer: "Renderer",
    rows: Sequence[Sequence["Material"]],
    words: Sequence[str],
    most: int | None,
    exposure: float,
) -> None:
    """One picture: materials dressed in together where the scene takes so many, else in rows of at most ``most``."""
    from halfway.render import pictures

    from .materials import spread

    rows = [spread(row, most) if most else row for row in rows]
    materials = [material for row in rows for material in row]
    labels = [material.label for material in materials]
    if len(rows) > 1:
        labels = [
            f"{Path(word).name}, {material.label}"
            for word, row in zip(words, rows, strict=True)
            for material in row
        ]
    if len(materials) > 1 and len(materials) == renderer.scene.n_materials:
        images = [renderer.picture([material.table() for material in materials])]
    else:
        paint = _painter(renderer, materials)
        images = list(map(paint, track(materials, "Pictures", len(materials))))
    if len(images) == 1:
        pictures.write(output, images[0], exposure=exposure)
    else:
        columns = len(rows[0]) if most or len(rows) > 1 else None
        tiles = pictures.sheet(images, labels=labels, columns=columns, exposure=exposure)
        pictures.write(output, tiles)
    what = "picture" if len(images) == 1 else "pictures"
    say(f"{output}: {len(images)} {what} of the {renderer.scene.name} scene")


def _painter(
    renderer: "Renderer", materials: Sequence["Material"]
) -> Callable[["Material"], "np.ndarray"]:
    """What makes the picture of one of ``materials``; mixes of few materials from the pictures of those."""
    from halfway.render import BasisPictures

    libraries = {id(material.library): material.library for material in materials}
    names = {name for material in materials if material.recipe for name in material.recipe.names}
    (library, *others) = libraries.values()
    if library is None or others or not renderer.linear or len(names) > len(materials):
        return lambda material: renderer.picture(material.table())
    basis = BasisPictures(renderer, library.brdf, work=work())

    def paint(material: "Material") -> "np.ndarray":
        assert material.recipe is not None  # a material of a library has one
        return basis.picture(material.recipe)

    return paint


def _size(text: str) -> tuple[int, int]:
    from .arguments import ArgumentError

    sides = text.split("x")
    if not all(side.isdecimal() for side in sides) or len(sides) > 2:
        raise ArgumentError(f"--size {text!r} is no size: expected pixels, such as 384 or 640x480.")
    return int(sides[0]), int(sides[-1])
