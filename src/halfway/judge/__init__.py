"""How well spaces move between materials, and how well they place one that they do not have."""

from .comparison import compare_spaces
from .evaluation import Bench, Evaluation, evaluate, sample_pairs, uniform
from .highlight import Highlight, highlight
from .ladders import LadderErrors, ladder_errors, ladders
from .leave_one_out import LeaveOneOut, leave_one_out

__all__ = [
    "Bench",
    "Evaluation",
    "Highlight",
    "LadderErrors",
    "LeaveOneOut",
    "compare_spaces",
    "evaluate",
    "highlight",
    "ladder_errors",
    "ladders",
    "leave_one_out",
    "sample_pairs",
    "uniform",
]
