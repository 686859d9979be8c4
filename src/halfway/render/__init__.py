"""Pictures of materials, through Mitsuba 3. Mitsuba itself loads when the first `Renderer` is made."""

from . import pictures
from .basis import BasisPictures
from .denoise import denoiser_available
from .doctor import Finding, doctor
from .fits import fit_sheet
from .frames import Frame, write_frames
from .renderer import QUALITY, Renderer, open_environment
from .scenes import SCENES, Scene
from .sheets import in_rows, write_pictures
from .studio import studio
from .variant import register
from .verb import picture

__all__ = [
    "QUALITY",
    "SCENES",
    "BasisPictures",
    "Finding",
    "Frame",
    "Renderer",
    "Scene",
    "denoiser_available",
    "doctor",
    "fit_sheet",
    "in_rows",
    "open_environment",
    "picture",
    "pictures",
    "register",
    "studio",
    "write_frames",
    "write_pictures",
]
