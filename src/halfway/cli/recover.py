"""``halfway recover``: a whole material from a few measured directions."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from ..locations import DEFAULT_LIBRARY
from . import options
from .completion import complete_library
from .console import say, show, show_json, work
from .outputs import writing

if TYPE_CHECKING:
    from ..brdf import TabularBrdf
    from ..recipes import NamedBrdf, Recipe
    from ..recovery import Recovery


MeasurementFile = Annotated[
    Path,
    typer.Argument(
        metavar="MEASUREMENTS", help="CSV with named columns, BRDF JSON, or ASTM E1392."
    ),
]
From = Annotated[
    str,
    typer.Option(
        "--library",
        metavar="LIB",
        help="Of materials like it, the more the better.",
        autocompletion=complete_library,
    ),
]
As = Annotated[
    Literal["mix", "completion"],
    typer.Option("--as", help="mix: sound, a recipe too; completion: nearer, and promises no law."),
]
Apart = Annotated[
    Literal["apart", "together"],
    typer.Option(help="Each channel by itself, or one weight for a material's three."),
]
Repair = Annotated[bool, typer.Option("--repair", help="Make a completion physically sound.")]
Output = Annotated[Path | None, options.output_to("FILE", "A material; or a recipe, .json.")]
Picture = Annotated[
    Path | None, typer.Option(metavar="IMAGE", help="Both answers, and where they are unsure.")
]
Level = Annotated[
    float, typer.Option(min=0.01, max=0.99, help="Share of cells that an interval shall hold.")
]


def recover(
    measurements: MeasurementFile,
    library: From = DEFAULT_LIBRARY,
    output: Output = None,
    answer: As = "mix",
    repair: Repair = False,
    blend: options.Blending = None,
    channels: Apart = "apart",
    picture: Picture = None,
    level: Level = 0.9,
    as_json: options.AsJson = False,
    force: options.Force = False,
) -> None:
    """Make a whole material of a few measured directions, and say how sure it is.

    \b
    halfway recover paint.csv --library merl.brdflib -o paint.binary
    halfway recover paint.csv --library merl.brdflib --as completion --repair -o paint.binary
    halfway recover paint.csv -o paint.json --picture sure.png
    """
    from halfway.export import figures, recovered, write_material, write_recipe
    from halfway.measurements import read_measurements
    from halfway.recipes import Blend, NamedBrdf, mix
    from halfway.recovery import recover as recover_material

    from .arguments import ArgumentError

    wants_recipe = output is not None and output.suffix == ".json"
    if wants_recipe and answer == "completion":
        raise ArgumentError(
            f"-o {output} is a recipe, and a completion has none: expected --as mix, or a material such as .binary."
        )
    given = read_measurements(measurements)
    recovery = recover_material(library, given, channels=channels, work=work())
    recipe = recovery.mix(Blend(blend or Blend.LINEAR))
    opened = recovery.setup.library
    tables = {"mix": mix(opened, recipe)}
    material = NamedBrdf.mixed(opened, recipe, given.name)
    with writing(output, picture, force=force):
        if answer == "completion" or picture:
            completion = recovery.completion(level, work=work())
            tables["completion"] = completion.table
            if picture:
                figures.save(picture, recovered.recovered(recovery, completion, tables["mix"]))
            if answer == "completion":
                material = _material(completion.table, repair)
        if output and wants_recipe:
            write_recipe(output, opened, recipe)
        elif output:
            write_material(output, material)
    _report(recovery, recipe, tables, as_json)
    if output:
        say(f"{output}: {material.label}. Next: halfway render {output} -o new.png")


def _material(completion: "TabularBrdf", repair: bool) -> "NamedBrdf":
    """A completed table as it is, or made sound."""
    from halfway.brdf import repair as repaired
    from halfway.recipes import NamedBrdf

    sound = repaired(completion) if repair else None
    say(*(sound.changes if sound else ()))
    table = sound.table if sound else completion
    return NamedBrdf(table.name, lambda: table, {"name": table.name}, table.name)


def _report(
    recovery: "Recovery", recipe: "Recipe", tables: dict[str, "TabularBrdf"], as_json: bool
) -> None:
    """The weights of the mix, and what each answer misses at the measured directions."""
    import numpy as np

    missed = {name: _missed(recovery, table) for name, table in tables.items()}
    setup = recovery.setup
    n, n_used, regression = len(recovery.measurements), len(setup.used), setup.regression
    if as_json:
        facts = {"format": 1, "n": n, "n_used": n_used, "eta": regression.eta}
        facts |= {"width": regression.width if np.isfinite(regression.width) else None}
        facts |= {"leave_one_out": setup.best_error, "missed": missed, **recipe.to_json()}
        show_json(facts)
        return
    means = zip(recipe.weights.mean(axis=0), recipe.names, strict=True)
    show(*(f"{weight:.6f}  {name}" for weight, name in means))
    if n_used < n:
        say(f"{n - n_used} of {n} pairs are where the library is unmeasured: they do not count")
    for name, error in missed.items():
        say(f"{name}: {error:.1%} off at the measured directions (root mean square, log-relative)")


def _missed(recovery: "Recovery", brdf: "TabularBrdf") -> float:
    import numpy as np

    return float(np.sqrt(np.nanmean(recovery.residuals(brdf) ** 2)))
