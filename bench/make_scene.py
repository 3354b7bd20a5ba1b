#!/usr/bin/env python3
"""Writes a large scene: make_scene.py triangles|shapes|lights COUNT FOLDER

triangles: one PLY mesh, a hilly field; shapes: so many spheres on a floor; lights: so many point lights above one.
"""
import array
import math
import os
import sys

HEAD = """<scene version="3.0.0">
  <sensor type="perspective"><float name="fov" value="45"/>
    <transform name="to_world"><lookat origin="0,3,6" target="0,0,0" up="0,1,0"/></transform>
    <film type="hdrfilm"><integer name="width" value="640"/><integer name="height" value="360"/></film></sensor>
  <bsdf type="diffuse" id="grey"/>
"""
FLOOR = """<shape type="rectangle"><transform name="to_world"><scale value="5"/><rotate x="1" angle="-90"/></transform>
  <ref id="grey"/></shape>
"""
SKY = '<emitter type="constant"/>\n'


def place(i, side):
    return 8 * (i % side) / side - 4, 8 * (i // side) / side - 4


def field(count, path):
    side = max(1, math.isqrt(count // 2))
    with open(path, "wb") as file:
        file.write((f"ply\nformat binary_little_endian 1.0\nelement vertex {(side + 1) ** 2}\nproperty float x\n"
                    f"property float y\nproperty float z\nelement face {2 * side * side}\n"
                    "property list uchar uint vertex_indices\nend_header\n").encode())
        for row in range(side + 1):
            z = 8 * row / side - 4
            vertices = array.array("f")
            for column in range(side + 1):
                x = 8 * column / side - 4
                vertices.extend((x, 0.3 * math.sin(3 * x) * math.cos(2 * z) + 0.01 * math.sin(97 * x + 61 * z), z))
            vertices.tofile(file)
        for row in range(side):
            faces = bytearray()
            for column in range(side):
                a = row * (side + 1) + column
                b, c, d = a + 1, a + side + 1, a + side + 2
                for triangle in ((a, c, b), (b, c, d)):
                    faces += b"\3" + array.array("I", triangle).tobytes()
            file.write(faces)


def main():
    kind, count, folder = sys.argv[1], int(sys.argv[2]), sys.argv[3]
    os.makedirs(folder, exist_ok=True)
    side = max(1, math.isqrt(count - 1) + 1)
    with open(os.path.join(folder, "scene.xml"), "w") as out:
        out.write(HEAD)
        if kind == "triangles":
            field(count, os.path.join(folder, "field.ply"))
            out.write('<shape type="ply"><string name="filename" value="field.ply"/><ref id="grey"/></shape>\n' + SKY)
        elif kind == "shapes":
            out.write(FLOOR + SKY)
            for i in range(count):
                x, z = place(i, side)
                out.write(f'<shape type="sphere"><point name="center" x="{x:.5f}" y="0.02" z="{z:.5f}"/>'
                          f'<float name="radius" value="{2.5 / side:.5f}"/><ref id="grey"/></shape>\n')
        elif kind == "lights":
            out.write(FLOOR)
            for i in range(count):
                x, z = place(i, side)
                out.write(f'<emitter type="point"><point name="position" x="{x:.5f}" y="0.5" z="{z:.5f}"/>'
                          f'<rgb name="intensity" value="{10 / count:.8f}"/></emitter>\n')
        else:
            sys.exit("expected triangles, shapes or lights")
        out.write("</scene>\n")


main()
