"""The card of a set: its README.md."""

from collections import Counter

from .sets import SampleSet

TABLES = {
    "none": "Tables are not included: `halfway convert {folder} -o tables` writes them, `halfway mix` one of them.",
    "merl": "`SPLIT/NAME.binary` is its table in the MERL format, f_r in 1/sr.",
    "bsdf": "`SPLIT/NAME.bsdf` is its table for Mitsuba 3 and pbrt-v4 (RGL).",
    "zarr": "`tables.zarr` holds their tables in the order of `recipes.json`, half precision; the attribute `scale` takes them to 1/sr.",
}


def card(folder: str, samples: SampleSet, format: str) -> str:
    """The text, as Markdown."""
    origin, how = samples.library.origin, samples.how
    counts = Counter(each.split for each in samples.samples)
    rows = [
        f"| {split} | {counts[split]:,} | {len(names)} |" for split, names in samples.splits.items()
    ]
    of = f"`{samples.library.name}`: {origin.description or 'no description'}"
    sections = {
        f"# {folder}: {len(samples):,} materials as BRDFs": f"New materials, mixed from those of {of}. None of them is a "
        "measurement.\n\n`recipes.json` has each one's name, split and recipe: the materials and weights that it is mixed of, in "
        f"the blend `{samples.blend}`. {TABLES[format].format(folder=folder)}",
        "## Splits": "| split | materials | mixed from |\n|---|---|---|\n"
        + "\n".join(rows)
        + _sharing(samples),
        "## How they came about": _drawn(samples) if "seed" in how else _from_list(samples),
        "## How different they are": "Mean CIELAB difference on a lit sphere; 2.3 is just noticeable on patches.\n\n"
        + "\n".join(f"- {line}" for line in samples.diversity.lines()),
        "## Whose they are": f"- Source: {origin.source or 'not stated'}\n- Licence of what was mixed: "
        f"{origin.licence or 'not stated'}. A mix is made of others' material: keep to its licence, and name the source.",
    }
    return "\n\n".join(f"{title}\n\n{text}" for title, text in sections.items()) + "\n"


def _sharing(samples: SampleSet) -> str:
    if len(samples.splits) < 2:
        return ""
    return "\n\nNo material of the library has a part in two splits. `splits` in `recipes.json` lists them."


def _drawn(samples: SampleSet) -> str:
    how = samples.how
    permuted = (
        " The colour channels of each were put in a random order."
        if how["permute_channels"]
        else ""
    )
    return (
        f"`halfway sample`, seed {how['seed']}: the materials of each split, as points of the space `{how['space']}`, are cut "
        "into Delaunay simplices; one is drawn with a chance that goes with the volume of its corners' pictures in CIELAB, of its corners "
        f"any number from two, and between those a point evenly.{permuted} What looked less than {how['least']:g} different from another sample, or from a material of the "
        "library, was drawn again."
    )


def _from_list(samples: SampleSet) -> str:
    orders = (
        ", each in all six orders of its colour channels" if samples.how["permute_channels"] else ""
    )
    return f"`halfway sample --list {samples.how['list']}`: the pairs of that list{orders}. Nothing was left out."
