"""
Equal visible steps
===================

The same way twice. At uniform pace, the paper's, some steps cannot be seen and some leap; at perceptual pace all look alike.
"""

import matplotlib.pyplot as plt
import numpy as np

import halfway
from halfway.look import Looks, appearance, ciede2000_difference

library = halfway.open_library("builtin:merl-abc")
looks = Looks.fit(library)

figure, ax = plt.subplots(figsize=(8, 3.5), layout="constrained")
for pace, colour in (("uniform", "#c8442f"), ("perceptual", "#2f6dc8")):
    route = halfway.route(library, "cherry-235", "tungsten-carbide", space="paper", pace=pace)
    seen = appearance(looks.mix(route.at(np.linspace(0, 1, 51)), route.blend))
    steps = ciede2000_difference(seen[1:], seen[:-1])
    ax.step(range(50), steps, where="mid", color=colour, label=f"{pace} pace")
ax.set(xlabel="step", ylabel="visible difference (CIEDE2000)", ylim=(0, None))
ax.legend()
