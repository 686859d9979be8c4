"""``halfway demo``: the paper's main run on the built-in library, with pictures."""

from pathlib import Path
from typing import Annotated

from .console import say, work
from .options import Force, output_to


def demo(
    output: Annotated[Path, output_to("DIR", "The folder to write.")] = Path("demo"),
    force: Force = False,
) -> None:
    """Run the paper's main experiment: light-brown-fabric to blue-fabric, 51 materials, with pictures.

    Uses the built-in library, which needs no download: published analytic fits of the MERL materials.
    """
    from halfway.batch import filling
    from halfway.library import DEFAULT_LIBRARY, open_library
    from halfway.paper import NEW_MATERIALS, demonstrate

    library = open_library(DEFAULT_LIBRARY)
    say(f"Library {library.name}: {library.origin.description}.")
    with filling(output, "demo", force=force) as folder:
        demonstrate(folder, library, work=work())
    epilogue = f"""
{output}/
  strip.png          teapots from light-brown-fabric to blue-fabric
  route.webp         the whole way, animated
  recipes.json       what each is mixed from
  {", ".join(f"{i:03d}.binary" for i in NEW_MATERIALS)}   three new materials, MERL files
  report/            eigenvalues and triangulation of the library

Try next:
  halfway view
  halfway render {output}/025.binary -o middle.png --size 768
  halfway route cherry-235 tungsten-carbide -o metal --format merl
  halfway library build FOLDER-OF-MERL-FILES -o mine.brdflib"""
    say(*epilogue.splitlines())
