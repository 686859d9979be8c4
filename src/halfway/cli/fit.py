"""``halfway fit``: an analytic model in place of a table, for programs without a node for measured materials."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from .console import say, show, show_json, track
from .options import AsJson, Force, Library, What, output_to
from .outputs import writing

Model = Literal["openpbr", "principled", "cycles", "gltf", "gltf-blender", "gltf-core", "preview"]
FittedFile = Annotated[
    Path | None, output_to("FILE", ".mtlx, .gltf, .glb or .json; of one material.")
]
ModelName = Annotated[
    Model | None,
    typer.Option(help="[default: what the file holds: openpbr in .mtlx, gltf in .gltf]"),
]
Picture = Annotated[
    Path | None,
    typer.Option(metavar="IMAGE", help="The table, the fit and the difference; of one material."),
]


def fit(
    words: What,
    output: FittedFile = None,
    model: ModelName = None,
    picture: Picture = None,
    as_json: AsJson = False,
    library: Library = "",
    force: Force = False,
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
    from halfway.recipes import open_materials

    from .arguments import ArgumentError

    kind = model or (model_of(output) if output else DEFAULT_MODEL)
    materials = open_materials(words, library=library)
    if (output or picture) and len(materials) != 1:
        raise ArgumentError(
            f"{len(materials)} materials are given: -o and --picture take one. Name one of them."
        )
    with writing(output, picture, force=force):
        fits = [
            fitted(material.load(), kind, name=material.label)
            for material in track(materials, "Fits", len(materials))
        ]
        if output:
            write_fit(output, fits[0])
        if picture:
            from halfway.render import fit_sheet, pictures

            pictures.write(picture, fit_sheet(materials[0].table(), fits[0]))
    if as_json:
        show_json([fit.to_json() for fit in fits])
    else:
        show(*(f"{fit.name}, {fit.summary}" for fit in fits))
    if output:
        lights = (
            ". In Blender, import it with Lighting Mode: Unitless"
            if kind.startswith("gltf")
            else ""
        )
        say(f"{output}: {fits[0].name}{lights}")
    if picture:
        say(f"{picture}: the table, the fit, the difference; below, in Mitsuba")
