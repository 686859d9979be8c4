"""How the command line talks: data to stdout, talk and progress to stderr, a mistake in one line."""

import json
import os
import sys
import time
import warnings
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from io import TextIOWrapper
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from ..errors import HalfwayError, shown

if TYPE_CHECKING:
    from ..tasks import Work

T = TypeVar("T")

INTERRUPTED = 130
"""The exit code after Ctrl-C."""

BROKEN_PIPE = 141
"""The exit code when nobody reads the answer to its end, as of a program that the signal stops."""

PATIENCE = 1.0
"""Seconds before a progress bar appears."""


def say(*lines: str) -> None:
    """Lines for the person, on stderr."""
    with suppress(OSError):  # nobody is there to hear it
        for line in lines:
            print(shown(line), file=sys.stderr)


def show(*lines: str, end: str = "\n") -> None:
    """Lines of the answer, on stdout; names in them may hold anything."""
    for line in lines:
        print(shown(line), end=end)


def show_json(document: object) -> None:
    """The answer for programs, on stdout."""
    print(json.dumps(document, indent=1))


def track(items: Iterable[T], label: str, total: int) -> Iterable[T]:
    """A progress bar over anything that takes more than a second; nothing where stderr is no terminal."""
    return _bar(items, label, total) if sys.stderr.isatty() else items


def _bar(items: Iterable[T], label: str, total: int) -> Iterator[T]:
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeRemainingColumn,
    )

    columns = TextColumn(label), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn()
    rate = TextColumn("{task.fields[rate]}")
    progress = Progress(*columns, rate, console=Console(stderr=True), transient=True)
    task = progress.add_task(label, total=total, rate="")
    start = time.monotonic()
    try:
        for item in items:
            yield item
            speed = progress.tasks[0].speed
            progress.update(task, advance=1, rate=_rate(speed) if speed else "")
            if not progress.live.is_started and time.monotonic() - start > PATIENCE:
                progress.start()
    finally:
        if progress.live.is_started:
            progress.stop()


def _rate(per_second: float) -> str:
    return f"{per_second:.1f}/s" if per_second >= 1 else f"{1 / per_second:.1f} s each"


def work() -> "Work":
    """Work on this machine, with progress bars and the user's cache."""
    from ..tasks import Work

    return Work(track=track, cache=cache_folder())


@contextmanager
def working(scheduler: str) -> "Generator[Work]":
    """`work` whose tasks run on the cluster with this address, or here where it is empty."""
    if not scheduler:
        yield work()
        return
    import logging

    from ..cluster import Cluster

    logging.disable(logging.CRITICAL)  # what goes wrong is told in one line, once
    try:
        with Cluster.at(scheduler) as cluster:
            yield replace(work(), engine=cluster)
    finally:
        logging.disable(logging.NOTSET)


def run(app: Callable[[], None]) -> None:
    """Run the command; a mistake is one line and exit 1, and ``--debug`` anywhere shows where it came from."""
    debug = "--debug" in sys.argv
    sys.argv = [word for word in sys.argv if word != "--debug"]
    warnings.showwarning = _note
    if isinstance(sys.stdout, TextIOWrapper):
        sys.stdout.reconfigure(
            errors="backslashreplace"
        )  # names, where the terminal has not all letters
    try:
        _flushed(app)
    except BrokenPipeError:
        _leave_stdout()
        sys.exit(BROKEN_PIPE)
    except (HalfwayError, OSError) as error:
        _leave_stdout()
        if debug:
            raise
        say(f"halfway: {_message(error)}")
        sys.exit(1)
    except SystemExit as stop:
        # Typer makes a silent exit of Ctrl-C.
        if stop.code == INTERRUPTED:
            raise KeyboardInterrupt from None
        raise


def _flushed(app: Callable[[], None]) -> None:
    try:
        app()
    finally:
        sys.stdout.flush()


def _leave_stdout() -> None:
    """Send what is still to be written nowhere, where it cannot be written: Python would complain when it ends."""
    try:
        sys.stdout.flush()
    except OSError:
        with suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _message(error: Exception) -> str:
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename or 'the output cannot be written'}: {error.strerror}."
    return str(error)


def _note(message: Warning | str, *_: object, **__: object) -> None:
    say(f"note: {message}")


def cache_folder() -> Path | None:
    """Where small dear results are kept for this user."""
    from ..cache import user_folder

    return user_folder()
