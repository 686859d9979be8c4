"""What each command takes, beside another version of halfway: ``python benchmarks/commands.py PYTHON``.

PYTHON is the interpreter of an environment that has the other version. Each round does the whole list in two new folders, one
command after the other, the two versions in turn; a round before keeps what is kept for the next run. The table says the median
of the seconds, and of the ratios; it exits with 1 where a command takes longer than `LIMIT` times what it took.
"""

import os
import shlex
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from statistics import median

COMMANDS = """
--version
library build builtin:merl-abc --grid 90x30x36 -o abc.brdflib
library compact abc.brdflib -k 20 -o abc.brdfc
library verify abc.brdflib
space abc.brdflib
route abc.brdflib teflon chrome -n 5 -o route --format merl
route abc.brdflib teflon chrome -n 5 --space paper -o paper --format merl
route light-brown-fabric blue-fabric -n 5 -o full --format merl
verify route
mix "gold-paint=0.7, teflon=0.3" -o mix.binary
convert mix.binary mix.bsdf
info mix.bsdf
check mix.binary
check abc.brdflib
report abc.brdflib -o report
fit mix.binary -o mix.mtlx
export mix.binary --for mitsuba -o scene
render mix.binary --size 192 --spp 32 -o mix.png
render route --scene sphere --size 64 --spp 32 -o strip.png
view abc.brdflib -n 5 --export site
demo -o demo
"""
ROUNDS = 3
LIMIT = 1.1


def main() -> None:
    """Race the two versions and print the table."""
    pythons = {"before": sys.argv[1], "now": sys.executable}
    commands = COMMANDS.strip().splitlines()
    with tempfile.TemporaryDirectory() as folder:
        rounds = [_round(commands, pythons, Path(folder), i) for i in range(ROUNDS + 1)][1:]
    slower = 0
    print("| halfway | before | now | now / before |\n|---|---|---|---|")
    for i, command in enumerate(commands):
        before, now = ([times[version][i] for times in rounds] for version in pythons)
        ratio = median(b / a for a, b in zip(before, now, strict=True))
        slower += ratio > LIMIT
        print(f"| {command} | {median(before):.2f} s | {median(now):.2f} s | {ratio:.2f} |")
    sys.exit(slower > 0)


def _round(
    commands: Sequence[str], pythons: dict[str, str], folder: Path, i: int
) -> dict[str, list[float]]:
    times: dict[str, list[float]] = {version: [] for version in pythons}
    here = {version: folder / version / str(i) for version in pythons}
    for each in here.values():
        each.mkdir(parents=True)
    for command in commands:
        for version, python in pythons.items():
            times[version].append(_time(python, command, here[version]))
    return times


def _time(python: str, command: str, here: Path) -> float:
    environment = os.environ | {"XDG_CACHE_HOME": str(here.parent / "cache")}
    words = [python, "-m", "halfway", *shlex.split(command)]
    start = time.perf_counter()
    done = subprocess.run(
        words, cwd=here, env=environment, capture_output=True, text=True, check=False
    )
    if done.returncode:
        sys.exit(f"{python} -m halfway {command}: exit {done.returncode}\n{done.stderr}")
    return time.perf_counter() - start


if __name__ == "__main__":
    main()
