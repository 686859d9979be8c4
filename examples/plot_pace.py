"""
Equal visible steps
===================

The same way twice. At uniform pace, the paper's, some steps cannot be seen and some leap; at perceptual pace all look alike.
"""

import matplotlib.pyplot as plt
import numpy as np

from halfway import Route, open_library
from halfway.look import Looks
from halfway.look.appearance import appearance, ciede2000_difference
from halfway.recipes import Blend
from halfway.space import make_space, perceptual

library = open_library("builtin:merl-abc")
images = Looks.fit(library)
uniform = Route.through(make_space("paper", library), ["cherry-235", "tungsten-carbide"])

figure, ax = plt.subplots(figsize=(8, 3.5), layout="constrained")
for route, colour in ((uniform, "#c8442f"), (perceptual(uniform, images), "#2f6dc8")):
    looks = appearance(images.mix(route.at(np.linspace(0, 1, 51)), Blend.LINEAR))
    steps = ciede2000_difference(looks[1:], looks[:-1])
    ax.step(range(50), steps, where="mid", color=colour, label=f"{route.pace} pace")
ax.set(xlabel="step", ylabel="visible difference (CIEDE2000)", ylim=(0, None))
ax.legend()
