"""``halfway export``: materials with a scene, ready for another renderer."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from .console import say, work
from .options import Force, Library, What, output_to

Renderer = Literal["mitsuba", "pbrt-v2", "pbrt-v4", "usd", "blender"]


def export(
    words: What,
    renderer: Annotated[Renderer, typer.Option("--for", help="Who shall render it.")],
    output: Annotated[Path, output_to("DIR", "The folder to fill.")],
    library: Library = "",
    force: Force = False,
) -> None:
    """Write materials for another renderer: a folder with the material, a scene and a page, to be run as it is.

    Several materials get a folder each, below DIR; usd has all of them in one layer, fitted,
    and blender in one file for its extension, with the ways between them.

    \b
    halfway export gold-paint --for mitsuba -o gold
    halfway export builtin:merl-abc:teflon --for pbrt-v4 -o teflon
    halfway export recipes.json --for pbrt-v2 -o frames
    halfway export builtin:merl-abc --for usd -o materials
    halfway export cherry-235 teflon chrome --for blender -o space
    """
    from halfway.batch import filling
    from halfway.export import write_scenes
    from halfway.recipes import open_materials

    materials = open_materials(words, library=library)
    with filling(output, "export", force=force) as folder:
        written = write_scenes(folder, materials, renderer, work=work())
    own = [output / scene.folder.relative_to(folder) for scene in written]
    for scene, there in zip(written, own, strict=True):
        say(f"{there}: {', '.join(path.name for path in scene.files)}")
    say(f"Next: cd {own[0]} && {written[0].command}")
