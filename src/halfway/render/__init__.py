"""Pictures of materials, through Mitsuba 3. Mitsuba itself loads when the first `Renderer` is made."""

from . import pictures
from .renderer import Renderer
from .scenes import SCENES, Scene
from .variant import register

__all__ = ["SCENES", "Renderer", "Scene", "pictures", "register"]
