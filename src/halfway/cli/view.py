"""``halfway view`` and ``halfway doctor``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..locations import DEFAULT_LIBRARY
from .console import say, work

if TYPE_CHECKING:
    from ..library import Library

N_EXPORTED = 8
"""Materials that an exported explorer carries where nobody says which."""


def view(
    lib: Annotated[str, typer.Argument(metavar="[LIB]")] = DEFAULT_LIBRARY,
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
        typer.Option("-n", help=f"Of --export: as many that look most different; {N_EXPORTED}."),
    ] = None,
) -> None:
    """Explore a library in the browser: see the space, go anywhere, watch the material change.

    \b
    halfway view
    halfway view merl.brdflib --port 9000 --no-browser
    halfway view --export site --materials cherry-235,chrome,pink-felt,teflon
    """
    from halfway.library import open_library

    from .arguments import ArgumentError

    if export is not None:
        _export(open_library(lib), export, materials, n)
    elif materials or n is not None:
        option = "--materials" if materials else "-n"
        raise ArgumentError(
            f"{option} says what is exported, and nothing is: add --export DIR, or leave it out."
        )
    else:
        from halfway.server import serve

        serve(open_library(lib), port=port, open_browser=browser, work=work())


def _export(library: "Library", folder: Path, materials: str, n: int | None) -> None:
    from halfway.library import Subset
    from halfway.look import Looks, most_different
    from halfway.server import Page, export, require_own

    from .arguments import ArgumentError

    if materials and n is not None:
        raise ArgumentError("--materials and -n both say what is exported: give one of them.")
    require_own(folder)
    names = [name.strip() for name in materials.split(",") if name.strip()]
    if not names:
        images = Looks.fit(library, work=work())
        names = most_different(images, min(N_EXPORTED, len(library)) if n is None else n)
    written = export(Subset(library, names), folder, Page.load(), work=work())
    say(f"{folder}: {', '.join(names)}")
    say(
        f"{written.n_files} files, {written.n_bytes / 1e6:.1f} MB. Any web server shows it: "
        f"`python -m http.server -d {folder}` does on this machine."
    )


def doctor() -> None:
    """Say what rendering found on this machine, and what each missing thing costs; exit 1 where one is needed."""
    from halfway.render import doctor as examine

    findings = examine()
    for finding in findings:
        print(f"{finding.what:14} {finding.found or 'missing: ' + finding.cost}")
    if any(finding.needed and finding.found is None for finding in findings):
        raise typer.Exit(1)
