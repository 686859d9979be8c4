"""``halfway check``: whether tables are physically sound."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .console import say, track

if TYPE_CHECKING:
    from ..brdf import ValidityCard
    from .materials import Material


def check(
    words: Annotated[
        list[str],
        typer.Argument(
            metavar="FILE...", help="Files, LIB:NAME, recipes, routes, whole libraries."
        ),
    ],
    as_json: Annotated[bool, typer.Option("--json", help="For programs.")] = False,
    repair: Annotated[
        bool, typer.Option("--repair", help="Write the nearest sound table to -o.")
    ] = False,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FILE", help="With --repair.")
    ] = None,
) -> None:
    """Print the validity card of BRDFs; exit 1 when a law is broken.

    What is no table (neural, RGL) is checked as the table that a library takes of it.

    \b
    halfway check route/025.binary
    halfway check builtin:merl-abc
    halfway check damaged.binary --repair -o sound.binary
    """
    from halfway.brdf import check as card_of
    from halfway.brdf import repair as repaired
    from halfway.formats import write_brdf

    from .arguments import ArgumentError
    from .materials import to_materials

    materials = to_materials(words)
    if repair:
        if output is None or len(materials) != 1:
            raise ArgumentError("--repair takes one FILE and the file to write, with -o.")
        sound = repaired(materials[0].table())
        write_brdf(output, sound.table)
        for change in sound.changes or ("Nothing was wrong.",):
            say(change)
        return
    cards = [
        (word, card_of(material.table()))
        for word, material in zip(
            _sources(words, materials), track(materials, "Checking", len(materials)), strict=True
        )
    ]
    if as_json:
        print(
            json.dumps(
                [{"format": 1, "file": file, **card.as_json()} for file, card in cards], indent=1
            )
        )
    else:
        for file, card in cards:
            print(f"{'sound ' if card.ok else 'BROKEN'}  {file}: {_line(card)}")
    n_broken = sum(not card.ok for _, card in cards)
    if n_broken:
        say(f"{n_broken} of {len(cards)} break a law")
        raise typer.Exit(1)


def _sources(words: list[str], materials: list["Material"]) -> list[str]:
    return words if len(words) == len(materials) else [material.label for material in materials]


def _line(card: "ValidityCard") -> str:
    if card.broken:
        return "; ".join(card.broken)
    width = card.highlight_width_degrees
    peak = "" if width is None else f", highlight {width:.2g} degrees wide"
    return (
        f"reflects at most {card.max_albedo:.3f} (grazing {card.max_albedo_grazing:.3f}), "
        f"{card.unmeasured:.1%} unmeasured, dynamic range {card.dynamic_range:.3g}{peak}"
    )
