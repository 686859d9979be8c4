"""Tests that touch every dependency, on the lowest versions that ``pyproject.toml`` allows: ``make lowest``.

Extras count, but for those of cloud storage: what stands in for a store in the tests takes newer versions than they do. The
tests' own tools are those of the lock.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
UV = os.environ.get("UV", "uv")  # `uv run` says where it is
EXTRAS = ("dask", "notebook", "video")
TESTS = (
    "test_cli.py",  # typer, rich, platformdirs, numpy, scipy, threadpoolctl, numba, matplotlib, pydantic, jaxtyping
    "test_cluster.py::test_results_come_in_order",  # distributed
    "test_cluster.py::test_a_library_is_the_same_bytes",
    "test_export_fits.py",  # materialx
    "test_fetch_download.py",  # httpx
    "test_notebook.py",  # anywidget
    "test_paper.py",  # markdown-it-py
    "test_render_obj.py",  # mapbox-earcut
    "test_render_pictures.py",  # mitsuba, mitsuba-oidn, karellen-llvm-core, pillow, av
    "test_server.py",  # fastapi, uvicorn
)
NOT_RUN = "test_the_golden_values_are_current"
"""Float32 sums of another numpy differ in the sixth digit."""


def main() -> None:
    """An environment of its own, what is in it, and the tests."""
    with tempfile.TemporaryDirectory() as folder:
        python, tools = Path(folder) / "bin" / "python", Path(folder) / "tools.txt"
        call(UV, "venv", "--quiet", "--python", sys.executable, folder)
        install = UV, "pip", "install", "--quiet", "--python", str(python)
        call(*install, "--resolution", "lowest-direct", "--editable", f".[{','.join(EXTRAS)}]")
        export = "--quiet", "--frozen", "--only-group", "check", "--no-hashes"
        call(UV, "export", *export, "--output-file", str(tools))
        call(*install, "--requirement", str(tools))
        call(UV, "pip", "list", "--python", str(python))
        tests = [str(ROOT / "tests" / test) for test in TESTS]
        call(str(python.parent / "pytest"), "-q", "-W", "default", "-k", f"not {NOT_RUN}", *tests)


def call(*words: str) -> None:
    """Run it here, in the open; its failure is ours."""
    done = subprocess.run(words, cwd=ROOT)
    if done.returncode:
        sys.exit(done.returncode)


if __name__ == "__main__":
    main()
