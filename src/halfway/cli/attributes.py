"""``halfway attributes``: numbers that people use of materials."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .console import say, show, show_json, track, work
from .options import AsJson, Library, What

if TYPE_CHECKING:
    from ..people import Perceived
    from ..recipes import NamedBrdf


def attributes(
    words: What,
    perceived: Annotated[
        bool, typer.Option("--perceived", help="And how people would perceive them.")
    ] = False,
    as_json: AsJson = False,
    library: Library = "",
) -> None:
    """Say what instruments would read off materials: gloss, haze, albedo, colour.

    \b
    halfway attributes gold.binary
    halfway attributes builtin:merl-abc > attributes.txt
    halfway attributes chrome --perceived
    halfway attributes "gold-paint=0.7, teflon=0.3" --json
    """
    from halfway.instruments import described, of_table
    from halfway.recipes import open_materials

    materials = open_materials(words, library=library)
    tables = (material.table() for material in materials)
    read = [of_table(table) for table in track(tables, "Attributes", len(materials))]
    seen = [_perceived(material) if perceived else {} for material in materials]
    labels = [material.label for material in materials]
    if as_json:
        named = zip(labels, read, seen, strict=True)
        show_json([_document(*each) for each in named])
    elif len(read) == 1:
        show(*described(read[0], read[0]))
        show(*perceived_lines(seen[0]))
    else:
        show("  ".join(f"{name:>10}" for name in (*read[0], *seen[0])) + "  material")
        rows = zip(labels, read, seen, strict=True)
        show(*(f"{_row(*each)}  {label}" for label, *each in rows))
        if perceived:
            say("trust: " + ", ".join(f"{name} {p.trust}" for name, p in seen[0].items()))


def _perceived(material: "NamedBrdf") -> "dict[str, Perceived]":
    from halfway.people import Perception

    return Perception.of(material.library, work=work()).perceived(material.load())


def _document(
    label: str, read: Mapping[str, Any], seen: "Mapping[str, Perceived]"
) -> dict[str, Any]:
    return {"format": 1, "name": label, "attributes": to_json(read), **perceived_json(seen)}


def perceived_lines(seen: "Mapping[str, Perceived]") -> list[str]:
    """How people would perceive one material, a line each."""
    return [f"{name:22}{p.value:10.2f}  trust: {p.trust}" for name, p in seen.items()]


def perceived_json(seen: "Mapping[str, Perceived]") -> dict[str, Any]:
    """The same as a part of a document; no part where nobody asked."""
    return {"perceived": {name: p._asdict() for name, p in seen.items()}} if seen else {}


def changes(pairs: Mapping[str, tuple[Any, Any]]) -> str:
    """What attributes were and are."""
    from halfway.instruments import ATTRIBUTES

    named = ((ATTRIBUTES[name], pair) for name, pair in pairs.items())
    return ", ".join(f"{a.name} {a.written(was)} to {a.written(now)}" for a, (was, now) in named)


def to_json(values: Mapping[str, Any]) -> dict[str, Any]:
    """The attributes of one material: numbers, null where there is none, and colours as text."""
    from halfway.instruments import ATTRIBUTES

    return {name: ATTRIBUTES[name].to_json(value) for name, value in values.items()}


def _row(read: Mapping[str, Any], seen: "Mapping[str, Perceived]") -> str:
    from halfway.instruments import ATTRIBUTES

    numbers = {name: ATTRIBUTES[name].written(value) for name, value in read.items()}
    numbers |= {name: f"{p.value:.2f}" for name, p in seen.items()}
    return "  ".join(f"{n:>{max(10, len(name))}}" for name, n in numbers.items())
