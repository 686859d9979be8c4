"""How well spaces move between materials, and how well they place one that they do not have."""

from .evaluation import Bench, Evaluation, evaluate, sample_pairs, uniform
from .leave_one_out import AnchoredPlace, LeaveOneOut, PaperPlace, leave_one_out

__all__ = [
    "AnchoredPlace",
    "Bench",
    "Evaluation",
    "LeaveOneOut",
    "PaperPlace",
    "evaluate",
    "leave_one_out",
    "sample_pairs",
    "uniform",
]
