"""The release, tried as a newcomer gets it: ``make release-check``.

What is committed becomes a source distribution, and that a wheel; the wheel goes into an environment of its own, with nothing of
ours beside it; and every command of the tutorial runs there, from an empty folder, with small pictures.
"""

import os
import re
import shlex
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request
import zipfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
UV = os.environ.get("UV", "uv")  # `uv run` says where it is
TUTORIAL = ROOT / "docs" / "tutorial.md"
IN_WHEEL = ("halfway/py.typed", "halfway/server/page/index.html")
NOT_IN_WHEEL = ("tests/", "docs/", "viewer/", "examples/")
BY_OTHER_MEANS = r"python3 -m venv|\. new-materials|pip install|halfway view"
NOT_RUN = r"halfway fetch|merl\.brdflib|library build merl"
"""Downloads."""
READ_ONLY = (
    'halfway mix "gold-paint=0.7, teflon=0.3" -o elsewhere.binary',
    "halfway check elsewhere.binary",
    "halfway route teflon chrome -n 2 -o elsewhere --format merl --space linear --pace uniform",
    "halfway fit builtin:merl-abc:teflon --model gltf -o elsewhere.json",
    "halfway render elsewhere.binary -o elsewhere.png --size 32 --spp 2",
)
"""For an installation that may not be written, of a user without a home."""
YARDSTICK = "halfway benchmark --quick -o yardstick"
"""Two minutes on two cores, of a package that has only what it asks for."""
SMALLER = {"halfway render": "--size 32 --spp 2"}


def main() -> None:
    """Every step, with the seconds it took; the first that fails ends it."""
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        work.chmod(0o755)  # others run what is in it
        wheel = step("build", lambda: build(work))
        step("contents", lambda: check_contents(wheel))
        env = step("install", lambda: install(work, wheel))
        empty = work / "empty"
        empty.mkdir()
        step("version", lambda: check_version(env, wheel))
        for line in tutorial():
            step(line, lambda line=line: run(line, env, empty))
        step(YARDSTICK, lambda: run(YARDSTICK, env, empty))
        step("halfway view", lambda: view(env, empty))
        for line in READ_ONLY:
            step(f"read-only: {line}", lambda line=line: run_read_only(line, env, empty))


def build(work: Path) -> Path:
    """The wheel, made from the source distribution of what is committed."""
    source = work / "source"
    call("git", "clone", "--quiet", "--depth=1", f"file://{ROOT}", str(source))
    call(UV, "build", "--quiet", "--out-dir", str(work / "dist"), cwd=source)
    (wheel,) = (work / "dist").glob("*.whl")
    return wheel


def check_contents(wheel: Path) -> None:
    """The page and the mark of types are in it, what is ours alone is not."""
    names = zipfile.ZipFile(wheel).namelist()
    missing = [name for name in IN_WHEEL if name not in names]
    foreign = [name for name in names if name.startswith(NOT_IN_WHEEL)]
    if missing or foreign:
        raise SystemExit(f"{wheel.name} lacks {missing} and holds {foreign[:5]}")


def install(work: Path, wheel: Path) -> Path:
    """An environment with the wheel and what it asks for, and nothing else."""
    env = work / "env"
    call(UV, "venv", "--quiet", "--python", interpreter(), str(env))
    call(UV, "pip", "install", "--quiet", "--python", str(env / "bin" / "python"), str(wheel))
    return env


def interpreter() -> str:
    """A Python that every user can run: root's own may lie in a folder that is closed to others."""
    for path in (sys.executable, "/usr/bin/python3"):
        folders = Path(path).resolve().parents
        if os.geteuid() != 0 or all(folder.stat().st_mode & 0o001 for folder in folders):
            return path
    raise SystemExit(
        f"{sys.executable} is closed to other users: expected a Python that they can run"
    )


def check_version(env: Path, wheel: Path) -> None:
    """The package, the wheel and CITATION.cff say the same."""
    said = call(
        str(env / "bin" / "python"), "-c", "import halfway; print(halfway.__version__)"
    ).strip()
    cited = re.search(r"^version: (.+)$", (ROOT / "CITATION.cff").read_text(), re.MULTILINE)
    if cited is None or not said == cited[1] == wheel.name.split("-")[1]:
        raise SystemExit(f"the package says {said}, the wheel {wheel.name}, CITATION.cff {cited}")


def tutorial() -> list[str]:
    """The tutorial's commands, with smaller pictures."""
    blocks = re.findall(r"^```sh\n(.*?)^```$", TUTORIAL.read_text(), re.MULTILINE | re.DOTALL)
    lines = [line for block in blocks for line in block.splitlines() if line]
    lines = [line for line in lines if not re.search(f"{BY_OTHER_MEANS}|{NOT_RUN}", line)]
    for command, options in SMALLER.items():
        lines = [f"{line} {options}" if line.startswith(command) else line for line in lines]
    return lines


def run(line: str, env: Path, folder: Path) -> None:
    """One line of the tutorial, in the folder where it left us."""
    words = shlex.split(line)
    if words[0] == "cd":
        HERE.append(HERE[-1] / words[1] if HERE else folder / words[1])
        return
    call(str(env / "bin" / words[0]), *words[1:], cwd=HERE[-1] if HERE else folder)


def run_read_only(line: str, env: Path, folder: Path) -> None:
    """One line as on a cluster node or in a container: nothing but the folder can be written."""
    command, *words = shlex.split(line)
    words = [str(env / "bin" / command), *words]
    if os.geteuid() == 0:  # who may write whatever its mode is: somebody else runs it
        folder.chmod(0o777)
        words = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", *words]
    else:
        for path in (env, *env.rglob("*")):
            if not path.is_symlink():
                path.chmod(path.stat().st_mode & ~0o222)
    call("env", "HOME=/proc/none", *words, cwd=folder)


HERE: list[Path] = []
"""Folders that the tutorial went into."""


def view(env: Path, folder: Path) -> None:
    """The explorer answers with its page."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    server = subprocess.Popen(
        [str(env / "bin" / "halfway"), "view", "--no-browser", "--port", str(port)],
        cwd=folder,
        stderr=subprocess.DEVNULL,
    )
    try:
        wait_for(f"http://127.0.0.1:{port}/", server)
    finally:
        server.terminate()
        server.wait(timeout=60)


def wait_for(url: str, server: subprocess.Popen[bytes]) -> None:
    """Until the page is there; two minutes at most."""
    for _ in range(240):
        time.sleep(0.5)
        try:
            with urllib.request.urlopen(url) as answer:
                if b"<html" in answer.read():
                    return
        except OSError:
            if server.poll() is not None:
                break
    raise SystemExit(f"{url} does not answer")


def call(*words: str, cwd: Path | None = None) -> str:
    """What a command prints; its error is ours. No variable of this environment but where things are."""
    kept = ("PATH", "HOME", "LANG", "SSL_CERT_FILE", "TMPDIR")
    settings = {k: v for k, v in os.environ.items() if k in kept or k.startswith(("UV_", "PIP_"))}
    done = subprocess.run(words, cwd=cwd, env=settings, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(
            f"{shlex.join(words)} ended with {done.returncode}:\n{done.stderr[-3000:]}"
        )
    return done.stdout


def step(name: str, work):
    """Do it, and say how long it took."""
    start = time.monotonic()
    result = work()
    print(f"{time.monotonic() - start:6.1f} s  {name}", flush=True)
    return result


if __name__ == "__main__":
    main()
