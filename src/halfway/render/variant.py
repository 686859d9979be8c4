"""Which Mitsuba to run: on the GPU, on the CPU, or ray by ray where nothing compiles.

A variant of Mitsuba is a device and a way to carry colour. What is compiled runs on an NVIDIA card (``cuda_ad_rgb``) or through
LLVM on the CPU (``llvm_ad_rgb``). Once a program has set one it stays: what was made in one variant does not fit another.
"""

import ctypes
import importlib
import os
import re
import sys
from typing import Any, Literal, get_args

from ..errors import RenderError
from .interrupts import interrupts_wait
from .llvm import OLDEST_LLVM, choose_llvm, find_llvm, llvm_advice, require_llvm

Device = Literal["auto", "cpu", "gpu"]
"""Where to render; ``auto`` is the GPU where there is one that works."""
VARIANTS = {"gpu": "cuda_ad_rgb", "cpu": "llvm_ad_rgb"}
FALLBACK = "scalar_rgb"
"""Without GPU and LLVM: Mitsuba's own ``measured`` shows files that stand for the tables."""

_DRIVER = {
    "linux": {"DRJIT_LIBCUDA_PATH": "libcuda.so.1", "DRJIT_LIBOPTIX_PATH": "libnvoptix.so.1"},
    "win32": {"DRJIT_LIBCUDA_PATH": "nvcuda.dll", "DRJIT_LIBOPTIX_PATH": "nvoptix.dll"},
}
"""The driver's libraries that Dr.Jit loads, each by the variable that may name another."""


@interrupts_wait()
def load_mitsuba(device: Device = "auto") -> Any:
    """The ``mitsuba`` module with a variant set: the program's own choice, else the fitting one of ``device``.

    Where Mitsuba is imported here, its warnings go to stderr.

    Raises
    ------
    RenderError
        When there is no Mitsuba, the device cannot be had or is not that of the variant which is set, or the LLVM library
        is one that fails or aborts.
    """
    if device not in get_args(Device):
        raise RenderError(f"there is no device {device!r}: expected auto, cpu or gpu.")
    imported = sys.modules.get("mitsuba")
    if imported is None:
        choose_llvm()
    variant = (imported and imported.variant()) or _fitting(device)
    _require_device(variant, device)
    if variant.startswith("llvm"):
        require_llvm()
    mi = _import("mitsuba")
    if imported is None:
        _warn_on_stderr(mi)
    if mi.variant() is None:
        mi.set_variant(variant)
    return mi


def gpu_lacks() -> str | None:
    """What keeps Mitsuba from rendering on a GPU here; None where nothing does."""
    for variable, name in _DRIVER.get(sys.platform, {}).items():
        try:
            ctypes.CDLL(os.environ.get(variable, name))
        except OSError:
            return f"{name}, a part of NVIDIA's driver, is not here"
    if sys.platform not in _DRIVER:
        return f"Mitsuba has none for {sys.platform}"
    drjit: Any = _import("drjit")
    if not drjit.has_backend(drjit.JitBackend.CUDA):
        return "Dr.Jit cannot use the card or its driver"
    return None


def compiles(variant: str) -> bool:
    """Whether tables can be looked up in this variant: many rays at once, and no polarization, which no table has."""
    return re.fullmatch(r"(llvm|cuda)_ad_(rgb|mono|spectral)", variant) is not None


def register(device: Device = "auto") -> None:
    """Make ``halfway_table`` known to Mitsuba, for scenes given as dicts or XML, in every variant that can look up tables.

    These are ``llvm_ad`` and ``cuda_ad`` variants: rgb, mono and spectral. One is set where none is; where another is set
    later, the table is known there too.

    Raises
    ------
    RenderError
        In another variant, or where nothing compiles.

    Examples
    --------
    >>> import halfway.render
    >>> halfway.render.register()
    >>> import mitsuba as mi
    >>> bsdf = mi.load_dict({"type": "halfway_table", "recipe": "gold-paint=0.7, teflon=0.3"})
    """
    mi = load_mitsuba(device)
    require_tables(mi.variant())
    _register_in(None, mi.variant())
    mi.detail.add_variant_callback(_register_in)  # a set: once more is the same


def require_tables(variant: str) -> None:
    """Refuse a variant in which a measured table cannot be looked up, and say which can."""
    if not compiles(variant):
        raise RenderError(
            f"the Mitsuba variant {variant} cannot look up tables: expected one that compiles, such as {VARIANTS['cpu']}, "
            f"and no polarization. Call mi.set_variant({VARIANTS['cpu']!r}) first; it needs LLVM {OLDEST_LLVM} or later. "
            f"{llvm_advice()}."
        )


@interrupts_wait()
def _register_in(_: str | None, variant: str) -> None:
    """Register the table in the variant that is set now; `mitsuba.BSDF` is another class in each."""
    if not compiles(variant):
        return
    import mitsuba as mi

    from . import bsdf

    if variant != bsdf.VARIANT:
        importlib.reload(bsdf)
    mi.register_bsdf("halfway_table", bsdf.TableBsdf)


def _fitting(device: Device) -> str:
    lacks = None if device == "cpu" else gpu_lacks()
    if device != "cpu" and lacks is None:
        return VARIANTS["gpu"]
    if device == "gpu":
        raise RenderError(f"there is no GPU to render on: {lacks}. Use --device cpu, or auto.")
    # A Mitsuba that was imported before has looked for an LLVM itself.
    return VARIANTS["cpu"] if find_llvm() or "mitsuba" in sys.modules else FALLBACK


def _require_device(variant: str, device: Device) -> None:
    if device != "auto" and variant.startswith("cuda") != (device == "gpu"):
        raise RenderError(
            f"Mitsuba's variant {variant}, which is set, does not run on the {device}: expected {VARIANTS[device]}. "
            "Ask for that device before anything is rendered."
        )


def _import(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        raise RenderError(
            f"{name} cannot be imported ({error}): rendering needs it. Run pip install mitsuba."
        ) from error
    except (ImportError, NameError) as error:
        cause = (
            error.__context__ or error
        )  # Dr.Jit goes on after its first error, and into a second
        raise RenderError(
            f"{name} cannot be imported ({cause}): rendering needs it. Install the library that it names; "
            "for libatomic on Debian, apt install libatomic1."
        ) from error


def _warn_on_stderr(mi: Any) -> None:
    """Mitsuba logs to stdout, which is for data."""

    class Stderr(mi.Appender):
        def append(self, _: Any, text: str) -> None:
            print(text, file=sys.stderr)

        def log_progress(self, *_: Any) -> None:
            pass

    logger = mi.logger()
    logger.clear_appenders()
    logger.add_appender(Stderr())
