"""What people say of materials: how they perceive one, and how alike they find two."""

from .perceived import Perceived, Perception

__all__ = ["Perceived", "Perception"]
