"""Principal components of a library, all that makes them, and compact libraries made of them."""

from .compacting import compact_library
from .mapped import MappedRows
from .newcomer import Newcomer
from .pca import Pca
from .plan import PcaPlan

__all__ = ["MappedRows", "Newcomer", "Pca", "PcaPlan", "compact_library"]
