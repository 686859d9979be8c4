"""``halfway check``: whether tables are physically sound."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import HalfwayError
from .console import say, show, show_json, work
from .options import AsJson, Force, Library, What, output_to
from .outputs import writing

if TYPE_CHECKING:
    from ..brdf import ValidityCard
    from ..recipes import NamedBrdf

BROKEN, UNREADABLE = 1, 3
"""Exit codes; 2 is that of a command that cannot be understood."""


def check(
    words: What,
    as_json: AsJson = False,
    repair: Annotated[
        bool, typer.Option("--repair", help="Write the nearest sound table to -o.")
    ] = False,
    output: Annotated[Path | None, output_to("FILE", "With --repair.")] = None,
    library: Library = "",
    force: Force = False,
) -> None:
    """Print the validity card of BRDFs; exit 1 when a law is broken, 3 when a file cannot be read.

    What is no table (neural, RGL) is checked as the table that a library takes of it.

    \b
    halfway check route/025.binary
    halfway check builtin:merl-abc
    halfway check damaged.binary --repair -o sound.binary
    """
    from halfway.recipes import open_materials

    materials = open_materials(words, library=library)
    if repair:
        _repair(materials, output, force)
        return
    names = words if len(words) == len(materials) else [material.label for material in materials]
    results = work().run(_card, materials, label="Checking")
    cards = list(zip(names, results, strict=True))
    if as_json:
        show_json([_as_json(*card) for card in cards])
    else:
        show(*(_as_line(*card) for card in cards))
    n_unread = sum(isinstance(card, HalfwayError) for _, card in cards)
    n_broken = sum(not isinstance(card, HalfwayError) and not card.ok for _, card in cards)
    if n_broken or n_unread:
        unread = f", {n_unread} cannot be read" if n_unread else ""
        say(f"{n_broken} of {len(cards)} break a law{unread}")
        raise typer.Exit(BROKEN if n_broken else UNREADABLE)


def _card(material: "NamedBrdf") -> "ValidityCard | HalfwayError":
    from halfway.brdf import check as card_of

    try:
        return card_of(material.table())
    except HalfwayError as error:
        return error


def _repair(materials: "list[NamedBrdf]", output: Path | None, force: bool) -> None:
    """Write the nearest sound table, and say what was changed."""
    from halfway.brdf import repair as repaired
    from halfway.formats import write_brdf

    from .arguments import ArgumentError

    if output is None or len(materials) != 1:
        raise ArgumentError("--repair takes one FILE and the file to write, with -o.")
    with writing(output, force=force):
        sound = repaired(materials[0].table())
        write_brdf(output, sound.table)
    for change in sound.changes or ("Nothing was wrong.",):
        say(change)


def _as_json(file: str, card: "ValidityCard | HalfwayError") -> dict[str, object]:
    facts = {"error": str(card)} if isinstance(card, HalfwayError) else card.as_json()
    return {"format": 1, "file": file, **facts}


def _as_line(file: str, card: "ValidityCard | HalfwayError") -> str:
    if isinstance(card, HalfwayError):
        return f"UNREAD  {file}: {card}"
    return f"{'sound ' if card.ok else 'BROKEN'}  {file}: {card.summary}"
