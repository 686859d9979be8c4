"""The LLVM library that Dr.Jit compiles through on the CPU.

Dr.Jit takes it from ``DRJIT_LIBLLVM_PATH`` or from the system. It refuses 14 and earlier; 15 and 16 load and then abort the
whole process at the first render ("Cannot select: fminimum"), which nothing can catch. So the library is chosen here, before
Mitsuba is imported: the one the user set, else the one of ``karellen-llvm-core`` in this environment, else the newest on the
system that is known to work.
"""

import importlib.metadata
import os
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from ..errors import RenderError

OLDEST_LLVM = 19
"""Known to work, as later ones are."""

_PATH_VARIABLE = "DRJIT_LIBLLVM_PATH"
_OWN = f"set by {_PATH_VARIABLE}"
_SYSTEM_LIBRARIES = {
    "linux": ("/usr/lib/*/libLLVM*.so*", "/usr/lib/llvm-*/lib/libLLVM*.so*", "/usr/lib64/libLLVM*.so*"),
    "darwin": ("/opt/homebrew/Cellar/llvm/*/lib/libLLVM.dylib", "/usr/local/Cellar/llvm/*/lib/libLLVM.dylib"),
    "win32": (),
}  # fmt: skip


@dataclass(frozen=True)
class Llvm:
    """A libLLVM and how it was found."""

    path: Path
    version: int | None
    """Major version; None where the name does not tell."""
    origin: str

    @property
    def works(self) -> bool:
        """Whether the version is known to be one that renders."""
        return (self.version or 0) >= OLDEST_LLVM

    def __str__(self) -> str:
        return f"LLVM {self.version or '?'} ({self.origin}: {self.path})"


def find_llvm() -> Llvm | None:
    """The libLLVM to use, or None: the user's own, the environment's, the newest of the system that works."""
    if chosen := os.environ.get(_PATH_VARIABLE):
        return Llvm(Path(chosen), _version(Path(chosen)), _OWN)
    usable = (llvm for llvm in (*_in_environment(), *_on_system()) if llvm.works)
    return next(usable, None)


def choose_llvm() -> None:
    """Tell Dr.Jit, which is not imported yet, which library to take."""
    llvm = find_llvm()
    if llvm is not None:
        os.environ[_PATH_VARIABLE] = str(llvm.path)


def require_llvm() -> None:
    """Refuse to compile through a library that cannot: the user's own, or the one of a Mitsuba that was imported before."""
    llvm = find_llvm()
    own = llvm if llvm is not None and llvm.origin == _OWN else None
    if own is not None and not own.path.is_file():
        raise RenderError(
            f"{_PATH_VARIABLE} names {own.path}, which is no file: expected an LLVM library. "
            "Correct it, or unset it to have one chosen."
        )
    # Dr.Jit talks on the terminal about one that it refuses: it is asked where the name does not tell.
    version = own.version if own and own.version else _loaded_version()
    if version < OLDEST_LLVM:
        raise RenderError(
            f"{own or f'LLVM {version} (loaded by Mitsuba)'} cannot compile what renders, and may abort: "
            f"expected {OLDEST_LLVM} or later. "
            + (
                f"Unset {_PATH_VARIABLE} to have one chosen."
                if own
                else "Call halfway.render.register() before Mitsuba is imported, which chooses one that works."
            )
        )


def _loaded_version() -> int:
    """Of the library that Dr.Jit has loaded; -1 where it found none that it takes."""
    import drjit

    drjit.has_backend(drjit.JitBackend.LLVM)  # looks for one now
    return drjit.detail.llvm_version()[0]


def llvm_advice() -> str:
    """How to get one that works."""
    match sys.platform:
        case "linux":
            return "Run pip install karellen-llvm-core"
        case "darwin":
            return "Run brew install llvm"
        case _:
            return "Install LLVM from https://releases.llvm.org"


def _in_environment() -> Iterator[Llvm]:
    try:
        files = importlib.metadata.files("karellen-llvm-core") or []
        version = importlib.metadata.version("karellen-llvm-core")
    except importlib.metadata.PackageNotFoundError:
        return
    for file in files:
        # libLLVM.so is a link, made when Python first starts after the installation, where that may write.
        if re.fullmatch(r"libLLVM(\.so[.\d]*|\.dylib)", file.name):
            path = Path(str(file.locate())).resolve()
            yield Llvm(path, int(version.split(".")[0]), "karellen-llvm-core")


def _on_system() -> list[Llvm]:
    paths = [
        path
        for pattern in _SYSTEM_LIBRARIES.get(sys.platform, ())
        for path in Path("/").glob(pattern.lstrip("/"))
    ]
    installed = [Llvm(path, _version(path), "system") for path in paths]
    return sorted(installed, key=lambda llvm: (llvm.version or 0, str(llvm.path)), reverse=True)


def _version(path: Path) -> int | None:
    resolved = str(path.resolve())
    match = re.search(r"libLLVM(?:\.so\.|-)(\d+)|llvm[-/](\d+)", resolved)
    return int(match[1] or match[2]) if match else None
