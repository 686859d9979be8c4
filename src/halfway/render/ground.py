"""The ground with the shadows of the objects, as a camera sees it that looks through them.

Imported only after `halfway.render.variant.load_mitsuba` has chosen a variant.
"""

from typing import Any

import drjit as dr
import mitsuba as mi


def seen_through(veil: Any) -> Any:
    """The integrator: direct light on whatever is behind the objects that wear the BSDF ``veil``."""

    class SeenThrough(mi.SamplingIntegrator):
        def sample(
            self, scene: Any, sampler: Any, ray: Any, medium: Any = None, active: Any = True
        ) -> tuple[Any, Any, list[Any]]:
            del medium
            si = _beyond(scene, mi.Ray3f(ray), active, mi.BSDFPtr(veil))
            active = active & si.is_valid()
            at, weight = scene.sample_emitter_direction(si, sampler.next_2d(active), False, active)
            lit = active & ~scene.ray_test(si.spawn_ray_to(at.p), active)
            f = si.bsdf().eval(mi.BSDFContext(), si, si.to_local(at.d), lit)
            return f * weight & lit, active, []

    return SeenThrough(mi.Properties())


def _beyond(scene: Any, ray: Any, active: Any, veil: Any) -> Any:
    """Where the ray ends, past whatever wears the veil."""

    def veiled(_: Any, si: Any) -> Any:
        return si.is_valid() & (si.bsdf() == veil)

    def onward(ray: Any, si: Any) -> tuple[Any, Any]:
        ray = si.spawn_ray(ray.d)
        return ray, scene.ray_intersect(ray)

    _, si = dr.while_loop((ray, scene.ray_intersect(ray, active)), veiled, onward)
    return si
