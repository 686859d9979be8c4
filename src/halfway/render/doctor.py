"""What rendering found on this machine, and what each missing thing costs."""

import subprocess
import sys
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec

from .denoise import denoiser_available
from .variant import OLDEST_LLVM, VARIANT, find_llvm, llvm_advice

_TRIAL = """
from halfway.render.variant import load_mitsuba
mi = load_mitsuba()
import drjit
if mi.variant() != "scalar_rgb": drjit.eval(drjit.minimum(drjit.arange(mi.Float, 4), 2))
print(mi.variant())
"""


@dataclass(frozen=True)
class Finding:
    """One thing that rendering uses."""

    what: str
    found: str | None
    """What there is, with its version; None where there is none that works."""
    cost: str
    """What its absence costs, and what to do."""


def doctor() -> list[Finding]:
    """What rendering found: Mitsuba, LLVM, a variant that compiles, the denoiser, the video writer.

    The variant is tried in a process of its own, which an unfit LLVM may abort.
    """
    llvm = find_llvm()
    return [
        Finding("Mitsuba", _version("mitsuba"), "No pictures. Run pip install mitsuba."),
        Finding(
            "LLVM",
            None if llvm is None else str(llvm),
            f"Slower pictures, of files within some 50 dB of the tables. {llvm_advice()} ({OLDEST_LLVM} or later).",
        ),
        Finding(
            "variant",
            _compiles(),
            f"Mitsuba's {VARIANT} does not compile with this LLVM, and may abort. Unset DRJIT_LIBLLVM_PATH.",
        ),
        Finding(
            "denoiser",
            _version("mitsuba-oidn") if denoiser_available() else None,
            "Previews and backdrops take some 4 times the samples. Run pip install mitsuba-oidn.",
        ),
        Finding(
            "video writer",
            _version("av") if find_spec("av") else None,
            "No .mp4; .webp and .gif work. Run pip install 'halfway[video]'.",
        ),
    ]


def _version(package: str) -> str | None:
    try:
        return f"{package} {version(package)}"
    except PackageNotFoundError:
        return None


def _compiles() -> str | None:
    """The variant that compiled and ran, or None."""
    try:
        trial = subprocess.run(
            [sys.executable, "-c", _TRIAL], capture_output=True, text=True, timeout=60, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return None
    return trial.stdout.strip() or None if trial.returncode == 0 else None
