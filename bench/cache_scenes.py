"""Scenes that provoke a radiance cache: rare light, tiny lamps, caustics; and rooms that are easy.

write(folder) makes NAME.xml of each; `SCENES` says what they are.
"""

import math
import os
import struct

SCENES = {
    "pool": "a lamp of 2 cm over rippled water in a closed room",
    "pin": "the same with a lamp of 1 mm",
    "slit": "a small sun through a slit into a dark room",
    "ball": "a mirror ball and a lamp of 1 cm in a closed room",
    "projector": "a tiny lamp behind frosted glass, in a box with an opening",
    "bar": "forty lamps in shades of glass over a counter",
    "window": "a room that a window lights",
    "furnace": "the inside of a white sphere that shines",
}
WHITE, GREY, WOOD = ".75,.75,.75", ".4,.4,.4", ".5,.3,.15"


def scene(shapes, origin, target, emitters="", fov=70):
    return f"""<scene version="3.0.0">
<default name="depth" value="-1"/><default name="rr" value="5"/>
<integrator type="path"><integer name="max_depth" value="$depth"/><integer name="rr_depth" value="$rr"/></integrator>
<sensor type="perspective"><float name="fov" value="{fov}"/>
<transform name="to_world"><lookat origin="{origin}" target="{target}" up="0,1,0"/></transform>
<film type="hdrfilm"><integer name="width" value="96"/><integer name="height" value="96"/><rfilter type="box"/></film>
</sensor>
{shapes}{emitters}
</scene>
"""


def diffuse(color):
    return f'<bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="{color}"/></bsdf></bsdf>\n'


def box(center, size, bsdf):
    return (f'<shape type="cube"><transform name="to_world"><scale value="{",".join(str(s / 2) for s in size)}"/>'
            f'<translate value="{",".join(map(str, center))}"/></transform>{bsdf}</shape>\n')


def sphere(center, radius, inside):
    return (f'<shape type="sphere"><point name="center" x="{center[0]}" y="{center[1]}" z="{center[2]}"/>'
            f'<float name="radius" value="{radius}"/>{inside}</shape>\n')


def lamp(center, radius, power):
    """A sphere that shines with a power of so many watts, if that is what radiance is in."""
    radiance = power / (4 * math.pi * math.pi * radius * radius)
    light = f'<emitter type="area"><rgb name="radiance" value="{radiance:.6g}"/></emitter>'
    return sphere(center, radius, light)


def rectangle(to_world, bsdf):
    return f'<shape type="rectangle"><transform name="to_world">{to_world}</transform>{bsdf}</shape>\n'


def room(size, color=WHITE):
    """Walls about a box from 0 to `size`, 0.1 thick."""
    x, y, z = size
    walls = [((x / 2, -.05, z / 2), (x, .1, z)), ((x / 2, y + .05, z / 2), (x, .1, z)),
             ((-.05, y / 2, z / 2), (.1, y, z)), ((x + .05, y / 2, z / 2), (.1, y, z)),
             ((x / 2, y / 2, -.05), (x, y, .1)), ((x / 2, y / 2, z + .05), (x, y, .1))]
    return "".join(box(center, extent, diffuse(color)) for center, extent in walls)


def water(path, size, height, steps=120):
    """A PLY file of rippled water over [0, size] x [0, size]."""
    points, faces = [], []
    for i in range(steps + 1):
        for k in range(steps + 1):
            x, z = size * i / steps, size * k / steps
            y = height + .02 * (math.sin(5 * x + 1.3 * z) + .7 * math.sin(7.1 * z - 2 * x) + .4 * math.sin(13 * x + 11 * z))
            points.append((x, y, z))
    for i in range(steps):
        for k in range(steps):
            a = i * (steps + 1) + k
            faces += [(a, a + 1, a + steps + 1), (a + 1, a + steps + 2, a + steps + 1)]
    with open(path, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\n"
                   f"property float y\nproperty float z\nelement face {len(faces)}\n"
                   "property list uchar int vertex_indices\nend_header\n".encode())
        for point in points:
            file.write(struct.pack("<3f", *point))
        for face in faces:
            file.write(struct.pack("<B3i", 3, *face))


GLASS = '<bsdf type="dielectric"/>'
MIRROR = '<bsdf type="conductor"><string name="material" value="none"/></bsdf>'
FROSTED = '<bsdf type="roughdielectric"><float name="alpha" value=".3"/></bsdf>'


def pool(folder, radius=.01):
    water(os.path.join(folder, "water.ply"), 4, 1)
    surface = '<shape type="ply"><string name="filename" value="water.ply"/><bsdf type="dielectric">' \
              '<string name="int_ior" value="water"/></bsdf></shape>\n'
    return scene(room((4, 3, 4)) + surface + lamp((2, 2.2, 2), radius, 60), "2,2.2,.2", "2,.8,3")


def pin(folder):
    return pool(folder, .0005)


def slit(folder):
    x, y, z = 4, 3, 4
    shapes = room((x, y, z)).replace(box((x + .05, y / 2, z / 2), (.1, y, z), diffuse(WHITE)), "")
    for center, extent in [((x + .05, .75, z / 2), (.1, 1.5, z)), ((x + .05, 2.27, z / 2), (.1, 1.46, z)),
                           ((x + .05, 1.52, .7), (.1, .04, 1.4)), ((x + .05, 1.52, 3.3), (.1, .04, 1.4))]:
        shapes += box(center, extent, diffuse(WHITE))
    return scene(shapes + lamp((60, 14, 10), .3, 1e6), ".3,1.6,.3", "3,.9,3")


def ball(folder):
    return scene(room((4, 3, 4)) + sphere((2, .8, 2.4), .8, MIRROR) + lamp((.6, 2.7, 1), .01, 60),
                 "2,1.6,.2", "2,1,3")


def projector(folder):
    shapes = room((4, 3, 4), GREY)
    for center, extent in [((.5, 2.2, 2), (.8, .02, .6)), ((.5, 1.6, 2), (.8, .02, .6)),
                           ((.5, 1.9, 1.7), (.8, .6, .02)), ((.5, 1.9, 2.3), (.8, .6, .02))]:
        shapes += box(center, extent, diffuse(".05,.05,.05"))
    shapes += box((.85, 1.9, 2), (.02, .58, .58), FROSTED)
    return scene(shapes + lamp((.2, 1.9, 2), .004, 100), "1.5,1.6,.2", "2.8,1.2,3.6")


def bar(folder):
    shapes = room((6, 3, 4), WOOD) + box((3, .5, 2.6), (5, 1, .6), diffuse(GREY))
    for i in range(40):
        x, z, y = .4 + .133 * i, 1 + 1.9 * ((i * 7) % 10) / 10, 1.7 + .1 * (i % 3)
        shapes += sphere((x, y, z), .06, GLASS) + lamp((x, y, z), .01, 4)
    return scene(shapes, "3,1.5,.15", "3,1.2,3")


def window(folder):
    x, y, z = 4, 3, 4
    shapes = room((x, y, z)).replace(box((x + .05, y / 2, z / 2), (.1, y, z), diffuse(WHITE)), "")
    for center, extent in [((x + .05, .5, z / 2), (.1, 1, z)), ((x + .05, 2.6, z / 2), (.1, .8, z)),
                           ((x + .05, 1.6, .7), (.1, 1.2, 1.4)), ((x + .05, 1.6, 3.3), (.1, 1.2, 1.4))]:
        shapes += box(center, extent, diffuse(WHITE))
    shapes += box((1.2, .5, 3), (1, 1, .8), diffuse(WOOD))
    sky = '<emitter type="constant"><rgb name="radiance" value="4,4.5,5"/></emitter>\n'
    return scene(shapes, ".4,1.6,.3", "2.4,1,3", sky)


def furnace(folder):
    inside = '<boolean name="flip_normals" value="true"/><emitter type="area"/>' \
             '<bsdf type="diffuse"><rgb name="reflectance" value=".9"/></bsdf>'
    return scene(sphere((0, 0, 0), 3, inside), "0,0,1", "0,0,0")


def write(folder):
    os.makedirs(folder, exist_ok=True)
    for name in SCENES:
        with open(os.path.join(folder, name + ".xml"), "w") as file:
            file.write(globals()[name](folder))


if __name__ == "__main__":
    import sys
    write(sys.argv[1])
