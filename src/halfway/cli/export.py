"""``halfway export``: materials with a scene, ready for another renderer."""

import json
import re
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .console import say, track

if TYPE_CHECKING:
    from .materials import Material


class Renderer(StrEnum):
    mitsuba = "mitsuba"
    pbrt_v2 = "pbrt-v2"
    pbrt_v4 = "pbrt-v4"


def export(
    words: Annotated[
        list[str], typer.Argument(metavar="WHAT...", help="Files, LIB:NAME, recipes, routes.")
    ],
    renderer: Annotated[Renderer, typer.Option("--for", help="Who shall render it.")],
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="DIR", help="The folder to fill.")
    ],
) -> None:
    """Write materials for another renderer: a folder with the material, a scene and a page, to be run as it is.

    Several materials get a folder each, below DIR.

    \b
    halfway export gold-paint --for mitsuba -o gold
    halfway export builtin:merl-abc:teflon --for pbrt-v4 -o teflon
    halfway export recipes.json --for pbrt-v2 -o frames
    """
    from halfway.export import write_scene

    from .materials import to_materials

    materials = to_materials(words)
    folders = [output] if len(materials) == 1 else _folders(output, materials)
    pairs = zip(track(materials, "Exporting", len(materials)), folders, strict=True)
    written = [
        write_scene(
            folder, material.load(), renderer, name=material.label, origin=_origin(material)
        )
        for material, folder in pairs
    ]
    for scene in written:
        say(f"{scene.folder}: {', '.join(path.name for path in scene.files)}")
    say(f"Next: cd {written[0].folder} && {written[0].command}")


def _folders(output: Path, materials: list["Material"]) -> list[Path]:
    """A folder for each, called as the material, and numbered where two are called the same."""
    names = [re.sub(r"[^\w.+=-]+", "-", material.label).strip(".-") for material in materials]
    twice = len(set(names)) < len(names)
    return [
        output / (f"{i:03d}-{name}" if twice or not name else name) for i, name in enumerate(names)
    ]


def _origin(material: "Material") -> str:
    """What the page says of a mixed material: of what, and whose numbers those are."""
    if material.library is None or material.recipe is None:
        return ""
    recipe = json.dumps(material.recipe.to_json()["weights"])
    about = material.library.origin
    sentences = (about.description, about.source, f"Licence: {about.licence}" if about.licence else "")  # fmt: skip
    made = f"Made by halfway from `{material.library.name}`: `{recipe}`."
    return "\n".join([made, *(f"{sentence}." for sentence in sentences if sentence)])
