"""Fuzz every reader for as long as one likes, guided by the branches that an input takes (Atheris, libFuzzer).

    uv run --with atheris python tests/fuzz.py --minutes 60
    uv run --with atheris python tests/fuzz.py --minutes 5 rgl zip

The time is split evenly; the kinds are those of `hostile.subjects`. Each has a process of its own, with 1 GB of memory beyond
what the imports take and 10 s for one input. What a fuzzer finds (anything but a `HalfwayError` of one line) is kept in
``fuzz/KIND/`` beside the inputs that led to new branches, and the exit code is 1.
"""

import argparse
import re
import resource
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

SECONDS_PER_INPUT = 10
SPARE_BYTES = 1 << 30
LARGEST_INPUT = 1 << 16


def main() -> None:
    """Each kind in a process of its own; what it said at its end."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)  # fmt: skip
    parser.add_argument("kinds", nargs="*", help="all of them by default")
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--folder", type=Path, default=Path("fuzz"))
    parser.add_argument("--one", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        _fuzz(options.kinds[0], options.folder, round(60 * options.minutes))
        return
    kinds = options.kinds or _kinds()
    minutes = options.minutes / len(kinds)
    failed = 0
    for kind in kinds:
        command = [sys.executable, __file__, kind, "--one", "--minutes", str(minutes), "--folder", str(options.folder)]  # fmt: skip
        done = subprocess.run(command, capture_output=True, text=True, errors="replace")
        log = done.stdout + done.stderr
        (options.folder / f"{kind}.log").write_text(log)
        runs = re.findall(r"(?:Done |number_of_executed_units: |#)(\d+)", log)
        # It says so when its time is over; the exit code may be that of Mitsuba's threads, which do not end with the process.
        whole = re.search(r"^Done \d+ runs", log, re.MULTILINE) is not None
        result = "nothing found" if whole else f"FOUND, see {kind}.log"
        print(f"{kind:14} {int(runs[-1]) if runs else 0:>10,} inputs  {result}", flush=True)
        failed += not whole
    sys.exit(failed > 0)


def _kinds() -> list[str]:
    from hostile import subjects

    with tempfile.TemporaryDirectory() as folder:
        return [*subjects(Path(folder))]


def _fuzz(kind: str, folder: Path, seconds: int) -> None:
    import atheris

    found = folder / kind
    found.mkdir(parents=True, exist_ok=True)
    place = Path(tempfile.mkdtemp(prefix=f"fuzz-{kind}-"))
    with atheris.instrument_imports(include=["halfway", "zipfile", "json"]):
        from hostile import subjects

        from halfway.errors import HalfwayError

        subject = subjects(place / "valid")[kind]
        (found / "valid").write_bytes(subject.valid)
        subject.read(subject.valid, place)  # loads what loads when it is first used
    warnings.simplefilter("ignore")  # that a damaged file warns is no fault
    _limit_memory()

    def one_input(content: bytes) -> None:
        try:
            subject.read(content, place)
        except HalfwayError as error:
            said = str(error)
            assert "\n" not in said, said
            assert 20 < len(said) < 1000, said

    options = {"max_total_time": seconds, "timeout": SECONDS_PER_INPUT, "max_len": LARGEST_INPUT, "len_control": 0, "rss_limit_mb": 0, "print_final_stats": 1}  # fmt: skip
    flags = [f"-{name}={value}" for name, value in options.items()]
    atheris.Setup([sys.argv[0], str(found), f"-artifact_prefix={found}/", *flags], one_input)
    atheris.Fuzz()


def _limit_memory() -> None:
    """A reader that believes a lie of many gigabytes gets a MemoryError, which counts as found."""
    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + SPARE_BYTES, used + SPARE_BYTES))


if __name__ == "__main__":
    main()
