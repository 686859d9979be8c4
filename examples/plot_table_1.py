"""
How many components a library has
=================================

The paper's Table I: the error that is left when materials are rebuilt from k components. Analytic fits have fewer dimensions than measurements.
"""

import matplotlib.pyplot as plt

from halfway import Pca, open_library
from halfway.export import Report
from halfway.paper.reported import TABLE_1

figure, ax = plt.subplots(figsize=(8, 4), layout="constrained")
for name, colour in (("builtin:merl-abc", "#2f6dc8"), ("builtin:merl-sgd", "#3d8a4e")):
    library = open_library(name)
    report = Report.of(library, Pca.fit(library), n_components=range(1, 61))
    errors = [row.mean_relative_error for row in report.table_1]
    ax.semilogy(range(1, 61), errors, color=colour, label=f"{name} (analytic fits)")
ax.semilogy(list(TABLE_1), list(TABLE_1.values()), "o", color="#c8442f", label="MERL, the paper")
ax.set(xlabel="components", ylabel="mean relative error")
ax.legend()
