"""The command line: parse, one call into the package, print.

Commands import what they use when they run, so that ``--help`` is immediate.
"""

from typing import Annotated

import typer

from ..locations import DEFAULT_LIBRARY
from . import (
    attributes,
    benchmark,
    check,
    console,
    demo,
    export,
    files,
    find,
    fit,
    library,
    mix,
    plan,
    recover,
    render,
    report,
    reproduce,
    route,
    sample,
    space,
    verify,
    view,
)

app = typer.Typer(
    name="halfway",
    help="New materials from measured ones.",
    epilog="LIB is a library folder, a compact library, an archive of neural fits, builtin:synthetic-N, or the default, "
    f"{DEFAULT_LIBRARY}. --debug shows the traceback of an error.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
app.add_typer(library.app, name="library")
COMMANDS = (
    demo.demo,
    view.view,
    route.route,
    sample.sample,
    mix.mix,
    find.find,
    recover.recover,
    plan.plan,
    attributes.attributes,
    render.render,
    report.report,
    reproduce.reproduce,
    benchmark.benchmark,
    space.space,
    check.check,
    verify.verify,
    export.export,
    fit.fit,
    files.convert,
    files.info,
    files.diff,
    files.fetch,
    view.doctor,
)
for command in COMMANDS:
    app.command()(command)


def _say_version(asked: bool) -> None:
    if asked:
        from .. import __version__

        print(__version__)
        raise typer.Exit


@app.callback()
def root(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_say_version, is_eager=True, help="Say which version this is."
        ),
    ] = False,
) -> None:
    """New materials from measured ones."""
    del version  # its callback has said it


def main() -> None:
    """The ``halfway`` command."""
    console.run(app)
