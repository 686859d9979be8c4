"""The paper's experiment, whole: every table and figure on any library, ours beside its numbers.

reproduce(folder, library)      pictures, page.md, page.html and paper.json
demonstrate(folder, library)    its main run alone, with pictures
"""

from .demo import NEW_MATERIALS, demonstrate
from .experiment import Experiment, MeasuredRun
from .reproduction import Reproduction, reproduce

__all__ = [
    "NEW_MATERIALS",
    "Experiment",
    "MeasuredRun",
    "Reproduction",
    "demonstrate",
    "reproduce",
]
