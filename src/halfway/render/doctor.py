"""What rendering found on this machine, and what each missing thing costs."""

import subprocess
import sys
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec

from .denoise import denoiser_available
from .llvm import OLDEST_LLVM, find_llvm, llvm_advice
from .variant import FALLBACK, gpu_lacks

_TRIAL = f"""
from halfway.render.variant import load_mitsuba
mi = load_mitsuba()
if mi.variant() == {FALLBACK!r}: raise SystemExit("neither a GPU nor LLVM compiles")
camera = {{"type": "perspective", "film": {{"type": "hdrfilm", "width": 2, "height": 2}}}}
parts = {{"shape": {{"type": "sphere"}}, "light": {{"type": "constant"}}, "camera": camera}}
scene = mi.load_dict({{"type": "scene", "integrator": {{"type": "path"}}, **parts}})
assert mi.render(scene, spp=1).shape == (2, 2, 3)
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
    needed: bool = False
    """Whether pictures of the tables themselves need it."""


def doctor() -> list[Finding]:
    """What rendering found: Mitsuba, GPU, LLVM, a variant that renders, the denoiser, the video writer.

    The variant is tried in a process of its own, which an unfit LLVM may abort.
    """
    llvm = find_llvm()
    gpu, lacks = _gpu()
    variant, reason = _rendering_variant()
    return [
        Finding("Mitsuba", _version("mitsuba"), "No pictures. Run pip install mitsuba.", True),
        Finding("GPU", gpu, f"Pictures come from the CPU: {lacks}."),
        Finding(
            "LLVM",
            None if llvm is None else str(llvm),
            f"No pictures from the CPU but of files within some 50 dB of the tables. {llvm_advice()} ({OLDEST_LLVM} or later).",
        ),
        Finding("variant", variant, f"No picture of a table itself: {reason}.", True),
        Finding(
            "denoiser",
            _version("mitsuba-oidn") if denoiser_available() else None,
            "Pictures keep their noise. Run pip install mitsuba-oidn.",
        ),
        Finding(
            "video writer",
            _version("av") if find_spec("av") else None,
            "No .mp4; .webp and .gif work. Run pip install av.",
        ),
    ]


def _version(package: str) -> str | None:
    try:
        return f"{package} {version(package)}"
    except PackageNotFoundError:
        return None


def _gpu() -> tuple[str | None, str | None]:
    """The GPU, or what it lacks."""
    lacks = gpu_lacks()
    if lacks is not None:
        return None, lacks
    import drjit

    capability = drjit.detail.cuda_compute_capability()
    cuda = ".".join(map(str, drjit.detail.cuda_version()))
    return f"CUDA {cuda}, compute capability {capability / 10}", None


def _rendering_variant() -> tuple[str | None, str | None]:
    """The variant that rendered, or why none did: the last line of what it said."""
    try:
        trial = subprocess.run(
            [sys.executable, "-c", _TRIAL], capture_output=True, text=True, timeout=120, check=False
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        return None, str(error)
    if trial.returncode == 0:
        return trial.stdout.strip(), None
    last = (trial.stderr.strip() or f"it ended with {trial.returncode}").splitlines()[-1]
    return None, last.rpartition("RenderError: ")[2].rstrip(".")
