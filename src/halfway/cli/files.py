"""``halfway convert``, ``halfway info``, ``halfway diff`` and ``halfway fetch``: files in, files out."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from . import options
from .attributes import to_json
from .completion import complete_names
from .console import say, show, show_json, work
from .outputs import writing

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import numpy as np

    from ..recipes import NamedBrdf

Material = Annotated[
    str,
    typer.Argument(
        metavar="WHAT", help="A file, LIB:NAME, a name, a recipe.", autocompletion=complete_names
    ),
]


Suffix = Literal["binary", "bsdf", "zarr", "mtlx", "gltf", "glb"]


def convert(
    source: Annotated[
        str,
        typer.Argument(
            metavar="IN",
            help="What is one material, or many: a folder, a library.",
            autocompletion=complete_names,
        ),
    ],
    target: Annotated[
        Path | None,
        typer.Argument(
            metavar="[OUT]",
            help=".binary (MERL), .bsdf (RGL) or .zarr; .mtlx, .gltf, .glb: a fitted model; no suffix: a folder.",
        ),
    ] = None,
    output: Annotated[Path | None, options.output_to("OUT", "The same as OUT.")] = None,
    format: Annotated[Suffix, typer.Option(help="Of the files in a folder.")] = "binary",
    grid: options.GridText = "",
    spectral: options.Spectral = False,
    scale: options.Scale = 1.0,
    library: options.Library = "",
    force: options.Force = False,
) -> None:
    """Write a material in another format; or those of a folder, an archive, a library, a route, into a folder.

    \b
    halfway convert gold.binary gold.bsdf
    halfway convert builtin:merl-abc:teflon teflon.bsdf --spectral
    halfway convert gold.binary gold.mtlx                               an analytic fit: see halfway fit
    halfway convert builtin:merl-abc tables --grid 30x30x60
    halfway convert fabric.bin fabric.zarr --grid 64x90x24x20 --scale .3183
    """
    from halfway.batch import filling
    from halfway.export import recipe_beside, write_material, write_materials
    from halfway.recipes import open_materials

    from .arguments import ArgumentError, parse_grid

    out = output or target
    if out is None or (output and target):
        raise ArgumentError("convert takes IN and OUT: expected one file or folder to write.")
    cells = parse_grid(grid)
    materials = [each.scaled(scale) for each in open_materials([source], library=library)]
    if not out.suffix:
        with filling(out, "convert", force=force) as folder:
            suffix = f".{format}"
            write_materials(folder, materials, suffix, grid=cells, spectral=spectral, work=work())
        say(f"{out}: {len(materials)} {format} files")
        return
    if len(materials) > 1:
        raise ArgumentError(
            f"{source} is {len(materials)} materials: name one of them, or a folder to write."
        )
    with writing(out, recipe_beside(out, materials[0]), force=force):
        say(f"{out}: {write_material(out, materials[0], grid=cells, spectral=spectral)}")


def info(source: Material, as_json: options.AsJson = False, library: options.Library = "") -> None:
    """Say what a file is: format, grid, source, colour; and of one material its gloss, haze, albedo and colour.

    \b
    halfway info gold.binary
    halfway info builtin:merl-abc:teflon

    \b
    Of a measurement that depends on phi_h, `halfway attributes` has the gloss and the colour: that takes its table.
    """
    from halfway.brdf import TabularBrdf
    from halfway.instruments import described, of_table
    from halfway.recipes import open_materials

    materials = open_materials([source], library=library)
    if len(materials) > 1:
        _show_facts(materials, {}, as_json=as_json)
        return
    # One that is mixed is mixed once.
    brdf = materials[0].load()
    material = materials[0]._replace(load=lambda: brdf)
    if not (brdf.is_isotropic or isinstance(brdf, TabularBrdf)):
        # Its table takes ten times as long as all else: `halfway attributes` makes it.
        _show_facts([material], {}, as_json=as_json)
        return
    values = of_table(material.table())
    _show_facts([material], {"attributes": to_json(values)}, as_json=as_json)
    if not as_json:
        show(*described(values))


def _show_facts(
    materials: "Sequence[NamedBrdf]", more: "Mapping[str, Any]", *, as_json: bool
) -> None:
    """What materials are: a line each, or as JSON with more."""
    if as_json:
        documents = [{"format": 1, **material.facts(), **more} for material in materials]
        show_json(documents)
        return
    for material in materials:
        facts = material.facts()
        albedo = facts["albedo_20_degrees"]
        colour = " ".join(f"{value:.3f}" for value in albedo)
        origin = f", {facts['description']}" if facts["description"] else ""
        show(
            f"{material.label}: {facts['is']}{origin}, albedo at 20 degrees {colour}",
            end=_swatch(albedo),
        )


def diff(
    a: Material,
    b: Material,
    metric: Annotated[
        str | None,
        typer.Option(help="One of cosine, cube-root, log, log-relative, relative. [default: all]"),
    ] = None,
    grid: options.GridText = "",
    as_json: options.AsJson = False,
    library: options.Library = "",
) -> None:
    """Say how different two materials are: in each metric, below and beyond 80 degrees, and on a lit sphere.

    B is taken on the grid of A, the reference.

    \b
    halfway diff gold.binary gold.bsdf
    halfway diff cherry-235 tungsten-carbide --metric log
    """
    from halfway.brdf import difference, lit_sphere, metrics, quality
    from halfway.recipes import open_materials

    from .arguments import ArgumentError, parse_grid

    materials = open_materials([a, b], library=library)
    if len(materials) != 2:
        raise ArgumentError(f"{a} and {b} are {len(materials)} materials: name two.")
    first = materials[0].table(parse_grid(grid))
    second = materials[1].table(first.grid)
    names = [metric] if metric else metrics.METRICS
    differences = {name: difference(first, second, name)._asdict() for name in names}
    sphere = quality(lit_sphere(second), lit_sphere(first))
    if as_json:
        seen = {"psnr": sphere.psnr, "relative_l1": sphere.relative_l1}
        show_json({"format": 1, "lit_sphere": seen, **differences})
        return
    print(f"{'':14}{'to 80 degrees':>14}{'beyond':>10}")
    for name, apart in differences.items():
        print(f"{name:14}{apart['below']:14.5f}{apart['grazing']:10.5f}")
    print(f"on a lit sphere {sphere.psnr:.1f} dB, {sphere.relative_l1:.2%} mean error")


def fetch(
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="nbrdf-merl, merl, rgl:MATERIAL or rgl:all.")
    ],
    output: Annotated[Path, options.output_to("DIR", "The folder to fill.")] = Path(),
) -> None:
    """Download a published set of materials: resumed, verified, with its licence beside it.

    \b
    halfway fetch nbrdf-merl -o data
    halfway fetch rgl:cc_green_malachite -o data
    """
    from halfway.fetch import dataset
    from halfway.fetch import fetch as fetched

    wanted = dataset(name)
    say(f"{name}: {wanted.source}. Licence: {wanted.licence}.")
    done = fetched(name, output, progress=_progress if sys.stderr.isatty() else None)
    for path in done.files:
        say(f"{path}")
    say(f"Licence and source: {done.licence}")


def _progress(file: str, n_done: int, n_expected: int | None) -> None:
    share = f"{n_done / n_expected:5.1%}" if n_expected else f"{n_done / 1e6:.1f} MB"
    end = "\n" if n_done == n_expected else ""
    print(f"\r{file}  {share}", end=end, file=sys.stderr, flush=True)


def _swatch(albedo: "np.ndarray") -> str:
    """Two cells of the material's colour, where stdout is a terminal; and the line's end."""
    if not sys.stdout.isatty():
        return "\n"
    import numpy as np

    from halfway.colour import to_srgb

    r, g, b = np.round(255 * to_srgb(np.asarray(albedo))).astype(int)
    return f" \x1b[48;2;{r};{g};{b}m    \x1b[0m\n"
