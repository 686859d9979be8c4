"""Principal components of a library, all that makes them, and compact libraries made of them."""

from .compacting import compact_library
from .newcomer import Newcomer
from .pca import Pca
from .plan import PcaPlan

__all__ = ["Newcomer", "Pca", "PcaPlan", "compact_library"]
