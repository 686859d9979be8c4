"""What the rows of the page on compatibility are made of: `compatibility`."""

import subprocess
import textwrap
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple


class Row(NamedTuple):
    """One thing that was tried."""

    program: str
    how: str
    """``run`` or ``emulated``."""
    what: str
    tried: Callable[[Path], str]
    """Makes the file in an empty folder, tries it, says what came of it."""


def python_with(packages: list[str], program: str, folder: Path, *, python: str = "") -> str:
    """What a Python program prints that runs in ``folder`` in an environment of these packages alone."""
    extra = [word for package in packages for word in ("--with", package)]
    extra += ["--python", python] if python else []
    done = subprocess.run(
        ["uv", "run", "--quiet", "--no-project", *extra, "python", "-c", textwrap.dedent(program)],
        cwd=folder, check=True, capture_output=True, text=True,
    )  # fmt: skip
    return done.stdout.strip()
