"""What people say of materials: how they perceive one, and how alike they find two."""

from .perceived import Perceived, Perception
from .similarity import Impressions, apart, distances, features

__all__ = ["Impressions", "Perceived", "Perception", "apart", "distances", "features"]
