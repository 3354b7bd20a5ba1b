#!/usr/bin/env python3
"""Error against time of the pictures that `odis render --tev` shows while it renders.

    bench/preview.py ODIS SCENE.xml REFERENCE.exr [--spp 64] [--rounds 3] [--methods ...]

Stands in for tev on a port of its own; pictures have the size of the reference. Time begins when the program connects,
which is when it begins to render; loading is left out. The error is the trimmed relMSE of `odis compare`; one picture
of each method, the last, is the image itself. Of several rounds the one with the median time of the first picture is
shown. Needs `numpy` and `OpenEXR`.
"""
import argparse
import shlex
import socket
import struct
import subprocess
import tempfile
import threading
import time

import numpy as np
import OpenEXR
from relative_error import trimmed_relative_error

METHODS = "path=--integrator path,odis=--integrator odis,cached=--cached"
CREATE, UPDATE = 4, 6


class Tev:
    """Takes one connection, and keeps each complete picture with the seconds since then."""

    def __init__(self):
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.pictures = []
        self.thread = threading.Thread(target=self._listen, daemon=True)  # ends with the program if nobody connects
        self.thread.start()

    def _listen(self):
        connection, _ = self.listener.accept()
        start = time.perf_counter()
        with connection, connection.makefile("rb") as stream:
            image = None
            while head := stream.read(5):
                length, kind = struct.unpack("<IB", head)
                body = stream.read(length - 5)
                if kind == CREATE:
                    at = body.index(0, 1) + 1
                    width, height = struct.unpack_from("<ii", body, at)
                    image = np.zeros((height, width, 3), np.float32)
                elif kind == UPDATE:
                    if self._update(image, body) == image.shape[0]:
                        self.pictures.append((time.perf_counter() - start, image.copy()))

    @staticmethod
    def _update(image, body):
        """Copies a band of rows; returns the row below it."""
        at = body.index(0, 1) + 1
        (channels,) = struct.unpack_from("<i", body, at)
        at += 4 + 2 * channels  # names of one letter
        _, y, width, height = struct.unpack_from("<4i", body, at)
        at += 16 + 16 * channels
        image[y:y + height] = np.frombuffer(body, np.float32, width * height * 3, at).reshape(height, width, 3)
        return y + height

    def wait(self):
        self.thread.join()
        self.listener.close()
        return self.pictures


def pictures_of(args, size, options, seed):
    tev = Tev()
    with tempfile.TemporaryDirectory() as folder:
        command = [args.odis, "render", args.scene, "--resolution", size, "--spp", str(args.spp),
                   "--max-depth", str(args.max_depth), "--seed", str(seed), "--tev", f":{tev.port}", "-q",
                   "-o", f"{folder}/image.exr", *shlex.split(options)]
        subprocess.run(command, check=True)
    return tev.wait()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("odis")
    parser.add_argument("scene")
    parser.add_argument("reference", help="an image without noise to speak of")
    parser.add_argument("--methods", default=METHODS, help="as of `odis compare`; default: %(default)s")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--max-depth", type=int, default=13)
    parser.add_argument("--rounds", type=int, default=3)
    args = parser.parse_args()
    reference = OpenEXR.File(args.reference).channels()["RGB"].pixels.astype(np.float64)
    size = f"{reference.shape[1]}x{reference.shape[0]}"

    for method in args.methods.split(","):
        name, options = method.split("=", 1)
        rounds = sorted((pictures_of(args, size, options, seed) for seed in range(args.rounds)),
                        key=lambda pictures: pictures[0][0])
        print(f"{name}: seconds, error")
        for seconds, image in rounds[len(rounds) // 2]:
            print(f"  {seconds:6.3f}  {trimmed_relative_error(image, reference):.4g}")


if __name__ == "__main__":
    main()
