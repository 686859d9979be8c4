"""Whether a change of the code changes a result: the SHA-256 of every file that a list of commands writes.

    python tests/same_results.py write sums.json --documents kept      before
    python tests/same_results.py compare sums.json --documents kept    after

Each command runs in a process of its own, in a folder and with a cache that were empty; what it prints is a file like any
other. The folder always has the same name, which goes into manifests. ``--documents`` keeps the JSON that was written, so that a comparison can say what in it differs.

The sums are of floating-point results, and hold on one kind of machine with one set of dependencies: where
``tests/golden/same_results.json`` does not hold before a change, write another.
"""

import argparse
import hashlib
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from fnmatch import fnmatch
from itertools import zip_longest
from pathlib import Path
from typing import Any

import h5py
import numpy as np

CHANGED: dict[str, str] = {}
"""Why the sums of the files that a pattern stands for are others than those that were kept."""

COMMANDS = """
library build builtin:merl-abc --grid 12x8x12 -o abc.brdflib
library build given --grid 12x8x12 --licence CC0 --source nowhere -o given.brdflib
library build given.brdflib abc.brdflib -o both.brdflib
library compact abc.brdflib -k 12 -o abc.brdfc
library info
library info --json
library info abc.brdflib --json
library info given.brdflib
library info abc.brdfc --json
library verify abc.brdflib --json
library verify abc.brdfc --json

route abc.brdflib teflon chrome -n 5 -o anchored --format merl
route abc.brdflib teflon chrome -n 5 --pace uniform -o anchored-uniform --format merl
route abc.brdflib teflon gold-paint chrome -n 7 -o three-stops --format merl
route abc.brdflib cherry-235 chrome --detour 1.02 -n 5 -o direct
route abc.brdflib cherry-235 chrome -k 2 -n 5 -o two-scores
route abc.brdflib teflon chrome -n 5 --space paper -o paper --format merl
route abc.brdflib teflon gold-paint chrome -k 5 --space paper --pace uniform --t 0,0.3,0.5:1:0.25 -o paper-list --format merl
route abc.brdflib teflon chrome -n 5 --space linear -o linear --format merl
route abc.brdflib teflon chrome -n 3 --pace uniform --space linear --json
route abc.brdflib teflon chrome -n 2 -o rgl --format bsdf
route abc.brdflib teflon chrome -n 3 -o stored --format zarr
route abc.brdfc teflon chrome -n 3 -o compact --format merl
route given.brdflib matte glossy -n 3 --space linear -o given-route --format merl
route light-brown-fabric blue-fabric -n 5 --space paper -o full-paper
route light-brown-fabric blue-fabric -n 5 -o full-anchored
verify anchored --json
verify stored --json

space abc.brdflib
space abc.brdflib --json
space abc.brdflib --near gold-paint -n 5
mix "gold-paint=0.7, teflon=0.3" -o full.binary
mix abc.brdflib "gold-paint=0.7, teflon=0.3" -o weights.binary
mix abc.brdflib "gold-paint=0.7, teflon=0.3" -o weights.bsdf
mix anchored/recipes.json:2 -o third.binary
mix abc.brdflib --point=0,0,0,0,0.17,0.134,0.117 -o inside.binary
mix abc.brdflib --point=-1e6,0,0,0,2,0,0 --clamp -o nearest.binary

convert abc.brdflib:teflon teflon.binary
convert abc.brdflib:teflon teflon.bsdf
convert abc.brdflib:teflon spectral.bsdf --spectral
convert abc.brdflib:teflon teflon.mtlx
convert abc.brdflib:teflon teflon.gltf
convert abc.brdflib:teflon teflon.glb
convert teflon.binary again.bsdf
convert teflon.bsdf again.binary
convert spectral.bsdf spectral.binary
convert given/neural.h5 neural.binary
convert given/neural.h5 neural.bsdf
convert third.binary third.bsdf
info abc.brdflib:teflon
info teflon.bsdf
info given/neural.h5
info builtin:merl-abc:teflon

check abc.brdflib
check abc.brdflib --json
check anchored teflon.bsdf --json                                                # broken
check given/neural.h5 --json                                                    # broken
check given/noise.binary --json                                                 # broken
check given/noise.binary --repair -o mended.binary
check mended.binary --json

report abc.brdflib --pairs 12 -o report
report abc.brdflib -o report-plain --json
report abc.brdfc -o report-compact
view abc.brdflib -n 5 --export site
view abc.brdflib --materials chrome,gold-paint,pink-felt,teflon --export site-named

fit abc.brdflib:gold-paint -o gold.mtlx
fit abc.brdflib:gold-paint --model gltf -o gold.json
fit abc.brdflib:gold-paint --model principled --json
fit anchored/recipes.json:2 --model principled -o third.json
export abc.brdflib:gold-paint --for mitsuba -o scenes/mitsuba
export abc.brdflib:gold-paint --for pbrt-v4 -o scenes/pbrt-v4
export three-stops/recipes.json --for mitsuba -o scenes/route
export full.binary --for pbrt-v2 -o scenes/pbrt-v2

render anchored --scene sphere --size 24 --spp 4 --no-denoise -o strip.png
render abc.brdflib:chrome third.binary --scene spheres --size 24 --spp 4 --no-denoise -o two.png
render third.binary --scene teapot --size 24 --spp 4 --bounces 3 --no-denoise -o one.exr
render anchored --scene sphere --size 24 --spp 4 --no-denoise --format exr -o frames
"""

BROKEN = "broken"
"""Said of a command that exits with 1, as it finds a law broken."""

SKIPPED = (
    "given/*", "cache/*", "site*/index.html", "site*/assets/*", "*.svg", "report*/manifest.json",
)  # fmt: skip
"""What was given, what is kept for the next run, the page, which is built of what is in `viewer/`, figures that hold
the time and ids of the run (the same figure is in the `.png` beside them), and the manifests that have their checksums."""


FOLDER = Path(tempfile.gettempdir()).resolve() / "halfway-same-results"


def main() -> None:
    arguments = _parse()
    with _new_folder() as here:
        _write_given(here / "given")
        for command, code in commands():
            _run(arguments.python, command, code, here)
        written = dict(_contents(here))
    sums = {path: hashlib.sha256(content).hexdigest() for path, content in written.items()}
    documents = {path: written[path] for path in written if path.endswith((".json", ".gltf"))}
    if arguments.verb == "write":
        arguments.sums.write_text(json.dumps(sums, indent=0) + "\n")
        _keep(arguments.documents, documents)
    else:
        before = json.loads(arguments.sums.read_text())
        sys.exit(compare(before, sums, documents, arguments.documents))


def _parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("verb", choices=["write", "compare"])
    parser.add_argument("sums", type=Path, help="the JSON file of the sums")
    parser.add_argument("--documents", type=Path, help="a folder of the JSON that was written")
    parser.add_argument("--python", default=sys.executable, help="whose halfway is run")
    return parser.parse_args()


@contextmanager
def _new_folder() -> Iterator[Path]:
    FOLDER.mkdir()  # fails where another run goes on, or was killed
    try:
        yield FOLDER
    finally:
        shutil.rmtree(FOLDER)


def commands() -> Iterator[tuple[str, int]]:
    """Each command with the exit code that it should have."""
    for line in filter(None, COMMANDS.splitlines()):
        command, _, remark = line.partition(" # ")
        yield command.strip(), int(remark.strip() == BROKEN)


def _write_given(folder: Path) -> None:
    """A neural fit, two smooth tables, and one that breaks laws; from a seed."""
    folder.mkdir()
    rng = np.random.default_rng(0)
    _write_network(folder / "neural.h5", rng)
    shape = (3, 12, 8, 12)
    theta_h = np.linspace(0, 1, 12)[:, None, None]
    _write_merl(folder / "matte.binary", np.full(shape, 0.1))
    _write_merl(folder / "glossy.binary", 0.05 + np.broadcast_to(np.exp(-9 * theta_h), shape))
    _write_merl(folder / "noise.binary", rng.gamma(0.5, size=shape) * 3)


def _write_network(path: Path, rng: np.random.Generator) -> None:
    """A network of random weights, as Keras writes it."""
    sizes = {"a": (6, 21), "b": (21, 21), "c": (21, 3)}
    with h5py.File(path, "w") as file:
        file.attrs["layer_names"] = [layer.encode() for layer in sizes]
        for layer, (n_in, n_out) in sizes.items():
            group = file.create_group(layer)
            names = [f"{layer}/kernel:0", f"{layer}/bias:0"]
            group.attrs["weight_names"] = [name.encode() for name in names]
            group[names[0]] = rng.normal(0, 0.3, (n_in, n_out)).astype(np.float32)
            group[names[1]] = rng.normal(0, 0.3, n_out).astype(np.float32)


def _write_merl(path: Path, values: np.ndarray) -> None:
    scale = np.array([1500, 1500 / 1.15, 1500 / 1.66]).reshape(3, 1, 1, 1)
    path.write_bytes(np.array(values.shape[1:], "<i4").tobytes() + (values * scale).tobytes())


def _run(python: str, command: str, code: int, here: Path) -> None:
    print(f"halfway {command}", file=sys.stderr, flush=True)
    # One thread of BLAS: the order of its sums is not that of the machine's cores.
    own = {"XDG_CACHE_HOME": str(here / "cache"), "COLUMNS": "120", "OPENBLAS_NUM_THREADS": "1"}
    words = [python, "-m", "halfway", *shlex.split(command)]
    done = subprocess.run(words, cwd=here, env=os.environ | own, capture_output=True, check=False)
    if done.returncode != code:
        sys.exit(f"halfway {command}: exit {done.returncode}\n{done.stderr.decode()}")
    said = here / "said" / (re.sub(r"[^\w.=-]+", "-", command)[:100] + _suffix(command))
    said.parent.mkdir(exist_ok=True)
    said.write_bytes(done.stdout)


def _suffix(command: str) -> str:
    return ".json" if "--json" in command else ".txt"


def _contents(here: Path) -> Iterator[tuple[str, bytes]]:
    for file in sorted(here.rglob("*")):
        path = file.relative_to(here).as_posix()
        if file.is_file() and not any(fnmatch(path, skipped) for skipped in SKIPPED):
            yield path, file.read_bytes()


def _keep(folder: Path | None, documents: Mapping[str, bytes]) -> None:
    for path, content in documents.items() if folder else ():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(content)


def compare(
    before: Mapping[str, str],
    now: Mapping[str, str],
    documents: Mapping[str, bytes],
    kept: Path | None,
) -> int:
    """Say which sums differ; 1 where one does without a reason."""
    different = sorted(path for path in before | now if before.get(path) != now.get(path))
    unexplained = 0
    for path in different:
        reason = next((why for pattern, why in CHANGED.items() if fnmatch(path, pattern)), "")
        unexplained += not reason
        print(f"{'changed' if reason else 'DIFFERS'}  {path}: {reason or _why(path, before, now)}")
        if kept and path in documents and (kept / path).is_file():
            print(f"    {first_difference((kept / path).read_bytes(), documents[path])}")
    for pattern in CHANGED:
        if not any(fnmatch(path, pattern) for path in different):
            print(f"note: nothing that {pattern} stands for has changed")
    explained = len(different) - unexplained
    print(
        f"{len(before | now) - len(different)} same, {explained} changed for a reason, {unexplained} differ"
    )
    return int(unexplained > 0)


def _why(path: str, before: Mapping[str, str], now: Mapping[str, str]) -> str:
    return "is new" if path not in before else "is gone" if path not in now else "has other bytes"


def first_difference(before: bytes, now: bytes) -> str:
    """Where two JSON documents first differ, and in what."""
    differences = _differences("$", json.loads(before), json.loads(now))
    return next(differences, "equal as JSON: the layout or the order of keys differs")


def _differences(path: str, before: Any, now: Any) -> Iterator[str]:
    match before, now:
        case dict(), dict():
            for key in before | now:
                yield from _differences(f"{path}.{key}", before.get(key), now.get(key))
        case list(), list():
            for i, (one, other) in enumerate(zip_longest(before, now)):
                yield from _differences(f"{path}[{i}]", one, other)
        case _ if before != now:
            yield f"{path}: {before!r} was, {now!r} is"


if __name__ == "__main__":
    main()
