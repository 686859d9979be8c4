"""The paper's experiment, whole: every table and figure on any library, ours beside its numbers.

reproduce(folder, library)      pictures, page.md, page.html and paper.json
"""

from .experiment import Experiment, RunFound
from .reproduction import Reproduction, reproduce

__all__ = ["Experiment", "Reproduction", "RunFound", "reproduce"]
