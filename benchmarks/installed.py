"""What an installation weighs: ``python benchmarks/installed.py [WHEEL]``.

The wheel (built here where none is given) goes into an environment of its own, past every cache, and a table says the seconds,
the megabytes, and each package's share of them, by what halfway needs it for.
"""

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parents[1]
SHARES = """
import importlib.metadata, json
sizes = {}
for package in importlib.metadata.distributions():
    files = (package.locate_file(file) for file in package.files or [])
    sizes[package.name.lower()] = sum(file.stat().st_size for file in files if file.is_file())
print(json.dumps(sizes))
"""
FOR = {
    "rendering": {"mitsuba", "drjit", "karellen-llvm-core", "mitsuba-oidn", "mapbox-earcut"},
    "compiled loops": {"numba", "llvmlite"},
    "arrays, triangulations, fits": {"numpy", "scipy"},
    "plots and pictures": {"matplotlib", "pillow", "fonttools", "contourpy", "kiwisolver"},
    "MaterialX": {"materialx"},
    "halfway itself": {"halfway"},
}


def main() -> None:
    """Install, and print the table."""
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        wheel = Path(sys.argv[1]) if len(sys.argv) > 1 else _build(work)
        python = work / "env" / "bin" / "python"
        _call("uv", "venv", "--quiet", str(work / "env"))
        start = time.perf_counter()
        _call("uv", "pip", "install", "--quiet", "--no-cache", "--python", str(python), str(wheel))
        seconds = time.perf_counter() - start
        sizes: dict[str, int] = json.loads(_call(str(python), "-c", SHARES))
    print(f"{seconds:.0f} s, downloads included, {len(sizes)} packages, {_mb(sizes.values())} MB")
    for what, names in FOR.items():
        print(
            f"{_mb(sizes.get(name, 0) for name in names):6} MB  {what}: {', '.join(f'{n} {_mb([sizes.get(n, 0)])}' for n in sorted(names))}"
        )
    named = set().union(*FOR.values())
    print(f"{_mb(size for name, size in sizes.items() if name not in named):6} MB  all others")


def _build(work: Path) -> Path:
    _call("uv", "build", "--quiet", "--wheel", "--out-dir", str(work / "dist"), str(ROOT))
    (wheel,) = (work / "dist").glob("*.whl")
    return wheel


def _mb(sizes) -> int:
    return round(sum(sizes) / 1e6)


def _call(*words: str) -> str:
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout


if __name__ == "__main__":
    main()
