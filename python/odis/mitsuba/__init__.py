"""The integrator `odis` for Mitsuba 3: path tracing that is guided by what its first samples saw. docs/mitsuba.md.

    import mitsuba as mi
    mi.set_variant("llvm_ad_rgb")
    import odis.mitsuba

    scene = mi.load_file("scene.xml")
    image = mi.render(scene, integrator=odis.mitsuba.guide(scene), spp=16)

Importing it registers the integrator for the variants of Mitsuba that it works in, also those that are set later.
"""

try:
    import mitsuba as mi
except ModuleNotFoundError as missing:
    if missing.name != "mitsuba":
        raise
    raise ModuleNotFoundError('Mitsuba is missing, which odis.mitsuba needs: `pip install "mitsuba>=3.9"` installs it',
                              name="mitsuba") from None

from . import version

version.check(mi.__version__)

from .from_scene import guide  # noqa: E402
from .progress import ProgressLine

__all__ = ["ProgressLine", "guide"]

_registered = set()


def _register(*_):
    variant = mi.variant()
    if variant is None or variant in _registered:
        return
    from .integrator import make_integrator
    mi.register_integrator("odis", make_integrator())
    _registered.add(variant)


_register()
mi.detail.add_variant_callback(_register)
