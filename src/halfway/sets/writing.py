"""A set as a folder.

SET/
    recipes.json        every sample with its name, split and recipe; how they were drawn
    README.md           the card: what they are, how different, whose, and what one may do with them
    croissant.json      the same for machines
    train/0000-...      with a format: tables, by split; or tables.zarr in the order of recipes.json
    manifest.json       what each file is made of, and its checksum
"""

import json

from ..batch import Written
from ..export import write_tables
from ..locations import Location
from ..recipes import file_stem
from ..tasks import HERE, Work
from .card import card
from .croissant import croissant
from .sets import SampleSet


def write_set(
    folder: Location, samples: SampleSet, *, format: str = "none", work: Work = HERE
) -> Written:
    """Write a set; with ``format`` (``merl``, ``bsdf``, ``zarr``) a table of each sample. The same again goes on.

    Raises
    ------
    OutputError
        As `halfway.export.write_tables`.
    """
    document = samples.to_json()
    recipes = json.dumps(document)
    texts = {
        "recipes.json": recipes,
        "README.md": card(folder.name, samples, format),
        "croissant.json": json.dumps(croissant(folder.name, samples, recipes, format), indent=1),
    }
    return write_tables(
        folder,
        [each.recipe for each in samples.samples],
        samples.library,
        by="sample",
        format=format,
        of=document["recipes"],
        texts=texts,
        stems=[f"{file_stem(each.split)}/{file_stem(each.name)}" for each in samples.samples],
        work=work,
    )
