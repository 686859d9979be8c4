"""``halfway view`` and ``halfway doctor``."""

from typing import Annotated

import typer

from .console import cache_folder, track


def view(
    lib: Annotated[str, typer.Argument(metavar="[LIB]")] = "builtin:merl-abc",
    port: Annotated[int, typer.Option(help="0 takes any free one.")] = 8765,
    browser: Annotated[bool, typer.Option(help="Open the browser.")] = True,
) -> None:
    """Explore a library in the browser: see the space, go anywhere, watch the material change.

    \b
    halfway view
    halfway view merl.brdflib --port 9000 --no-browser
    """
    from halfway.library import open_library
    from halfway.server import serve

    serve(open_library(lib), port=port, open_browser=browser, cache=cache_folder(), track=track)


def doctor() -> None:
    """Say what rendering found on this machine, and what each missing thing costs."""
    from halfway.render import doctor as examine

    for finding in examine():
        print(f"{finding.what:14} {finding.found or 'missing: ' + finding.cost}")
