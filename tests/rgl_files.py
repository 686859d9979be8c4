"""RGL materials made by hand, and what Mitsuba's own reader makes of them."""

import numpy as np

UP = np.array([0.0, 0.0, 1.0])


def directions(rng, n):
    """Unit vectors above the horizon, evenly spread in z, exact in float32 as a renderer holds them."""
    z, phi = rng.uniform(0.02, 1, n), rng.uniform(0, 2 * np.pi, n)
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1).astype(np.float32).astype(float)


def viewers(rng, n):
    """As `directions`, in the quarter x, y < 0.

    Mitsuba 3.9's plugin mirrors other viewers of an isotropic material, or not, by a variable that it never sets.
    """
    return np.abs(directions(rng, n)) * [-1, -1, 1]


def fields(rng=None, *, n_phi=1, n_theta=3, phi_range=2 * np.pi, n_colours=3, size=4):
    """A material with all factors 1, or random ones."""

    def nodes(*shape):
        return (
            np.ones(shape, np.float32)
            if rng is None
            else rng.uniform(0.2, 2, shape).astype(np.float32)
        )

    phi_i = np.zeros(1) if n_phi == 1 else -np.pi + phi_range * np.linspace(0, 1, n_phi)
    return {
        "description": np.frombuffer(b"hand-made", np.uint8),
        "phi_i": phi_i.astype(np.float32),
        "theta_i": np.linspace(0, np.pi / 2, n_theta, dtype=np.float32),
        "ndf": np.repeat(nodes(1, 7), 5, axis=0) if n_phi == 1 else nodes(5, 7),
        "sigma": np.repeat(nodes(1, 7), 5, axis=0) if n_phi == 1 else nodes(5, 7),
        "vndf": nodes(n_phi, n_theta, 6, 8),
        "rgb": nodes(n_phi, n_theta, n_colours, size, size),
        "luminance": nodes(n_phi, n_theta, size, size),
        "jacobian": np.ones(1, np.uint8),
    }


def plugin_values(mi, file, light, viewer, wavelengths=()):
    """Values of f times cosine by the stock plugin; its ``wi`` is the viewer."""
    bsdf = mi.load_dict({"type": "measured", "filename": str(file)})
    si, context = mi.SurfaceInteraction3f(), mi.BSDFContext()
    if wavelengths:
        si.wavelengths = wavelengths
    values = []
    for to_light, to_viewer in zip(light.tolist(), viewer.tolist(), strict=True):
        si.wi = to_viewer
        values.append(list(bsdf.eval(context, si, to_light)))
    return np.array(values)
