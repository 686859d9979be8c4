"""The command line: parse, one call into the package, print.

Commands import what they use when they run, so that ``--help`` is immediate.
"""

import typer

from . import (
    check,
    console,
    demo,
    export,
    files,
    fit,
    library,
    mix,
    render,
    report,
    reproduce,
    route,
    space,
    verify,
    view,
)

app = typer.Typer(
    name="halfway",
    help="New materials from measured ones.",
    epilog="LIB is a library folder, an archive of neural fits, or builtin:merl-abc, the default. "
    "--debug shows the traceback of an error.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
app.add_typer(library.app, name="library")
COMMANDS = (
    demo.demo,
    view.view,
    route.route,
    mix.mix,
    render.render,
    report.report,
    reproduce.reproduce,
    space.space,
    check.check,
    verify.verify,
    export.export,
    fit.fit,
    files.convert,
    files.info,
    files.fetch,
    view.doctor,
)
for command in COMMANDS:
    app.command()(command)


def main() -> None:
    """The ``halfway`` command."""
    console.run(app)
