"""``halfway verify``: whether a folder still holds what was written there."""

from typing import Annotated

import typer

from .console import say, show, show_json, work
from .options import AsJson

N_SHOWN = 20
"""Files of a kind that are listed for a person; ``--json`` lists all."""


def verify(
    folder: Annotated[
        str, typer.Argument(metavar="DIR", help="As route or render wrote it, or its URL.")
    ],
    as_json: AsJson = False,
) -> None:
    """Read every file of a folder again and compare it with manifest.json: missing, changed, foreign.

    Exits with 1 when there is any.

    \b
    halfway verify metal
    halfway verify frames --json
    """
    from halfway.batch import verify as verified
    from halfway.locations import to_location

    verdict = verified(to_location(folder), work=work())
    kinds = {"missing": verdict.missing, "changed": verdict.changed, "foreign": verdict.foreign}
    if as_json:
        document = {"format": 1, "folder": folder, "ok": verdict.ok, "right": verdict.n_right}
        show_json(document | kinds)
    else:
        for kind, names in kinds.items():
            for name in names[:N_SHOWN]:
                show(f"{kind}  {name}")
            if len(names) > N_SHOWN:
                show(f"{kind}  ... and {len(names) - N_SHOWN:,} more")
        counts = "".join(f", {len(names):,} {kind}" for kind, names in kinds.items() if names)
        say(f"{folder}: {verdict.n_right:,} files as they were written{counts}")
    if not verdict.ok:
        raise typer.Exit(1)
