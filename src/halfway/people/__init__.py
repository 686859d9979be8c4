"""What people say of materials: how they perceive one, and how alike they find two."""

from .perceived import Perceived, Perception
from .similarity import distances, features

__all__ = ["Perceived", "Perception", "distances", "features"]
