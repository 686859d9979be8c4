"""``halfway convert``, ``halfway info`` and ``halfway fetch``: files in, files out."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .console import say

if TYPE_CHECKING:
    import numpy as np

    from ..brdf import Brdf


def convert(
    source: Annotated[str, typer.Argument(metavar="IN", help="A file, LIB:NAME or a recipe.")],
    output: Annotated[
        Path,
        typer.Argument(
            metavar="OUT", help=".binary (MERL) or .bsdf (RGL); .mtlx, .gltf, .glb: a fitted model."
        ),
    ],
    spectral: Annotated[
        bool, typer.Option(help="A .bsdf with spectra, for pbrt-v4 and spectral Mitsuba.")
    ] = False,
) -> None:
    """Write a material in another format.

    \b
    halfway convert gold.binary gold.bsdf
    halfway convert builtin:merl-abc:teflon teflon.bsdf --spectral
    halfway convert gold.binary gold.mtlx                               an analytic fit: see halfway fit
    """
    from halfway.export import MODEL_OF, write_fit
    from halfway.fit import fit
    from halfway.formats import write_brdf, write_rgl

    from .arguments import ArgumentError
    from .materials import to_materials

    material, *others = to_materials([source])
    if others:
        raise ArgumentError(f"{source} is {1 + len(others)} materials: name one of them.")
    if output.suffix == ".bsdf":
        written = write_rgl(output, material.load(), spectral=spectral, description=material.label)
        n_theta_i, side = written.resolution
        say(
            f"{output}: {n_theta_i} x {side} x {side}, {written.quality.psnr:.1f} dB on a lit sphere, "
            f"{written.quality.relative_l1:.2%} mean error"
        )
    elif output.suffix in MODEL_OF:
        found = fit(material.load(), MODEL_OF[output.suffix], name=material.label)
        write_fit(output, found)
        say(f"{output}: {found.name}, {found.summary}")
    else:
        write_brdf(output, material.table())
        say(f"{output}: {material.label}")


def info(
    source: Annotated[str, typer.Argument(metavar="FILE", help="A file, LIB:NAME or a recipe.")],
) -> None:
    """Say what a file is: format, grid, source, colour.

    \b
    halfway info gold.binary
    halfway info builtin:merl-abc:teflon
    """
    from halfway.brdf import directional_albedo

    from .materials import to_materials

    for material in to_materials([source]):
        brdf = material.load()
        albedo = directional_albedo(brdf, 0.35, n_theta_h=90, n_phi_h=24)
        origin = material.library.origin.description if material.library else ""
        facts = [*_facts(brdf), *filter(None, [origin])]
        print(
            f"{material.label}: {', '.join(facts)}, "
            f"albedo at 20 degrees {albedo[0]:.3f} {albedo[1]:.3f} {albedo[2]:.3f} {_swatch(albedo)}"
        )


def _facts(brdf: "Brdf") -> list[str]:
    """What the file holds, and where its numbers come from."""
    from halfway.brdf import TabularBrdf
    from halfway.formats import NeuralBrdf, RglBrdf

    match brdf:
        case TabularBrdf():
            return [f"a table of {brdf.grid} cells"]
        case RglBrdf():
            kind = "isotropic" if brdf.is_isotropic else f"anisotropic by {brdf.anisotropy:.0%}"
            size = f"{len(brdf.theta_i)} x {len(brdf.phi_i)} directions"
            description = "".join(c for c in brdf.description if c.isprintable()).strip()
            return [f"an RGL material ({kind})", size, brdf.source, *filter(None, [description])]
        case NeuralBrdf():
            return [f"a neural fit ({brdf.formula})"]
        case _:
            return [type(brdf).__name__]


def fetch(
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="nbrdf-merl, merl, rgl:MATERIAL or rgl:all.")
    ],
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="DIR", help="The folder to fill.")
    ] = Path(),
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
    found = fetched(name, output, progress=_progress if sys.stderr.isatty() else None)
    for path in found.files:
        say(f"{path}")
    say(f"Licence and source: {found.licence}")


def _progress(file: str, n_done: int, n_expected: int | None) -> None:
    share = f"{n_done / n_expected:5.1%}" if n_expected else f"{n_done / 1e6:.1f} MB"
    end = "\n" if n_done == n_expected else ""
    print(f"\r{file}  {share}", end=end, file=sys.stderr, flush=True)


def _swatch(albedo: "np.ndarray") -> str:
    """Two cells of the material's colour, where stdout is a terminal."""
    if not sys.stdout.isatty():
        return ""
    from halfway.render.pictures import to_8_bit

    r, g, b = to_8_bit(albedo[None, None])[0, 0]
    return f"\x1b[48;2;{r};{g};{b}m    \x1b[0m"
