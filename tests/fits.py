"""Fits to write, and names that are hard to write."""

import numpy as np

from halfway.brdf.quality import Quality
from halfway.fit import Fit, OpenPbr
from halfway.fit.model import AnalyticModel

OPENPBR = OpenPbr(
    np.array([0.12345, 0.5, 0.25]), 0.3, 0.25, np.array([1, 0.9, 0.8]), 0.33333, 1.75, 0.5, 0.25
)  # fmt: skip
NAMES = ["gold-paint", "my_gold", "001", "3M tape (v2)", "0_5", "-1", "金属", "銀", "é", "e\u0301", "", "_", "__", "a b", "a.b", "a:b", "a/b", "class",
         "float", "Materials", "surface", "x" * 300, "line\nbreak", "\x1b[31m", "&<>\"'", "\udc80"]  # fmt: skip


def a_fit(model: AnalyticModel, name: str = "gold-paint 2") -> Fit:
    return Fit(name, model, 0.01, Quality(40.0, 0.02), 0.003)
