"""AOVs (depth, normals, albedo and the like) beside the image, rendered by Mitsuba's integrator `aov`."""

import re

import drjit as dr
import mitsuba as mi
import numpy as np

# So many samples are traced at once at most.
SAMPLES = 1 << 24
# The types that Mitsuba's `aov` has, and the ends of their channels' names.
TYPES = {"albedo": "RGB", "depth": "T", "position": "XYZ", "uv": "UV", "geo_normal": "XYZ", "sh_normal": "XYZ",
         "dp_du": "XYZ", "dp_dv": "XYZ", "duv_dx": "UV", "duv_dy": "UV", "prim_index": "I", "shape_index": "I"}


def check_aovs(text):
    """Raises ValueError unless a text is what Mitsuba's `aov` expects, which crashes at some others."""
    channels = set()
    for word in re.split("[, ]+", text.strip(", ")):
        parts = [part for part in word.split(":") if part]
        if len(parts) < 2 or parts[1] not in TYPES:
            raise ValueError("odis: aovs: expected NAME:TYPE with commas between them, as in dd:depth,nn:sh_normal, "
                             f"found {word or 'nothing'}; the types are {', '.join(TYPES)}")
        added = {f"{parts[0]}.{channel}" for channel in TYPES[parts[1]]}
        if channels & added:
            raise ValueError(f"odis: aovs: expected names that differ, found {parts[0]} twice")
        channels |= added


def nested_integrators(integrator):
    """The integrators that one of Mitsuba's `aov` or `moment` holds."""

    class Collector(mi.TraversalCallback):
        def __init__(self):
            super().__init__()
            self.found = []

        def put(self, _name, node, _flags):
            if isinstance(node, mi.Integrator):
                self.found.append(node)

        put_object = put_value = put

    collector = Collector()
    integrator.traverse(collector)
    return collector.found


def make_aovs(integrator):
    """The AOVs of an integrator `aov`, without the images of those nested in it."""
    nested = nested_integrators(integrator)
    first = sum(4 + len(one.aov_names()) for one in nested)  # of each come R, G, B, A and its own AOVs

    class Aovs(mi.SamplingIntegrator):
        def aov_names(self):
            return integrator.aov_names()[first:]

        def sample(self, scene, sampler, ray, medium=None, active=True):
            # What the nested integrators trace is not used, so Dr.Jit leaves it out of the kernel.
            _, valid, values = integrator.sample(scene, sampler, ray, medium, active)
            return mi.Spectrum(0), valid, values[first:]

        def image(self, scene, sensor, seed, spp):
            """Means over spp samples of each pixel, weighed by the film's filter: [height, width, channel], numpy."""
            width, height = sensor.film().crop_size()
            most = max(1, SAMPLES // (width * height))
            total = 0
            for begin in range(0, spp, most):
                count = min(most, spp - begin)
                part_seed = mi.UInt32(mi.sample_tea_32(mi.UInt32(seed), mi.UInt32(begin))[0])
                part = np.array(self.render(scene, sensor, part_seed, count))
                if self.should_stop():
                    raise KeyboardInterrupt
                total = total + part[..., part.shape[2] - len(self.aov_names()):] * np.float32(count / spp)
            dr.sync_thread()
            return total

    return Aovs(mi.Properties())
