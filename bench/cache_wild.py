#!/usr/bin/env python3
"""How wild images with the radiance cache are, beside those of `odis` without it, in scenes that provoke it.

    bench/cache_wild.py -o OUT [--odis BINARY] [--old BINARY] [--scenes pool,ball] [--spp 4,16,64] [--seeds 16]

Prints for each scene and number of samples: the ratio of the trimmed errors of images of the same seed (the largest,
the median), what the largest is for two images of `odis` (luck), that of the untrimmed ones (of the worst images and
of the means), the mean of the images over that of `odis` with how many standard errors it is off, the most pixels of an
image that are far off (over those of `odis`), and the ratio of times. Errors are those of `odis metrics`.
Needs numpy and OpenEXR. What was rendered stays in OUT: images of `odis` and references are made once.
"""

import argparse
import os
import resource
import subprocess

import numpy as np
import OpenEXR

import cache_scenes

REFERENCE_SEED = 1000
FAR_OFF = 10  # the error of a pixel that sparkles


def read(path):
    channels = OpenEXR.File(path, separate_channels=True).channels()
    return np.stack([np.asarray(channels[c].pixels, float) for c in "RGB"], -1)


def errors(image, reference):
    """The error without the worst 0.1 % of the pixels, that of all, and how many pixels are far off."""
    scale = 1 / (reference @ [.2126, .7152, .0722]).mean()
    a, b = image * scale, reference * scale
    each = np.sort(((a - b) ** 2 / (b * b + .01)).mean(-1).ravel())
    return each[:len(each) - max(1, len(each) // 1000)].mean(), each.mean(), (each > FAR_OFF).sum()


def luck(errs):
    """The largest ratio of the errors of images of the same method: each over that of another seed, the median of all
    such pairings."""
    pairings = [(np.roll(errs, shift) / errs).max() for shift in range(1, len(errs))]
    return np.median(pairings) if pairings else np.nan


class Bench:
    def __init__(self, args):
        self.args = args
        self.made = set()  # the images of this run
        cache_scenes.write(os.path.join(args.output, "scenes"))

    def render(self, odis, scene, spp, seed, method):
        """A rendered image and the time that it took, in seconds of the processor."""
        args = self.args
        folder = os.path.join(args.output, f"{scene}-{args.size}-d{args.depth}-rr{args.rr}")
        os.makedirs(folder, exist_ok=True)
        path = os.path.join(folder, f"{method}-{spp}-{seed}")
        if not os.path.exists(path + ".npz") or (method == "new" and path not in self.made):
            self.made.add(path)
            before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
            subprocess.run([odis, "render", os.path.join(args.output, "scenes", scene + ".xml"), "--spp", str(spp),
                            "--seed", str(seed), "--resolution", f"{args.size}x{args.size}", "-D", f"depth={args.depth}",
                            "-D", f"rr={args.rr}", "--threads", "1", "-q", "-o", path + ".exr"]
                           + (["--cached"] if method in ("old", "new") else []) + args.settings.split(), check=True)
            time = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
            np.savez(path, image=read(path + ".exr").astype(np.float32), time=time)
            os.remove(path + ".exr")
        data = np.load(path + ".npz")
        return data["image"].astype(float), float(data["time"])

    def reference(self, scene):
        """The reference of each seed."""
        args = self.args
        if args.reference_spp == 0:
            most = max(map(int, args.spp.split(",")))
            images = [self.render(args.old or args.odis, scene, most, seed, "odis")[0] for seed in range(args.seeds)]
            return [(sum(images) - image) / (len(images) - 1) for image in images]
        images = [self.render(args.old or args.odis, scene, args.reference_spp, REFERENCE_SEED + i, "odis")[0]
                  for i in range(2)]
        return [np.mean(images, axis=0)] * args.seeds

    def measure(self, scene, spp, method, references, odis):
        args = self.args
        errs, means, times = [], [], []
        for seed in range(args.seeds):
            image, time = self.render(odis, scene, spp, seed, method)
            errs.append(errors(image, references[seed]))
            means.append(image.mean())
            times.append(time)
        return np.array(errs), np.array(means), np.sum(times)

    def row(self, scene, spp, references):
        args = self.args
        for seed in range(args.seeds):  # by turns, so that what else the machine does changes times alike
            for method, odis in (("odis", args.old or args.odis), ("old", args.old), ("new", args.odis)):
                if odis:
                    self.render(odis, scene, spp, seed, method)
        errs, means, time = self.measure(scene, spp, "odis", references, args.old or args.odis)
        for method, odis in (("old", args.old), ("new", args.odis)):
            if not odis:
                continue
            e, m, t = self.measure(scene, spp, method, references, odis)
            trimmed = e[:, 0] / errs[:, 0]
            n = len(m)
            off = np.hypot(m.std(ddof=1), means.std(ddof=1)) / np.sqrt(n) if n > 1 else np.inf
            print(f"{scene:10} {spp:3} {method:4} trimmed {trimmed.max():9.3f} {np.median(trimmed):6.3f} luck "
                  f"{luck(errs[:, 0]):7.3f}  untrimmed "
                  f"worst {e[:, 1].max() / errs[:, 1].max():9.3f} mean {e[:, 1].mean() / errs[:, 1].mean():9.3f}  "
                  f"mean {m.mean() / means.mean():6.4f} ({(m.mean() - means.mean()) / off:+5.1f} s.e. of "
                  f"{off / means.mean():.4f})  far off {e[:, 2].max():.0f} ({errs[:, 2].max():.0f})  "
                  f"time {t / time:5.3f}", flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--odis", default="odis")
    parser.add_argument("--old", help="another odis to compare with")
    parser.add_argument("--scenes", default="pool,pin,slit,ball,projector,bar,window")
    parser.add_argument("--spp", default="4,16,64")
    parser.add_argument("--seeds", type=int, default=16)
    parser.add_argument("--size", type=int, default=128)
    parser.add_argument("--depth", type=int, default=-1)
    parser.add_argument("--rr", type=int, default=5)
    parser.add_argument("--reference-spp", type=int, default=1024,
                        help="of each of two images; 0: the other seeds' images of odis with the most samples")
    parser.add_argument("--settings", default="", help="further options of odis render")
    args = parser.parse_args()
    bench = Bench(args)
    for scene in args.scenes.split(","):
        references = bench.reference(scene)
        for spp in args.spp.split(","):
            bench.row(scene, int(spp), references)


if __name__ == "__main__":
    main()
