#!/usr/bin/env python3
"""Writes two scenes with media for Cycles' own program, which bench/in_cycles.py and bench/cycles_agreement.py render.

    bench/cycles_media.py FOLDER [--size 128x96] [--bounces 12]

`smoke` is a cloud whose density is noise, with a lamp in it and one behind a wall with a slit; `fog` is a closed room
full of even fog, into which the light of a panel comes through a window. Makes FOLDER/smoke and FOLDER/fog. Everything
is made of boxes, and lamps are boxes that shine, as versions of Cycles differ in how their files name lights.
"""
import argparse
import pathlib

import numpy as np

CORNERS = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
SIDES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]  # they face outwards


def text_of(numbers):
    return " ".join(f"{x:.7g}" for x in np.asarray(numbers, float).ravel())


def box(shader, low, high):
    corners = np.array(low) + CORNERS * (np.array(high) - np.array(low))
    return (f'<state shader="{shader}" interpolation="flat">\n  <mesh P="{text_of(corners)}" nverts="{"4 " * 6}"\n'
            f'    verts="{" ".join(str(corner) for side in SIDES for corner in side)}"/>\n</state>')


def diffuse(name, color):
    return (f'<shader name="{name}"><diffuse_bsdf name="d" color="{text_of(color)}"/>'
            '<connect from="d BSDF" to="output surface"/></shader>')


def shines(name, radiance):
    return (f'<shader name="{name}"><emission name="e" color="{text_of(radiance)}" strength="1"/>'
            '<connect from="e emission" to="output surface"/></shader>')


def medium(name, color, density, anisotropy, nodes=""):
    """A medium of even density, or of what `nodes` give."""
    return (f'<shader name="{name}"><principled_volume name="v" color="{text_of(color)}" density="{density}" '
            f'anisotropy="{anisotropy}"/>{nodes}<connect from="v volume" to="output volume"/></shader>')


def noise(scale, threshold, density):
    """Nodes that set the density of a medium to that of clouds: noise above a threshold."""
    return (f'<geometry name="g"/><noise_texture name="n" scale="{scale}" detail="1"/>'
            f'<math name="above" math_type="subtract" value2="{threshold}"/>'
            '<math name="cut" math_type="maximum" value2="0"/>'
            f'<math name="times" math_type="multiply" value2="{density}"/>'
            '<connect from="g position" to="n vector"/><connect from="n fac" to="above value1"/>'
            '<connect from="above value" to="cut value1"/><connect from="cut value" to="times value1"/>'
            '<connect from="times value" to="v density"/>')


def camera(origin, target, size, fov):
    forward = np.array(target, float) - origin
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, (0, 1, 0))
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3] = np.stack([right, np.cross(right, forward), forward, origin], 1)
    return (f'<transform matrix="{text_of(matrix.T)}"><camera width="{size[0]}" height="{size[1]}" type="perspective" '
            f'fov="{np.radians(fov):.7g}" nearclip="1e-4" farclip="1e6"/></transform>')


def smoke():
    shapes = [box("floor", (-4, -.1, -4), (4, 0, 4)), box("floor", (-4, 0, 3), (4, 4, 3.1)),
              # A lamp behind a wall with a slit, which lights the cloud from the left.
              box("floor", (-2.6, 0, -2), (-2.5, 1.1, 3)), box("floor", (-2.6, 1.3, -2), (-2.5, 4, 3)),
              box("cold", (-3.6, 1.4, .2), (-3.5, 1.8, .6)),
              box("smoke", (-1.3, .05, -1), (1.3, 2.3, 1.2)), box("warm", (.1, 1, 0), (.2, 1.1, .1))]
    shaders = [diffuse("floor", (.5, .5, .5)), shines("cold", (150, 200, 300)), shines("warm", (1200, 700, 300)),
               medium("smoke", (.85, .85, .85), 1, .3, noise(2.2, .45, 45))]
    return shapes, shaders, ((0, 1.6, -5), (0, 1.1, 0)), 40


def fog():
    walls = [((-.1, -.1, -.1), (4.1, 0, 5.1)), ((-.1, 3, -.1), (4.1, 3.1, 5.1)), ((-.1, 0, -.1), (0, 3, 5.1)),
             ((0, 0, -.1), (4, 3, 0)), ((0, 0, 5), (4, 3, 5.1)),
             # The wall with the window.
             ((4, 0, 0), (4.1, 1.2, 5)), ((4, 2.3, 0), (4.1, 3, 5)), ((4, 1.2, 0), (4.1, 2.3, 2.2)),
             ((4, 1.2, 3.4), (4.1, 2.3, 5))]
    shapes = [box("wall", *wall) for wall in walls]
    shapes += [box("wood", (.6, 0, 3), (1.6, 1, 4)), box("panel", (7, 4.5, 2), (7.1, 6, 3.6)),
               box("fog", (.001, .001, .001), (3.999, 2.999, 4.999))]
    shaders = [diffuse("wall", (.7, .7, .7)), diffuse("wood", (.5, .3, .15)), shines("panel", (400, 360, 300)),
               medium("fog", (.95, .95, .95), .25, .5)]
    return shapes, shaders, ((.5, 1.6, .3), (2.6, 1.2, 3.6)), 60


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--size", default="128x96", help="width x height (128x96)")
    parser.add_argument("--bounces", type=int, default=12, help="most bounces of a path")
    args = parser.parse_args()
    size = tuple(map(int, args.size.split("x")))
    kinds = ("", "diffuse_", "glossy_", "transmission_", "volume_")
    bounces = " ".join(f'max_{kind}bounce="{args.bounces}"' for kind in kinds)
    for make in (smoke, fog):
        shapes, shaders, (origin, target), fov = make()
        (args.folder / make.__name__).mkdir(parents=True, exist_ok=True)
        (args.folder / make.__name__ / "scene.xml").write_text("\n".join([
            "<cycles>", camera(origin, target, size, fov), '<film exposure="1" filter_type="box" filter_width="1"/>',
            f'<integrator {bounces} sample_clamp_indirect="0" sample_clamp_direct="0" filter_glossy="0" '
            'use_adaptive_sampling="false" use_guiding="true" seed="0"/>',
            '<background><background name="b" color="0 0 0" strength="0"/>'
            '<connect from="b background" to="output surface"/></background>', *shaders, *shapes, "</cycles>", ""]))


if __name__ == "__main__":
    main()
