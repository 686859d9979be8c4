"""Options that several commands take, or whose help is long: types of their parameters."""

import re
from pathlib import Path
from typing import Annotated, Any, Literal

import typer

from .completion import complete_library, complete_names

Scheduler = Annotated[
    str,
    typer.Option(
        metavar="ADDRESS",
        help="Of a Dask cluster that does the work, such as tcp://host:8786. [default: threads here]",
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="For programs.")]
Lib = Annotated[str, typer.Argument(metavar="[LIB]", autocompletion=complete_library)]
What = Annotated[
    list[str],
    typer.Argument(
        metavar="WHAT...",
        help="Files, folders of them, LIB:NAME, names, recipes, recipe files, routes, whole libraries.",
        autocompletion=complete_names,
    ),
]
Library = Annotated[
    str,
    typer.Option(
        "--library",
        metavar="LIB",
        help="Where recipes and names are from, instead of what they say.",
    ),
]
GridText = Annotated[
    str,
    typer.Option(
        "--grid",
        metavar="AxBxC",
        help="Cells in theta_h, theta_d, phi_d, or AxPxBxC with phi_h. [default: a table's own; 90x90x180]",
    ),
]
Spectral = Annotated[
    bool, typer.Option(help="A .bsdf with spectra, for pbrt-v4 and spectral Mitsuba.")
]
Scale = Annotated[
    float, typer.Option(help="Multiply the values: some files do not say their unit.")
]
Force = Annotated[bool, typer.Option("--force", help="Replace what others wrote, or changed.")]


def output_to(metavar: str, text: str) -> Any:
    """The option ``-o``: what is written there."""
    return typer.Option("--output", "-o", metavar=metavar, help=text)


def parse_size(text: str) -> tuple[int, int]:
    """The pixels written as ``384`` or ``640x480``."""
    from .arguments import ArgumentError

    sides = text.split("x")
    if not all(side.isdecimal() for side in sides) or len(sides) > 2:
        raise ArgumentError(f"--size {text!r} is no size: expected pixels, such as 384 or 640x480.")
    return int(sides[0]), int(sides[-1])


def _refuse_url(path: Path) -> Path:
    """A path, which would be a folder called ``s3:`` where a URL is meant."""
    if re.match(r"\w{2,}:/", str(path)):
        from .arguments import ArgumentError

        raise ArgumentError(
            f"-o {path} is a URL: expected a path of this machine, where pictures are written. Copy them there afterwards."
        )
    return path


# halfway route

Stops = Annotated[
    list[str],
    typer.Argument(
        metavar="[LIB] A B [C...]",
        help="Two or more materials, by name, or recipes in files.",
        autocompletion=complete_names,
    ),
]
Steps = Annotated[int, typer.Option("-n", help="Materials on the route, both ends included.")]
Ts = Annotated[
    str, typer.Option("--t", metavar="LIST", help="t instead of -n: 0,0.25,1 or 0.0001:1:0.0001.")
]
Space = Annotated[
    Literal["anchored", "paper", "linear"],
    typer.Option(
        help="anchored: straight in colour, through real materials; paper: the paper's; linear: the ends alone."
    ),
]
Pacing = Annotated[
    Literal["perceptual", "people", "uniform"],
    typer.Option(
        "--pace",
        help="perceptual: equal visible steps; people: steps that they call equal; uniform: the paper's.",
    ),
]
Detour = Annotated[
    float,
    typer.Option(help="Longest anchored way, as a multiple of the direct one; 1 is nearly linear."),
]
Components = Annotated[
    int | None,
    typer.Option(
        "-k",
        help="Scores that span the space; the paper's takes 1 to 6. [default: 4 anchored, 3 the paper's]",
    ),
]
Along = Annotated[
    str,
    typer.Option(
        metavar="NAME=FROM:TO",
        help="From one material along an attribute, such as gloss60=5:80, instead of to others; no space, pace, detour or -k then.",
    ),
]
Blending = Annotated[
    Literal["linear", "root", "log", "lobes"] | None,
    typer.Option(
        "--blend",
        help="lobes: one highlight that narrows; linear: the paper's; root, log: means of square roots, of logarithms. "
        "[default: what a recipe's file says; lobes in the anchored space; else linear]",
    ),
]
RouteFolder = Annotated[
    str | None, output_to("DIR", "A folder, or a URL such as s3://.... [default: A-to-B]")
]
Tables = Annotated[
    Literal["none", "merl", "bsdf", "zarr"],
    typer.Option(
        "--format",
        help="Tables to write beside recipes.json: merl and bsdf, a file each; zarr, half precision in one store.",
    ),
]
RouteJson = Annotated[
    bool, typer.Option("--json", help="Print recipes.json; write files only with -o.")
]

# halfway render

Image = Annotated[
    Path,
    typer.Option(
        "--output",
        "-o",
        metavar="IMAGE",
        callback=_refuse_url,
        help=".png or .exr; .webp, .gif, .mp4 to animate; no suffix: a folder, a picture of each material.",
    ),
]
SceneName = Annotated[str, typer.Option(help="teapot, spheres, sphere, trio or brushed.")]
Environment = Annotated[
    Path | None,
    typer.Option(
        "--env", help="Environment (.hdr, .exr, or `studio`) in place of the scene's light."
    ),
]
ShowEnv = Annotated[
    bool,
    typer.Option("--show-env", help="Show the environment behind the objects, not the ground."),
]
Turntable = Annotated[
    int,
    typer.Option(metavar="N", min=0, help="N pictures of each material, once around the objects."),
]
Turn = Annotated[
    float, typer.Option(metavar="DEGREES", help="Turn anisotropic materials about the normal.")
]
Mesh = Annotated[Path | None, typer.Option(help="Mesh (.ply, .obj) in place of the object.")]
Size = Annotated[str, typer.Option(metavar="PIXELS", help="Of one picture: 384, or 640x480.")]
Quality = Annotated[
    Literal["preview", "normal", "final"],
    typer.Option(help="preview: 16 samples; normal: 64; final: 256."),
]
Spp = Annotated[int | None, typer.Option(help="Samples per pixel, instead of the quality's.")]
Denoise = Annotated[
    bool | None,
    typer.Option(help="Take the noise out, which is the default where the denoiser is installed."),
]
Bounces = Annotated[int | None, typer.Option(help="Of light between surfaces; 1 is direct light.")]
InStrip = Annotated[int, typer.Option("-n", help="Pictures of a longer route in a strip.")]
Layout = Annotated[Literal["strip", "sheet"], typer.Option(help="How several pictures lie in one.")]
Exposure = Annotated[float, typer.Option(help="In stops.")]
Device = Annotated[
    Literal["auto", "cpu", "gpu"],
    typer.Option(help="auto: an NVIDIA GPU where there is one that works, else the CPU."),
]
Seed = Annotated[int, typer.Option(help="The same seed gives the same picture.")]
Fps = Annotated[int, typer.Option(help="Frames per second of an animation.")]
Pictures = Annotated[
    Literal["png", "exr", "webp", "jpg"],
    typer.Option("--format", help="Of the pictures in a folder."),
]
