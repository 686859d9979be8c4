"""``halfway plan``: which directions to measure."""

from pathlib import Path
from typing import Annotated

import typer

from ..locations import DEFAULT_LIBRARY
from . import options
from .console import say, show, show_json, work
from .outputs import writing

Output = Annotated[Path | None, options.output_to("FILE", "CSV, whose values are to be filled in.")]
Picture = Annotated[Path | None, typer.Option(metavar="IMAGE", help="Where they are.")]
MaxTheta = Annotated[
    float, typer.Option(min=1, max=90, help="Reach of the instrument, degrees from the normal.")
]
InPlane = Annotated[
    bool, typer.Option("--in-plane", help="Light, viewer and normal stay in one plane.")
]
Given = Annotated[
    Path | None, typer.Option(metavar="MEASUREMENTS", help="What is measured already.")
]


def plan(
    lib: options.Lib = DEFAULT_LIBRARY,
    n: Annotated[int, typer.Option("-n", min=1, max=1000, help="Pairs of directions.")] = 10,
    max_theta: MaxTheta = 80,
    in_plane: InPlane = False,
    given: Given = None,
    output: Output = None,
    picture: Picture = None,
    as_json: options.AsJson = False,
    force: options.Force = False,
) -> None:
    """Say which directions to measure next, of a material that is like those of a library.

    \b
    halfway plan merl.brdflib -n 10 -o plan.csv
    halfway plan merl.brdflib -n 20 --max-theta 75 --in-plane -o plan.csv --picture plan.png
    halfway plan merl.brdflib -n 5 --given paint.csv
    """
    import numpy as np

    from halfway.export import figures, recovered
    from halfway.measurements import Angles, read_measurements, write_directions
    from halfway.recovery import plan as planned

    already = read_measurements(given) if given else None
    directions = planned(lib, n, max_theta=max_theta, in_plane=in_plane, given=already, work=work())
    with writing(output, picture, force=force):
        if output:
            write_directions(output, directions.wi, directions.wo)
        if picture:
            figures.save(picture, recovered.planned(directions))
    angles = np.degrees(np.stack(Angles.of(directions.wi, directions.wo), axis=1))
    if as_json:
        keys = ("theta_i", "phi_i", "theta_o", "phi_o")
        pairs = [dict(zip(keys, row, strict=True)) for row in angles.round(6).tolist()]
        facts = {"format": 1, "unit": "degrees", "pairs": pairs, "left": directions.left.tolist()}
        show_json(facts)
    else:
        say("theta_i  phi_i  theta_o  phi_o (degrees); what is then still unknown (a factor)")
        rows = zip(angles, np.exp(directions.left), strict=True)
        show(*("".join(f"{x:8.1f}" for x in row) + f"  {left:6.2f}" for row, left in rows))
    if output:
        say(
            f"{output}: fill in r, g, b. Next: halfway recover {output} --library {lib} -o new.binary"
        )
