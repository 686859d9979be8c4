"""``halfway check``: whether tables are physically sound."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .console import say, work

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
    from .materials import to_materials

    materials = to_materials(words)
    if repair:
        _repair(materials, output)
        return
    names = words if len(words) == len(materials) else [material.label for material in materials]
    checked = work().run(_card, materials, label="Checking")
    cards = list(zip(names, checked, strict=True))
    print(_as_json(cards) if as_json else _as_lines(cards))
    n_broken = sum(not card.ok for _, card in cards)
    if n_broken:
        say(f"{n_broken} of {len(cards)} break a law")
        raise typer.Exit(1)


def _card(material: "Material") -> "ValidityCard":
    from halfway.brdf import check as card_of

    return card_of(material.table())


def _repair(materials: list["Material"], output: Path | None) -> None:
    """Write the nearest sound table, and say what was changed."""
    from halfway.brdf import repair as repaired
    from halfway.formats import write_brdf

    from .arguments import ArgumentError

    if output is None or len(materials) != 1:
        raise ArgumentError("--repair takes one FILE and the file to write, with -o.")
    sound = repaired(materials[0].table())
    write_brdf(output, sound.table)
    for change in sound.changes or ("Nothing was wrong.",):
        say(change)


def _as_json(cards: "list[tuple[str, ValidityCard]]") -> str:
    return json.dumps(
        [{"format": 1, "file": file, **card.as_json()} for file, card in cards], indent=1
    )


def _as_lines(cards: "list[tuple[str, ValidityCard]]") -> str:
    return "\n".join(
        f"{'sound ' if card.ok else 'BROKEN'}  {file}: {card.summary}" for file, card in cards
    )
