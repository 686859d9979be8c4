"""Stop a batch at random moments, again and again, and look at what is there: ``python benchmarks/kill_resume.py``.

A library of random tables is made, and one run of ``halfway route`` (or ``render``) that nobody stops is the reference. Then
the same command runs into another folder and is stopped by a signal at a random moment of the time that a whole run
takes. After each stop,

    no file under its final name is wrong or half: it has the bytes of the reference
    with INT (Ctrl-C): exit code 130 as a shell counts, one line, no temporary file

and when a run gets to its end the folder equals the reference, without a temporary file, and ``halfway verify`` agrees.
Then the folder is emptied, and it begins anew until there were as many stops as asked for.

    python benchmarks/kill_resume.py --stops 200                    kill -9
    python benchmarks/kill_resume.py --stops 50 --signal INT
    python benchmarks/kill_resume.py --stops 20 --command render
"""

import argparse
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from halfway import Grid, TabularBrdf, build_library
from halfway.formats import write_merl

ABOUT = ("manifest.json", "manifest.jsonl")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--stops", type=int, default=200)
    parser.add_argument("--signal", choices=["KILL", "INT"], default="KILL")
    parser.add_argument("--command", choices=["merl", "zarr", "render"], default="merl")
    parser.add_argument("--files", type=int, default=100)
    parser.add_argument("--grid", type=int, nargs=3, default=(30, 30, 60))
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="halfway-") as folder:
        os.chdir(folder)
        found = trial(options)
    print(json.dumps(found))
    sys.exit(bool(found["wrong"]))


def trial(options: argparse.Namespace) -> dict[str, object]:
    """Stop the command until there were enough stops; gives counts, and what was wrong."""
    make_library(Path("some.brdflib"), options.grid)
    command = words(options.command, options.files)
    start = time.monotonic()
    subprocess.run([*command, "reference"], check=True, capture_output=True)
    whole = time.monotonic() - start
    reference = contents(Path("reference"))
    chance = random.Random(options.seed)
    out = Path("out")
    n_stops = n_runs = n_partial = 0
    wrong: list[str] = []
    begun = time.monotonic()
    while n_stops < options.stops:
        n_runs += 1
        moment = chance.uniform(0, 1.05 * whole)
        code, talk = stopped([*command, str(out)], options.signal, moment)
        if code is None:
            n_stops += 1
            left = contents(out)
            n_partial += 0 < len(left) < len(reference)
            wrong += [
                f"{moment:.3f} s: {name}" for name in left if left[name] != reference.get(name)
            ]
        if code is None and options.signal == "INT":
            wrong += manners(moment, talk, out)
        if code == 0:
            wrong += finished(out, reference)
            shutil.rmtree(out)
        elif code is not None:
            wrong.append(f"{moment:.3f} s: exit {code}: {talk}")
    return {
        "command": options.command,
        "signal": options.signal,
        "files": len(reference),
        "stops": n_stops,
        "stops with some files finished": n_partial,
        "runs": n_runs,
        "seconds of a whole run": round(whole, 1),
        "minutes": round((time.monotonic() - begun) / 60, 1),
        "wrong": wrong,
    }


def make_library(path: Path, shape: tuple[int, int, int]) -> None:
    """A stored library of eight random tables."""
    grid = Grid.merl(*shape)
    rng = np.random.default_rng(0)
    for i in range(8):
        values = rng.gamma(1.0, 0.1, (3, *grid.shape)).astype(np.float32)
        write_merl(f"measured/m{i}.binary", TabularBrdf(values, grid))
    build_library(["measured"], path)


def words(command: str, n: int) -> list[str]:
    """The command line, all but the folder to write."""
    halfway = [sys.executable, "-m", "halfway"]
    way = ["route", "some.brdflib", "m0", "m1", "m2", "-n", str(n), "--space", "linear"]
    way += ["--pace", "uniform"]
    if command != "render":
        return [*halfway, *way, "--format", command, "-o"]
    subprocess.run([*halfway, *way, "-o", "way"], check=True, capture_output=True)
    return [*halfway, "render", "way", "--size", "64", "--spp", "1", "-o"]


def contents(folder: Path) -> dict[str, bytes]:
    """The bytes of the files under their final names."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and path.name not in ABOUT and not path.name.startswith(".")
    }


def temporaries(folder: Path) -> list[str]:
    return [path.name for path in folder.rglob(".*")]


def stopped(command: list[str], name: str, moment: float) -> tuple[int | None, str]:
    """Run a command and stop it after ``moment`` seconds; its exit code where it came to an end, and what it said."""
    process = subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    )
    try:
        return process.wait(moment), process.stderr.read()  # pyright: ignore
    except subprocess.TimeoutExpired:
        process.send_signal(getattr(signal, f"SIG{name}"))
    _, talk = process.communicate(timeout=60)
    # A shell calls both 130: Python ends itself by the signal where a compiled module saw it first.
    expected = {"KILL": (-signal.SIGKILL,), "INT": (130, -signal.SIGINT)}[name]
    if process.returncode in expected and (name == "KILL" or "interrupted" in talk):
        return None, talk
    # It had come to its end just before the signal, which took the interpreter while it closed.
    return 0 if process.returncode in expected else process.returncode, talk


def manners(moment: float, talk: str, folder: Path) -> list[str]:
    """What is wrong with how Ctrl-C was taken."""
    wrong = [f"{moment:.3f} s: temporary {name}" for name in temporaries(folder)]
    if talk.count("\n") != 1 or not talk.startswith("halfway: interrupted"):
        wrong.append(f"{moment:.3f} s: said {talk!r}")
    return wrong


def finished(folder: Path, reference: dict[str, bytes]) -> list[str]:
    """What is wrong with a folder that a run finished."""
    wrong = [f"left {name}" for name in temporaries(folder)]
    found = contents(folder)
    wrong += [
        f"finished, {n}" for n in reference.keys() | found if found.get(n) != reference.get(n)
    ]
    verdict = subprocess.run(
        [sys.executable, "-m", "halfway", "verify", str(folder), "--json"], capture_output=True
    )
    if verdict.returncode:
        wrong.append(f"verify: {verdict.stdout.decode()}")
    return wrong


if __name__ == "__main__":
    main()
