"""Sets of new materials to train on: drawn evenly, split by parents, with what they are said beside them."""

from .diversity import Diversity
from .lists import listed
from .sampling import sample
from .sets import Sample, SampleSet
from .writing import write_set

__all__ = [
    "Diversity",
    "Sample",
    "SampleSet",
    "listed",
    "sample",
    "write_set",
]
