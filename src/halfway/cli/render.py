"""``halfway render``: pictures of materials."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from .console import say, track


class Layout(StrEnum):
    strip = "strip"
    sheet = "sheet"


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
            "--output", "-o", metavar="IMAGE", help=".png or .exr; .webp, .gif or .mp4 to animate."
        ),
    ],
    scene: Annotated[str, typer.Option(help="teapot, spheres, sphere or trio.")] = "teapot",
    env: Annotated[
        Path | None, typer.Option(help="Environment (.hdr, .exr) in place of the studio.")
    ] = None,
    mesh: Annotated[
        Path | None, typer.Option(help="Mesh (.ply, .obj) in place of the object.")
    ] = None,
    size: Annotated[int, typer.Option(help="Pixels along a side of one picture.")] = 384,
    spp: Annotated[int, typer.Option(help="Samples per pixel.")] = 64,
    n: Annotated[
        int, typer.Option("-n", help="Pictures of a longer route in a strip or sheet.")
    ] = 8,
    layout: Annotated[Layout, typer.Option(help="How several pictures lie in one.")] = Layout.strip,
    exposure: Annotated[float, typer.Option(help="In stops.")] = 0.0,
    seed: Annotated[int, typer.Option(help="The same seed gives the same picture.")] = 0,
    fps: Annotated[int, typer.Option(help="Frames per second of an animation.")] = 12,
) -> None:
    """Render materials in Mitsuba 3.

    \b
    halfway render gold-paint teflon -o two.png
    halfway render fabric -o fabric.webp --scene spheres
    halfway render new.binary -o new.png --size 1024 --spp 256
    """
    from halfway.render import Renderer, pictures

    from .materials import spread, to_materials

    materials = to_materials(words)
    animated = output.suffix in pictures.ANIMATED and len(materials) > 1
    chosen = materials if animated else spread(materials, n)
    renderer = Renderer(scene, size=(size, size), spp=spp, seed=seed, env=env, mesh=mesh)
    images = [
        renderer.picture(material.table()) for material in track(chosen, "Pictures", len(chosen))
    ]
    labels = [material.label for material in chosen]
    if animated:
        pictures.animate(output, images, fps=fps, exposure=exposure)
    elif len(images) == 1:
        pictures.write(output, images[0], exposure=exposure)
    else:
        arrange = pictures.strip if layout is Layout.strip else pictures.sheet
        pictures.write(output, arrange(images, labels=labels), exposure=exposure)
    say(f"{output}: {len(images)} {'frames' if animated else 'pictures'} of the {scene} scene")
