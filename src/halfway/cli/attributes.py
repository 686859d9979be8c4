"""``halfway attributes``: numbers that people use of materials."""

import json
from collections.abc import Mapping
from typing import Any

from .console import show, track
from .options import AsJson, Library, What


def attributes(words: What, as_json: AsJson = False, library: Library = "") -> None:
    """Say what instruments would read off materials: gloss, haze, albedo, colour.

    \b
    halfway attributes gold.binary
    halfway attributes builtin:merl-abc > attributes.txt
    halfway attributes "gold-paint=0.7, teflon=0.3" --json
    """
    from halfway.instruments import of_table
    from halfway.recipes import open_materials

    materials = open_materials(words, library=library)
    tables = (material.table() for material in materials)
    read = [of_table(table) for table in track(tables, "Attributes", len(materials))]
    labels = [material.label for material in materials]
    if as_json:
        named = zip(labels, read, strict=True)
        documents = [{"format": 1, "name": n, "attributes": to_json(each)} for n, each in named]
        print(json.dumps(documents, indent=1))
    elif len(read) == 1:
        show(*lines(read[0]))
    else:
        show("  ".join([f"{name:>10}" for name in read[0]]) + "  material")
        show(*(f"{_row(each)}  {label}" for label, each in zip(labels, read, strict=True)))


def lines(values: Mapping[str, Any]) -> list[str]:
    """The attributes of one material, a line each."""
    from halfway.instruments import ATTRIBUTES

    named = ((ATTRIBUTES[name], value) for name, value in values.items())
    return [f"{a.name:16}{a.written(value):>10} {a.unit:8}{a.label}" for a, value in named]


def to_json(values: Mapping[str, Any]) -> dict[str, Any]:
    """The attributes of one material: numbers, null where there is none, and colours as text."""
    from halfway.instruments import ATTRIBUTES

    return {name: ATTRIBUTES[name].to_json(value) for name, value in values.items()}


def _row(values: Mapping[str, Any]) -> str:
    from halfway.instruments import ATTRIBUTES

    numbers = (ATTRIBUTES[name].written(value) for name, value in values.items())
    return "  ".join(f"{n:>{max(10, len(name))}}" for n, name in zip(numbers, values, strict=True))
