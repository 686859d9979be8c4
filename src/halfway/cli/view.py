"""``halfway view`` and ``halfway doctor``."""

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from ..locations import DEFAULT_LIBRARY
from .console import say, show_json, work
from .options import AsJson, Force, Lib


def view(
    lib: Lib = DEFAULT_LIBRARY,
    port: Annotated[int, typer.Option(help="0 takes any free one.")] = 8765,
    browser: Annotated[bool, typer.Option(help="Open the browser.")] = True,
    export: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Write the explorer as files, for any web server."),
    ] = None,
    materials: Annotated[
        str, typer.Option(metavar="NAME,NAME...", help="Of --export: these materials.")
    ] = "",
    n: Annotated[
        int | None,
        typer.Option("-n", help="Of --export: as many that look most different. [default: 8]"),
    ] = None,
    force: Force = False,
) -> None:
    """Explore a library in the browser: see the space, go anywhere, watch the material change.

    \b
    halfway view
    halfway view merl.brdflib --port 9000 --no-browser
    halfway view --export site --materials cherry-235,chrome,pink-felt,teflon
    """
    from halfway.library import open_library

    from .arguments import ArgumentError

    chosen = [
        option
        for option, value in (("--materials", materials), ("-n", n))
        if value not in ("", None)
    ]
    if len(chosen) == 2:
        raise ArgumentError("--materials and -n both say what is exported: give one of them.")
    if export is None and chosen:
        raise ArgumentError(
            f"{chosen[0]} says what is exported, and nothing is: add --export DIR, or leave it out."
        )
    library = open_library(lib)
    if export is None:
        from halfway.server import serve

        serve(library, port=port, open_browser=browser, work=work())
        return
    from halfway.server import export_some

    names = [name.strip() for name in materials.split(",") if name.strip()]
    written, shown = export_some(library, export, names, n=n, force=force, work=work())
    say(f"{export}: {', '.join(shown)}")
    say(
        f"{written.n_files} files, {written.n_bytes / 1e6:.1f} MB. Any web server shows it: "
        f"`python -m http.server -d {export}` does on this machine."
    )


def doctor(as_json: AsJson = False) -> None:
    """Say what rendering found on this machine, and what each missing thing costs."""
    from halfway.render import doctor as examine

    findings = examine()
    if as_json:
        show_json({"format": 1, "findings": [asdict(one) for one in findings]})
        return
    for finding in findings:
        print(f"{finding.what:14} {finding.found or 'missing: ' + finding.cost}")
    if any(finding.needed and finding.found is None for finding in findings):
        raise typer.Exit(1)
