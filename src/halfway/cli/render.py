"""``halfway render``: pictures of materials."""

from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .console import cache_folder, say, track

if TYPE_CHECKING:
    import numpy as np

    from ..render import Renderer
    from .materials import Material


class Layout(StrEnum):
    STRIP = "strip"
    SHEET = "sheet"


class Quality(StrEnum):
    preview = "preview"
    normal = "normal"
    final = "final"


def render(
    words: Annotated[
        list[str],
        typer.Argument(
            metavar="WHAT...",
            help="Files, LIB:NAME, names, recipes, recipe files, a route's folder.",
        ),
    ],
    output: Annotated[
        Path,
        typer.Option(
            "--output", "-o", metavar="IMAGE", help=".png or .exr; .webp, .gif, .mp4 to animate."
        ),
    ],
    scene: Annotated[str, typer.Option(help="teapot, spheres, sphere or trio.")] = "teapot",
    env: Annotated[
        Path | None, typer.Option(help="Environment (.hdr, .exr) in place of the studio.")
    ] = None,
    mesh: Annotated[
        Path | None, typer.Option(help="Mesh (.ply, .obj) in place of the object.")
    ] = None,
    size: Annotated[
        str, typer.Option(metavar="PIXELS", help="Of one picture: 384, or 640x480.")
    ] = "384",
    quality: Annotated[
        Quality, typer.Option(help="preview: 16 samples, denoised; normal: 64; final: 256.")
    ] = Quality.normal,
    spp: Annotated[
        int | None, typer.Option(help="Samples per pixel, instead of the quality's.")
    ] = None,
    denoise: Annotated[
        bool | None, typer.Option(help="Take the noise out, or not, instead of the quality's.")
    ] = None,
    bounces: Annotated[
        int | None, typer.Option(help="Of light between surfaces; 1 is direct light.")
    ] = None,
    n: Annotated[int, typer.Option("-n", help="Pictures of a longer route in a strip.")] = 8,
    layout: Annotated[Layout, typer.Option(help="How several pictures lie in one.")] = Layout.STRIP,
    exposure: Annotated[float, typer.Option(help="In stops.")] = 0.0,
    seed: Annotated[int, typer.Option(help="The same seed gives the same picture.")] = 0,
    fps: Annotated[int, typer.Option(help="Frames per second of an animation.")] = 12,
) -> None:
    """Render materials in Mitsuba 3.

    With direct light (teapot, spheres, sphere) a route costs one render per measured material it touches.

    \b
    halfway render gold-paint teflon -o two.png
    halfway render fabric -o fabric.webp --scene spheres
    halfway render new.binary -o new.png --size 1024 --quality final
    halfway render teflon chrome gold-paint -o three.png --scene trio
    """
    from halfway.render import QUALITY, Renderer, pictures

    from .materials import spread, to_materials

    materials = to_materials(words)
    animated = output.suffix in pictures.ANIMATED and len(materials) > 1
    chosen = materials if animated or layout is Layout.SHEET else spread(materials, n)
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
    )
    together = renderer.scene.n_materials > 1 and len(chosen) == renderer.scene.n_materials
    if together:
        images = [renderer.picture([material.table() for material in chosen])]
    else:
        images = _pictures(renderer, chosen)
    labels = [material.label for material in chosen]
    if animated:
        pictures.animate(output, images, fps=fps, exposure=exposure)
    elif len(images) == 1:
        pictures.write(output, images[0], exposure=exposure)
    else:
        arrange = pictures.strip if layout is Layout.STRIP else pictures.sheet
        pictures.write(output, arrange(images, labels=labels, exposure=exposure))
    what = "frames" if animated else "picture" if len(images) == 1 else "pictures"
    say(f"{output}: {len(images)} {what} of the {scene} scene")


def _pictures(renderer: "Renderer", materials: Sequence["Material"]) -> list["np.ndarray"]:
    """One picture of each material; mixes of few materials from the pictures of those."""
    from halfway.render import BasisPictures

    libraries = {id(material.library): material.library for material in materials}
    names = {name for material in materials if material.recipe for name in material.recipe.names}
    (library, *others) = libraries.values()
    if library is None or others or not renderer.linear or len(names) > len(materials):
        return [
            renderer.picture(material.table())
            for material in track(materials, "Pictures", len(materials))
        ]
    basis = BasisPictures(renderer, library.brdf, cache=cache_folder())
    basis.render(sorted(names), track=track)
    recipes = [material.recipe for material in materials if material.recipe]
    return [basis.picture(recipe.names, recipe.weights) for recipe in recipes]


def _size(text: str) -> tuple[int, int]:
    from .arguments import ArgumentError

    sides = text.split("x")
    if not all(side.isdecimal() for side in sides) or len(sides) > 2:
        raise ArgumentError(f"--size {text!r} is no size: expected pixels, such as 384 or 640x480.")
    return int(sides[0]), int(sides[-1])
