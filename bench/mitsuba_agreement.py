#!/usr/bin/env python3
"""Whether Mitsuba's integrator `odis` agrees with `path`: z-tests of the means of blocks of 8 x 8 pixels.

    bench/mitsuba_agreement.py SCENE.xml... [--pixels 10800] [--spp 64] [--seeds 16] [--max-depth 13]

Needs `pip install ".[mitsuba]"`. Each seed is one rendering by each integrator; what is printed: block_agreement.py.
"""
import argparse
import os
import sys

import mitsuba as mi
import numpy as np
from block_agreement import blocks, print_head, report


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--variant", default="llvm_ad_rgb")
    parser.add_argument("--pixels", type=int, default=10800)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--seeds", type=int, default=16)
    parser.add_argument("--max-depth", type=int, default=13)
    args = parser.parse_args()
    mi.set_variant(args.variant)
    mi.set_log_level(mi.LogLevel.Error)
    import odis.mitsuba  # noqa: F401, registers the integrator
    from odis.mitsuba.scene_files import load_file
    print_head()
    for path in args.scenes:
        # Without a box filter the two integrators differ at the image's border.
        scene = load_file(path, pixels=args.pixels, rfilter="box")
        images = []
        for kind, first in (("odis", 0), ("path", 100_000)):
            integrator = mi.load_dict({"type": kind, "max_depth": args.max_depth})
            images.append(np.array([blocks(mi.render(scene, integrator=integrator, spp=args.spp, seed=first + i))
                                    for i in range(args.seeds)]))
        report(os.path.basename(os.path.dirname(os.path.abspath(path))), *images)
    return 0


if __name__ == "__main__":
    sys.exit(main())
