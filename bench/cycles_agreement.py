#!/usr/bin/env python3
"""Whether Cycles' guided images agree with its unguided ones: z-tests of the means of blocks of 8 x 8 pixels.

    bench/cycles_agreement.py CYCLES SCENE... --guide FOLDER [--spp 16] [--seeds 16]

CYCLES, SCENE and FOLDER as for bench/in_cycles.py. Each seed is one image with the guide and one without; what is
printed: block_agreement.py.
"""
import argparse
import os
import pathlib
import sys
import tempfile

import numpy as np
from block_agreement import blocks, print_head, report
from in_cycles import Program, read


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cycles")
    parser.add_argument("scenes", nargs="+", type=pathlib.Path)
    parser.add_argument("--guide", required=True, metavar="FOLDER")
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--seeds", type=int, default=16)
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    args = parser.parse_args()
    program = Program(args.cycles, args.threads, args.guide)
    print_head()
    with tempfile.TemporaryDirectory() as folder:
        image = pathlib.Path(folder) / "image.exr"

        def blocks_of(scene, seed, guide):
            program.render(scene, args.spp, seed, guide, image)
            return blocks(read(image))

        for scene in args.scenes:
            guided = np.array([blocks_of(scene, i, args.guide) for i in range(args.seeds)])
            unguided = np.array([blocks_of(scene, 100_000 + i, None) for i in range(args.seeds)])
            report(scene.name, guided, unguided)
    return 0


if __name__ == "__main__":
    sys.exit(main())
