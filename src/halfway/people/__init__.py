"""What people say of materials: how they perceive one, and how alike they find two."""

from .perceived import Perceived, Perception, read_library
from .quality import QUALITIES
from .similarity import Impressions, apart, distances, features

__all__ = [
    "QUALITIES",
    "Impressions",
    "Perceived",
    "Perception",
    "apart",
    "distances",
    "features",
    "read_library",
]
