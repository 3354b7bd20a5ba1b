#!/usr/bin/env python3
"""Where the images of a method differ from their references beyond noise: a picture, and a row of numbers for each scene.

    odis compare SCENE... --spp 64 --reference-spp 512 --methods cached=--cached -o out
    bench/bias_maps.py out cached -o bias.png

Luminance is averaged over blocks of 8 x 8 pixels, in which noise is an eighth; a map shows how far an image's block is
off its reference's, over that (plus 1 % of the reference's mean): blue where it is darker, red where it is brighter,
full at 10 %. *off* is the root mean square over blocks, *noise* what noise makes of it, as the spread within blocks
says, and *bias* what is left. Of each scene the image of the first seed with the most samples is read. Needs numpy,
OpenEXR and Pillow."""
import argparse
import glob
import json
import os
import sys

import numpy as np
import OpenEXR
from block_agreement import BLOCK, pixels_of_blocks
from PIL import Image, ImageDraw
from relative_error import LUMINANCE

FULL, FLOOR = 0.1, 0.01
COLUMNS, SCALE, GAP, HEADER = 4, 3, 6, 16
DARKER, SAME, BRIGHTER = (np.array(color, np.float64) for color in ((30, 70, 200), (255, 255, 255), (200, 40, 30)))


def luminance_of(path):
    return OpenEXR.File(path).channels()["RGB"].pixels.astype(np.float64) @ LUMINANCE


def compare(image, reference):
    """How far each block is off, relative; and the standard error of that."""
    scale = pixels_of_blocks(reference).mean(axis=2) + FLOOR * reference.mean()
    difference = pixels_of_blocks(image - reference)
    return difference.mean(axis=2) / scale, difference.std(axis=2, ddof=1) / BLOCK / scale


def colored(off):
    share = np.clip(off / FULL, -1, 1)[..., None]
    color = SAME + np.where(share < 0, -share * (DARKER - SAME), share * (BRIGHTER - SAME))
    return Image.fromarray(color.astype(np.uint8)).resize((SCALE * off.shape[1], SCALE * off.shape[0]), Image.NEAREST)


def images_of(folder, method):
    """The image file of each scene with the most samples."""
    with open(os.path.join(folder, "results.jsonl"), encoding="utf-8") as file:
        results = [json.loads(line) for line in file]
    found = {}
    for result in sorted(results, key=lambda result: result["spp"]):
        path = os.path.join(folder, result.get("image") or "")
        if result["method"] == method and not result["denoised"] and os.path.isfile(path):
            found[result["scene"]] = (path, result["spp"])
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="what odis compare wrote")
    parser.add_argument("method", help="the name of one of its methods")
    parser.add_argument("-o", "--output", required=True, metavar="PNG")
    args = parser.parse_args()
    try:
        found = images_of(args.folder, args.method)
    except OSError as error:
        sys.exit(f"{error.filename}: {error.strerror}; expected a folder that odis compare wrote")
    if not found:
        sys.exit(f"{args.folder}: found no images of {args.method}")

    maps = []
    print("| scene | samples | mean | off, % | noise, % | bias, % |\n|---|--:|--:|--:|--:|--:|")
    for scene, (path, spp) in found.items():
        references = glob.glob(os.path.join(glob.escape(args.folder), "references", f"{scene}-*.exr"))
        if len(references) != 1:
            sys.exit(f"{args.folder}/references: expected one reference of {scene}, found {len(references)}")
        image, reference = luminance_of(path), luminance_of(references[0])
        off, error = compare(image, reference)
        rms, noise = (np.sqrt((values ** 2).mean()) for values in (off, error))
        bias = np.sqrt(max(rms ** 2 - noise ** 2, 0))
        print(f"| {scene} | {spp} | {image.mean() / reference.mean():.4f} | {100 * rms:.1f} | {100 * noise:.1f} | "
              f"{100 * bias:.1f} |")
        maps.append((scene, colored(off)))

    width, height = (max(picture.size[axis] for _, picture in maps) for axis in (0, 1))
    columns, rows = min(COLUMNS, len(maps)), -(-len(maps) // COLUMNS)
    sheet = Image.new("RGB", (columns * (width + GAP) - GAP, rows * (height + HEADER + GAP) - GAP), (40, 40, 40))
    for i, (scene, picture) in enumerate(maps):
        x, y = i % COLUMNS * (width + GAP), i // COLUMNS * (height + HEADER + GAP)
        ImageDraw.Draw(sheet).text((x + 4, y + 2), scene, fill=(230, 230, 230))
        sheet.paste(picture, (x, y + HEADER))
    sheet.save(args.output)


if __name__ == "__main__":
    main()
