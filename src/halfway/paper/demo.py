"""The paper's main run on the built-in library, with pictures: light-brown-fabric to blue-fabric, 51 materials."""

import json
from pathlib import Path

from ..components import Pca
from ..export import write_report
from ..files import write_text
from ..formats import write_brdf
from ..library import Library
from ..recipes import mix
from ..render import BasisPictures, Renderer, pictures
from ..space import route
from ..tasks import HERE, Work

STOPS = ("light-brown-fabric", "blue-fabric")
N_MATERIALS = 51
NEW_MATERIALS = (13, 25, 38)
"""The numbers, of the 51 materials of `demonstrate`, of those that it writes as tables."""
_SIZE, _SPP = (320, 260), 64
_N_IN_STRIP = 7


def demonstrate(folder: Path, library: Library, *, work: Work = HERE) -> None:
    """Write a report, the recipes of a route, three of its tables, a strip of its pictures and an animation."""
    write_report(folder / "report", library, Pca.fit(library, work=work))
    way = route(library, *STOPS, space="paper", pace="uniform", work=work)
    ts = way.steps(N_MATERIALS)
    write_text(folder / "recipes.json", json.dumps(way.to_json(ts)))
    recipes = way.recipes(ts)
    for i in NEW_MATERIALS:
        write_brdf(folder / f"{i:03d}.binary", mix(library, recipes[i]))

    basis = BasisPictures(Renderer("teapot", size=_SIZE, spp=_SPP), library.brdf, work=work)
    basis.render(sorted({name for recipe in recipes for name in recipe.names}))
    images = [basis.picture(recipe) for recipe in recipes]
    shown = [round(i * (N_MATERIALS - 1) / (_N_IN_STRIP - 1)) for i in range(_N_IN_STRIP)]
    strip = pictures.strip([images[i] for i in shown], labels=[f"t = {ts[i]:.2f}" for i in shown])
    pictures.write(folder / "strip.png", strip)
    pictures.animate(folder / "route.webp", images, fps=12.0)
