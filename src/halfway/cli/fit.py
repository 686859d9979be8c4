"""``halfway fit``: an analytic model in place of a table, for programs without a node for measured materials."""

import json
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from .console import say, track
from .options import AsJson


class Model(StrEnum):
    openpbr = "openpbr"
    principled = "principled"
    gltf = "gltf"


def fit(
    words: Annotated[
        list[str],
        typer.Argument(
            metavar="WHAT...",
            help="Files, LIB:NAME, names, recipes, recipe files, whole libraries.",
        ),
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", metavar="FILE", help=".mtlx, .gltf, .glb or .json; of one material."
        ),
    ] = None,
    model: Annotated[
        Model | None,
        typer.Option(help="[default: what the file holds: openpbr in .mtlx, gltf in .gltf]"),
    ] = None,
    picture: Annotated[
        Path | None,
        typer.Option(
            metavar="IMAGE", help="The table, the fit and the difference; of one material."
        ),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Fit an analytic model to a material, and say how far off it is.

    \b
    halfway fit gold-paint -o gold.mtlx                       OpenPBR in MaterialX: USD, Houdini, Maya, Arnold
    halfway fit gold-paint -o gold.glb                        glTF: Blender, the web
    halfway fit new.binary --model principled --picture fit.png
    halfway fit builtin:merl-abc                              the errors of a hundred fits
    """
    from halfway.export import model_of, write_fit
    from halfway.fit import DEFAULT_MODEL
    from halfway.fit import fit as fitted

    from .arguments import ArgumentError
    from .materials import to_materials

    default = model_of(output) if output else DEFAULT_MODEL
    materials = to_materials(words)
    if (output or picture) and len(materials) != 1:
        raise ArgumentError(
            f"{len(materials)} materials are given: -o and --picture take one. Name one of them."
        )
    fits = [
        fitted(material.load(), model or default, name=material.label)
        for material in track(materials, "Fits", len(materials))
    ]
    if as_json:
        print(json.dumps([found.to_json() for found in fits], indent=1))
    else:
        for found in fits:
            print(f"{found.name}, {found.summary}")
    if output:
        write_fit(output, fits[0])
        say(f"{output}: {fits[0].name}")
    if picture:
        from halfway.render import fit_sheet, pictures

        pictures.write(picture, fit_sheet(materials[0].table(), fits[0]))
        say(f"{picture}: the table, the fit, the difference; below, in Mitsuba")
