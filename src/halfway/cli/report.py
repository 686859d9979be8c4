"""``halfway report``: the paper's table and figures, for any library."""

import json
from pathlib import Path
from typing import Annotated

import typer

from .console import cache_folder, say, track


def report(
    lib: Annotated[str, typer.Argument(metavar="[LIB]")] = "builtin:merl-abc",
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="DIR", help="The folder to write.")
    ] = Path("report"),
    as_json: Annotated[bool, typer.Option("--json", help="Print report.json.")] = False,
) -> None:
    """Principal components of a library: Table I, eigenvalues, triangulation.

    \b
    halfway report merl.brdflib -o report
    """
    from halfway.export import write_report
    from halfway.library import Pca, open_library

    library = open_library(lib)
    pca = Pca.fit(library, cache=cache_folder(), track=track)
    found = write_report(output, library, pca)
    if as_json:
        print(json.dumps(found.to_json(), indent=1))
    else:
        print(f"{library.name}: {len(library)} materials, {library.origin.description}")
        print(
            "components  mean relative error  uncentred  total    unexplained variance  rms error (1/sr)"
        )
        for row in found.table_1:
            print(
                f"{row.n_components:10d}  {row.mean_relative_error:19.4f}  {row.mean_relative_error_uncentred:9.4f}  "
                f"{row.total_relative_error:7.4f}  {row.unexplained_variance:20.2e}  {row.rms_error:16.4g}"
            )
    say(f"{output}: report.json, eigenvalues and triangulation (png, svg)")
