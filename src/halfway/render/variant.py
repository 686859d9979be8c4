"""Which Mitsuba to run: the LLVM library, the variant, and what was found.

Dr.Jit compiles through libLLVM, which it takes from ``DRJIT_LIBLLVM_PATH`` or from the system. LLVM 15 and 16 load and
then abort the whole process at the first render ("Cannot select: fminimum"), which nothing can catch. So the library is
chosen here, before Mitsuba is imported: the one the user set, else the one of ``karellen-llvm-core`` in this environment,
else the newest on the system that is known to work.
"""

import importlib
import importlib.metadata
import os
import re
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import RenderError

VARIANT = "llvm_ad_rgb"
FALLBACK = "scalar_rgb"
"""Without LLVM: Mitsuba's own ``measured`` shows files that stand for the tables."""
OLDEST_LLVM = 19
"""Dr.Jit refuses 14; 15 and 16 abort the process; 19 and later are known to work."""
ABORTING_LLVM = 15, 16

_PATH_VARIABLE = "DRJIT_LIBLLVM_PATH"
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
        """Whether the version is one that renders; what the user chose is taken at their word."""
        return self.origin == "set by the user" or (self.version or 0) >= OLDEST_LLVM

    def __str__(self) -> str:
        return f"LLVM {self.version or '?'} ({self.origin}: {self.path})"


def find_llvm() -> Llvm | None:
    """The libLLVM to use, or None: the user's own, the environment's, the newest of the system that works."""
    if chosen := os.environ.get(_PATH_VARIABLE):
        return Llvm(Path(chosen), _version(Path(chosen)), "set by the user")
    usable = (llvm for llvm in (*_in_environment(), *_on_system()) if llvm.works)
    return next(usable, None)


def load_mitsuba() -> Any:
    """The ``mitsuba`` module with a variant set: the program's own choice, else `VARIANT`, else `FALLBACK` without LLVM.

    Raises
    ------
    RenderError
        When there is no Mitsuba, ``DRJIT_LIBLLVM_PATH`` names no file, or the program imported Mitsuba before and that
        found an LLVM which would abort the process.
    """
    fitting = VARIANT
    imported = "mitsuba" in sys.modules
    if not imported:
        fitting = VARIANT if _choose_llvm() else FALLBACK
    mi = _import_mitsuba()
    if imported and (mi.variant() or fitting).startswith("llvm"):
        _refuse_unfit_llvm()
    if mi.variant() is None:
        mi.set_variant(fitting)
    return mi


def aborting(maps: Iterable[str]) -> Llvm | None:
    """The library that will abort the process, if one is among those mapped into it (lines of ``/proc/self/maps``)."""
    loaded = (Path(line.split()[-1]) for line in maps if "libLLVM" in line)
    found = (Llvm(path, _version(path), "loaded by Mitsuba") for path in loaded)
    return next((llvm for llvm in found if llvm.version in ABORTING_LLVM), None)


def compiles(variant: str) -> bool:
    """Whether tables can be looked up in this variant: many rays at once, and no polarization, which no table has."""
    return re.fullmatch(r"(llvm|cuda)_ad_(rgb|mono|spectral)", variant) is not None


def register() -> None:
    """Make ``halfway_table`` known to Mitsuba, in the variant that is set, for scenes given as dicts or XML.

    Tables work in ``llvm_ad`` and ``cuda_ad`` variants: rgb, mono and spectral; one is set where none is.

    Raises
    ------
    RenderError
        In another variant, or without an LLVM library.

    Examples
    --------
    >>> import halfway.render                                                       # doctest: +SKIP
    >>> halfway.render.register()                                                   # doctest: +SKIP
    >>> import mitsuba as mi                                                        # doctest: +SKIP
    >>> mi.load_dict({"type": "halfway_table", "filename": "gold-paint.binary"})    # doctest: +SKIP
    """
    mi = load_mitsuba()
    require_tables(mi.variant())
    from . import bsdf

    if mi.variant() != bsdf.VARIANT:
        importlib.reload(bsdf)
    mi.register_bsdf("halfway_table", bsdf.TableBsdf)


def require_tables(variant: str) -> None:
    """Refuse a variant in which a measured table cannot be looked up.

    Raises
    ------
    RenderError
        Says which variants can, and what they need.
    """
    if not compiles(variant):
        raise RenderError(
            f"the Mitsuba variant {variant} cannot look up tables: expected one that compiles, such as {VARIANT}, and no "
            f"polarization. "
            f"Call mi.set_variant({VARIANT!r}) first; it needs LLVM {OLDEST_LLVM} or later. {llvm_advice()}."
        )


def _choose_llvm() -> bool:
    """Whether there is an LLVM library for Dr.Jit to load; it is told which."""
    llvm = find_llvm()
    if llvm is None:
        return False
    if not llvm.path.is_file():
        raise RenderError(
            f"{_PATH_VARIABLE} names {llvm.path}, which is no file: expected an LLVM library. "
            "Correct it, or unset it to have one chosen."
        )
    os.environ[_PATH_VARIABLE] = str(llvm.path)
    return True


def _refuse_unfit_llvm() -> None:
    maps = Path("/proc/self/maps")  # only Linux tells what is loaded
    llvm = aborting(maps.read_text().splitlines() if maps.exists() else [])
    if llvm:
        raise RenderError(
            f"{llvm} aborts the process at the first render: expected {OLDEST_LLVM} or later. "
            "Call halfway.render.register() before Mitsuba is imported, which chooses one that works."
        )


def _import_mitsuba() -> Any:
    try:
        import mitsuba
    except ImportError as error:
        raise RenderError(
            f"mitsuba cannot be imported ({error}): rendering needs it. Run pip install mitsuba."
        ) from error
    return mitsuba


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
        if file.name in ("libLLVM.so", "libLLVM.dylib"):
            path = Path(str(file.locate())).resolve()
            yield Llvm(path, int(version.split(".")[0]), "karellen-llvm-core")


def _on_system() -> list[Llvm]:
    paths = [
        path
        for pattern in _SYSTEM_LIBRARIES.get(sys.platform, ())
        for path in Path("/").glob(pattern.lstrip("/"))
    ]
    found = [Llvm(path, _version(path), "system") for path in paths]
    return sorted(found, key=lambda llvm: (llvm.version or 0, str(llvm.path)), reverse=True)


def _version(path: Path) -> int | None:
    resolved = str(path.resolve())
    match = re.search(r"libLLVM(?:\.so\.|-)(\d+)|llvm[-/](\d+)", resolved)
    return int(match[1] or match[2]) if match else None
