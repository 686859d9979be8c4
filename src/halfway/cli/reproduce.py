"""``halfway reproduce``: the paper's tables and figures on a library, as a page."""

from pathlib import Path
from typing import Annotated

import typer

from ..locations import DEFAULT_LIBRARY
from .console import say, work
from .options import Force, Lib, output_to


def reproduce(
    lib: Lib = DEFAULT_LIBRARY,
    output: Annotated[Path, output_to("DIR", "The folder to write.")] = Path("paper"),
    size: Annotated[int, typer.Option(help="Width of one picture, in pixels.")] = 320,
    spp: Annotated[int, typer.Option(help="Samples per pixel.")] = 64,
    env: Annotated[
        Path | None, typer.Option(help="Environment (.hdr, .exr) in place of the studio.")
    ] = None,
    mesh: Annotated[
        Path | None,
        typer.Option(help="Mesh (.ply, .obj) in place of the three objects of Figure 8."),
    ] = None,
    force: Force = False,
) -> None:
    """Make every table and figure of the paper on a library, on one page beside the paper's numbers.

    \b
    halfway reproduce merl_nbrdf.zip
    halfway reproduce merl.brdflib -o paper --env galileo.exr --mesh dragon.ply
    """
    from halfway.batch import filling
    from halfway.library import open_library
    from halfway.paper import reproduce as reproduced

    library = open_library(lib)
    say(f"Library {library.name}: {library.origin.description}.")
    with filling(output, "reproduce", force=force) as folder:
        reproduced(folder, library, size=size, spp=spp, env=env, mesh=mesh, work=work())
    say(f"{output}: page.html (and page.md), its pictures, and paper.json with every number")
