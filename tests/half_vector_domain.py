"""Where Mitsuba's chi-square test can see a highlight.

Its own domain is the sphere: the lobe of a mirror-like table, a tenth of a degree wide, falls between the points of the
quadrature there, or on one of them alone (looking straight down, the pole), and the "integral" of a right density comes
out as anything from .98 to 14. By half vectors, square-root spaced as the tables are, the same densities integrate to 1
and the test passes at its usual resolution.
"""

import numpy as np

from halfway.render.variant import load_mitsuba

mi = load_mitsuba()

import drjit as dr  # noqa: E402 (it loads LLVM, which is chosen above)


class HalfVectorDomain:
    """Directions to the light by the half vector with a fixed view: square-root spaced theta_h, phi_h.

    Highlights fill cells here, whatever the view; mirrors would fall between the cells of a sphere.
    """

    def __init__(self, view_degrees: float) -> None:
        theta = float(np.radians(view_degrees))
        self.wo = mi.Vector3f(0, float(np.sin(theta)), float(np.cos(theta)))

    def bounds(self):
        return mi.ScalarBoundingBox2f([0, -dr.pi], [1, dr.pi])

    def aspect(self):
        return 1

    def map_forward(self, p):
        sin_theta, cos_theta = dr.sincos(dr.pi / 2 * p.x * p.x)
        sin_phi, cos_phi = dr.sincos(p.y)
        h = mi.Vector3f(cos_phi * sin_theta, sin_phi * sin_theta, cos_theta)
        return 2 * dr.dot(h, self.wo) * h - self.wo

    def map_backward(self, wi):
        h = self._h(wi)
        theta = dr.atan2(dr.sqrt(h.x * h.x + h.y * h.y), h.z)
        return mi.Vector2f(dr.sqrt(theta * 2 / dr.pi), dr.atan2(h.y, h.x))

    def measure(self, wi):
        """Solid angle of wi per area of the domain: 4 (wo . h) sin(theta_h) pi u."""
        h = self._h(wi)
        u = self.map_backward(wi).x
        return 4 * dr.maximum(dr.dot(h, self.wo), 0) * dr.sqrt(h.x * h.x + h.y * h.y) * dr.pi * u

    def _h(self, wi):
        h = dr.normalize(wi + self.wo)
        return dr.select(h.z < 0, -h, h)
