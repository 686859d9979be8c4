"""The yardstick: one benchmark of how materials are reconstructed, recovered, mixed and compared."""

from .benchmark import benchmark
from .neural_process import NeuralProcess
from .page import write_page
from .reconstruction import RECONSTRUCTIONS
from .results import Benchmark, Result
from .scores import MEASURES
from .sparse import RECOVERIES, RecoveryMethod, Sampling

__all__ = [
    "MEASURES",
    "RECONSTRUCTIONS",
    "RECOVERIES",
    "Benchmark",
    "NeuralProcess",
    "RecoveryMethod",
    "Result",
    "Sampling",
    "benchmark",
    "write_page",
]
