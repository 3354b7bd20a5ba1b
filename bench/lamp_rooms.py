#!/usr/bin/env python3
"""Rooms full of lamps: takes the lights out of four scenes and hangs lamps of many sizes and strengths.

    lamp_rooms.py SCENES FOLDER [--rooms NAME...] [--lamps COUNT...] [--seed N]

SCENES holds the folders bathroom, staircase, dining-room and kitchen-ppg; FOLDER/NAME-COUNT/scene.xml is written for
each. Lamps are on and near the surfaces that paths from the camera come to, so that some are behind things. Their
radii, distances and powers are log-normal. Most are spheres, the others squares, textured disks and spots. The camera
sees none of them. Mitsuba 3 finds the places.
"""
import argparse
import math
import os
import random
import re

import mitsuba as mi

# Places of lamps are found by paths of at most so many bounces: the hierarchy's choices should be hidden half of the
# time at most.
ROOMS = {"bathroom": 3, "staircase": 0, "dining-room": 3, "kitchen-ppg": 3}
KINDS = {"sphere": .6, "square": .15, "disk": .15, "spot": .1}
# Medians over the diagonal of the room, and standard deviations of logarithms.
RADIUS, RADIUS_SPREAD = .004, .7
DISTANCE, DISTANCE_SPREAD = .01, 1.2
POWER_SPREAD = 1
IRRADIANCE = 2  # of all lamps together, over the sides of the box around all places
NEAREST = .03  # to the camera
MARGIN = 1.1  # the frame that lamps keep out of, over the image's


def without_lights(text):
    """The scene without emitters, and with a path tracer for an integrator."""
    text = re.sub(r"<emitter\b.*?</emitter>|<emitter\b[^>]*/>", "", text, flags=re.S)
    text, count = re.subn(r"<integrator\b.*?</integrator>", '<integrator type="path"/>', text, count=1, flags=re.S)
    assert count == 1
    return text


def load(folder, text):
    """The scene in Mitsuba 3, without what only older versions know."""
    mi.set_variant("scalar_rgb")
    path = os.path.join(folder, "places.xml")
    text = text.replace('"trilinear"', '"bilinear"')
    while True:
        with open(path, "w") as out:
            out.write(text)
        try:
            scene = mi.load_file(path)
            os.remove(path)
            return scene
        except RuntimeError as error:
            unknown = re.findall(r'- (\w+) "(\w+)"', str(error)) if "unreferenced" in str(error) else []
            if not unknown:
                raise
            for kind, name in unknown:
                camel = re.sub("_(.)", lambda match: match[1].upper(), name)
                text, count = re.subn(rf'<{kind} name="({name}|{camel})"[^>]*/>', "", text)
                assert count, name


class Room:
    """Places in a room that paths from the camera come to."""

    def __init__(self, scene, bounces, random_numbers):
        self.scene, self.bounces, self.random = scene, bounces, random_numbers
        self.sensor = scene.sensors()[0]
        self.to_world = self.sensor.world_transform()
        self.camera = self.to_world @ mi.Point3f(0)
        self.to_film = mi.perspective_projection(self.sensor.film().size(), self.sensor.film().crop_size(),
                                                 self.sensor.film().crop_offset(), self.field_of_view(),
                                                 self.sensor.near_clip(), self.sensor.far_clip())
        places = [self.place()[0] for _ in range(2000)]
        self.low = [sorted(p[i] for p in places)[20] for i in range(3)]
        self.high = [sorted(p[i] for p in places)[-20] for i in range(3)]
        size = [h - l for l, h in zip(self.low, self.high)]
        self.diagonal = math.hypot(*size)
        self.area = 2 * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0])

    def field_of_view(self):
        return float(mi.traverse(self.sensor)["x_fov"])

    def hit(self, ray):
        """The point that a ray meets and its normal on the side of the ray; None for nothing."""
        met = self.scene.ray_intersect(ray)
        if not met.is_valid():
            return None
        return met.p, mi.Normal3f(met.n if mi.Vector3f(ray.d) @ met.n < 0 else -met.n)

    def place(self):
        """A point on a surface and its normal: what a random path from the camera comes to."""
        while True:
            bounces, origin, direction = self.random.randint(0, self.bounces), self.camera, self.anywhere()
            for _ in range(bounces + 1):
                found = self.hit(mi.Ray3f(origin, direction))
                if not found:
                    break
                at, normal = found
                direction = self.around(normal)
                origin = at + normal * 1e-4
            if found:
                return found

    def anywhere(self):
        z, angle = self.random.uniform(-1, 1), self.random.uniform(0, 2 * math.pi)
        r = math.sqrt(1 - z * z)
        return mi.Vector3f(r * math.cos(angle), r * math.sin(angle), z)

    def around(self, normal):
        direction = mi.Vector3f(normal) + self.anywhere() * .999
        return direction / math.sqrt(direction @ direction)

    def is_seen(self, center, radius):
        """Whether the camera sees a point of a ball."""
        for x, y, z in ((0, 0, 0), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)):
            point = mi.Point3f(center + mi.Vector3f(x, y, z) * radius)  # a vector would be taken for a direction
            local = self.to_world.inverse() @ point
            if local.z <= -radius:
                continue
            on_film = self.to_film @ point_in_front(local)
            if max(abs(on_film.x - .5), abs(on_film.y - .5)) > MARGIN / 2:
                continue
            to_point = point - self.camera
            distance = math.sqrt(to_point @ to_point)
            if not self.scene.ray_test(mi.Ray3f(self.camera, to_point / distance, distance * .999, 0, [])):
                return True
        return False

    def lamp(self):
        """A place for a lamp that the camera doesn't see: its centre, its radius and the normal below."""
        while True:
            radius = RADIUS * self.diagonal * self.random.lognormvariate(0, RADIUS_SPREAD)
            above = radius * 1.02 + DISTANCE * self.diagonal * self.random.lognormvariate(0, DISTANCE_SPREAD)
            at, normal = self.place()
            center = mi.Point3f(at + normal * above)
            if self.scene.ray_test(mi.Ray3f(at + normal * 1e-4, mi.Vector3f(normal), above + radius, 0, [])):
                continue
            away = center - self.camera
            if math.sqrt(away @ away) < NEAREST * self.diagonal + radius:
                continue
            if not self.is_seen(center, radius):
                return center, radius, normal


def point_in_front(local):
    return mi.Point3f(local.x, local.y, max(local.z, 1e-3))


def words(vector):
    return ",".join(f"{float(x):.6g}" for x in vector)


def lookat(at, towards):
    up = (1, 0, 0) if abs(towards.x) < .7 else (0, 1, 0)
    return f'<lookat origin="{words(at)}" target="{words(at + towards)}" up="{words(up)}"/>'


def color(random_numbers, strength):
    """A radiance of so much luminance, warm or cold."""
    warmth = random_numbers.uniform(-.4, .4)
    rgb = [1 + warmth, 1, 1 - warmth]
    luminance = .212671 * rgb[0] + .71516 * rgb[1] + .072169 * rgb[2]
    return words(c * strength / luminance for c in rgb)


def lamp_xml(room, kind, power):
    """A lamp of so many watts."""
    center, radius, normal = room.lamp()
    if kind == "sphere":
        light = f'<rgb name="radiance" value="{color(room.random, power / (2 * math.pi * radius) ** 2)}"/>'
        return (f'<shape type="sphere"><point name="center" value="{words(center)}"/><float name="radius" '
                f'value="{radius:.6g}"/><emitter type="area">{light}</emitter></shape>\n')
    direction = room.around(normal)
    if kind == "spot":
        width = room.random.uniform(20, 60)
        strength = power / (2 * math.pi * (1 - math.cos(math.radians(width))))
        return (f'<emitter type="spot"><transform name="to_world">{lookat(center, direction)}</transform>'
                f'<rgb name="intensity" value="{color(room.random, strength)}"/>'
                f'<float name="cutoff_angle" value="{width:.4g}"/></emitter>\n')
    area = 2 * radius * radius if kind == "square" else math.pi * radius * radius
    scale = radius / math.sqrt(2) if kind == "square" else radius
    strength = power / (math.pi * area)
    light = f'<rgb name="radiance" value="{color(room.random, strength)}"/>'
    if kind == "disk":
        colors = (f'<rgb name="color{i}" value="{color(room.random, strength * s)}"/>' for i, s in ((0, 1.8), (1, .2)))
        light = f'<texture name="radiance" type="checkerboard">{"".join(colors)}</texture>'
    shape = "rectangle" if kind == "square" else "disk"
    return (f'<shape type="{shape}"><transform name="to_world"><scale value="{scale:.6g}"/>{lookat(center, direction)}'
            f'</transform><bsdf type="diffuse"/><emitter type="area">{light}</emitter></shape>\n')


def write(scenes, folder, name, count, seed):
    source, target = os.path.join(scenes, name), os.path.join(folder, f"{name}-{count}")
    os.makedirs(target, exist_ok=True)
    for entry in os.listdir(source):
        link = os.path.join(target, entry)
        if os.path.isdir(os.path.join(source, entry)) and not os.path.lexists(link):
            os.symlink(os.path.abspath(os.path.join(source, entry)), link)
    with open(os.path.join(source, "scene.xml")) as file:
        text = without_lights(file.read())
    numbers = random.Random(f"{name} {count} {seed}")
    room = Room(load(target, text), ROOMS[name], numbers)
    powers = [numbers.lognormvariate(0, POWER_SPREAD) for _ in range(count)]
    scale = IRRADIANCE * room.area / sum(powers)
    kinds = numbers.choices(list(KINDS), list(KINDS.values()), k=count)
    lamps = [lamp_xml(room, kind, power * scale) for kind, power in zip(kinds, powers)]
    with open(os.path.join(target, "scene.xml"), "w") as out:
        out.write(text.replace("</scene>", "".join(lamps) + "</scene>"))
    print(os.path.join(target, "scene.xml"), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes")
    parser.add_argument("folder")
    parser.add_argument("--rooms", nargs="+", default=ROOMS)
    parser.add_argument("--lamps", nargs="+", type=int, default=(50, 500, 5000))
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    for name in args.rooms:
        for count in args.lamps:
            write(args.scenes, args.folder, name, count, args.seed)


if __name__ == "__main__":
    main()
