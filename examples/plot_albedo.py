"""
A mix reflects what its ingredients do
======================================

The albedo is linear in the BRDF, so that of a mix lies between those of its ingredients: it never reflects more than it receives.
"""

import matplotlib.pyplot as plt
import numpy as np

from halfway import directional_albedo, mix, open_library

library = open_library("builtin:merl-abc")
degrees = np.linspace(0, 80, 17)

figure, ax = plt.subplots(figsize=(8, 4), layout="constrained")
for share, colour in ((0.0, "#2f6dc8"), (0.5, "#7d5a9e"), (1.0, "#c8442f")):
    table = mix(library, {"white-marble": 1 - share, "chrome": share})
    green = directional_albedo(table, np.radians(degrees))[:, 1]
    ax.plot(degrees, green, color=colour, label=f"{share:.0%} chrome, {1 - share:.0%} white-marble")
ax.axhline(1, color="#555", lw=0.8)
ax.set(xlabel="light from (degrees)", ylabel="reflected share", ylim=(0, 1.05))
ax.legend()
