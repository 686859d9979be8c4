"""``halfway demo``: the paper's main run on the built-in library, with pictures."""

from pathlib import Path
from typing import Annotated

import typer

from .console import say, work

STOPS = ("light-brown-fabric", "blue-fabric")
SIZE = (320, 260)
SPP = 64
N_IN_STRIP = 7
NEW_MATERIALS = (13, 25, 38)
"""Of 51: about a quarter, half and three quarters of the way."""


def demo(
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="DIR", help="The folder to write.")
    ] = Path("demo"),
) -> None:
    """Run the paper's main experiment: light-brown-fabric to blue-fabric, 51 materials, with pictures.

    Uses the built-in library, which needs no download: published analytic fits of the MERL materials.
    """
    import halfway
    from halfway.components import Pca
    from halfway.export import write_report, write_route
    from halfway.formats import write_brdf
    from halfway.library import DEFAULT_LIBRARY, open_library
    from halfway.recipes import Mixer
    from halfway.render import BasisPictures, Renderer, pictures

    library = open_library(DEFAULT_LIBRARY)
    say(f"Library {library.name}: {library.origin.description}.")
    pca = Pca.fit(library, work=work())
    write_report(output / "report", library, pca)
    route = halfway.route(library, *STOPS, space="paper", pace="uniform", work=work())
    ts = route.steps(51)
    write_route(output, route, ts, library, work=work())
    mixer = Mixer(library)
    tables = [mixer.mix(recipe) for recipe in (route.recipe(ts[i]) for i in NEW_MATERIALS)]
    for i, table in zip(NEW_MATERIALS, tables, strict=True):
        write_brdf(output / f"{i:03d}.binary", table)

    renderer = Renderer("teapot", size=SIZE, spp=SPP)
    basis = BasisPictures(renderer, library.brdf, work=work())
    recipes = route.recipes(ts)
    basis.render(sorted({name for recipe in recipes for name in recipe.names}))
    images = [basis.picture(recipe) for recipe in recipes]
    shown = [round(i * 50 / (N_IN_STRIP - 1)) for i in range(N_IN_STRIP)]
    strip = pictures.strip([images[i] for i in shown], labels=[f"t = {ts[i]:.2f}" for i in shown])
    pictures.write(output / "strip.png", strip)
    pictures.animate(output / "route.webp", images, fps=12.0)
    say(f"""
{output}/
  strip.png          teapots from {STOPS[0]} to {STOPS[1]}
  route.webp         all 51, animated
  recipes.json       what each is mixed from
  {", ".join(f"{i:03d}.binary" for i in NEW_MATERIALS)}   three new materials, MERL files
  report/            eigenvalues and triangulation of the library

Try next:
  halfway view
  halfway render {output}/025.binary -o middle.png --size 768
  halfway route cherry-235 tungsten-carbide -o metal --format merl
  halfway library build FOLDER-OF-MERL-FILES -o mine.brdflib""")
