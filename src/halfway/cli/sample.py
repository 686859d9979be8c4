"""``halfway sample``: a set of new materials to train on."""

from pathlib import Path
from typing import Annotated

import typer

from ..locations import DEFAULT_LIBRARY
from . import options
from .console import say, show, show_json, working

SetFolder = Annotated[str, options.output_to("SET", "A folder, or a URL such as s3://....")]
Number = Annotated[int, typer.Option("-n", help="Materials in the set.")]
Seed = Annotated[int, typer.Option(help="The same seed gives the same set.")]
Permute = Annotated[
    bool, typer.Option("--permute-channels", help="Put the colour channels in random orders.")
]
Least = Annotated[
    float,
    typer.Option(
        help="How different any two look at the least: mean CIELAB difference on a lit sphere."
    ),
]
Split = Annotated[
    str, typer.Option(metavar="NAME=SHARE,...", help="Splits, which share no parent materials.")
]
ListFile = Annotated[
    Path | None,
    typer.Option(
        "--list",
        metavar="FILE",
        help="Pairs with the first one's weight, `teflon chrome 0.42`, instead of drawing.",
    ),
]


def sample(
    lib: options.Lib = DEFAULT_LIBRARY,
    output: SetFolder = ...,  # pyright: ignore[reportArgumentType] (required)
    n: Number = 2400,
    seed: Seed = 0,
    format: options.Tables = "none",
    blend: options.Blending = None,
    permute_channels: Permute = False,
    least: Least = 1.0,
    split: Split = "train=80,validation=10,test=10",
    list_file: ListFile = None,
    space: options.Space = "anchored",
    as_json: options.AsJson = False,
    scheduler: options.Scheduler = "",
) -> None:
    """Draw a set of new materials, evenly by what is seen, with a card and splits.

    Writes SET/recipes.json, README.md, croissant.json, and with --format tables. The same command again goes on where it
    stopped; halfway verify SET checks what is there.

    \b
    halfway sample merl.brdflib -n 2400 -o set
    halfway sample merl.brdflib -n 2400 --blend linear --permute-channels --format merl -o set
    halfway sample merl.brdflib --list interpolation_0.txt --format merl -o published
    halfway sample -n 50 --split all=100 --least 3 -o few
    """
    from halfway.library import open_library
    from halfway.locations import to_location
    from halfway.sets import listed, write_set
    from halfway.sets import sample as drawn

    from .arguments import parse_shares

    shares = parse_shares(split)
    library = open_library(lib)
    with working(scheduler) as work:
        if list_file:
            samples = listed(library, list_file, permute_channels=permute_channels, work=work)
        else:
            samples = drawn(
                library,
                n,
                seed=seed,
                space=space,
                blend=blend,
                permute_channels=permute_channels,
                least=least,
                splits=shares,
                work=work,
            )
        folder = to_location(output)
        written = write_set(folder, samples, format=format, work=work)
    if as_json:
        show_json({"format": 1, "n": len(samples), **samples.diversity.to_json()})
    else:
        show(*samples.diversity.lines())
    tables = f", {written.n_written} tables written" if format != "none" else ""
    kept = f", {written.n_kept} kept" if written.n_kept else ""
    say(f"{folder}: {len(samples):,} materials{tables}{kept}. Next: halfway verify {folder}")
