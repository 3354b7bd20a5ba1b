#!/usr/bin/env python3
"""Converts Mitsuba's scene files to those of Cycles' own program, as far as to compare guides in both.

    integrations/openpgl/convert_scene.py SCENE.xml FOLDER [--pixels 230400] [--bounces 12]

Writes FOLDER/scene.xml and the images that it names. Needs `pip install ".[mitsuba]"`. Converted are meshes, rectangles,
cubes, disks, spheres, cylinders; diffuse, glossy, glass and plastic surfaces, masks, blends; area lights and
environments; point lights as small spheres, spots as small disks, which shine as wide as disks do. What else there is,
is left out or approximated, and said on stderr: pictures are alike, not equal, and Cycles is compared to Cycles.
"""
import argparse
import math
import pathlib
import sys

import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")
from odis.mitsuba.scene_files import load_file  # noqa: E402

SPHERE_COLUMNS, SPHERE_ROWS = 96, 48
LAMP_COLUMNS, LAMP_ROWS = 16, 8
LAMP_RADIUS = 1e-3  # of a point light or a spot, over the scene's diagonal
ENVIRONMENT_SIZE = (2048, 1024)
CHECKERBOARD_SIZE = (256, 256)
TINTS = {"RoughConductor", "SmoothConductor"}


def text_of(numbers):
    return " ".join(f"{x:.7g}" for x in np.asarray(numbers, float).ravel())


def unit_disk(columns):
    """Corners and triangles of the unit disk, which faces +z."""
    angle = np.linspace(0, 2 * np.pi, columns, endpoint=False)
    corners = np.concatenate([[[0, 0, 0]], np.stack([np.cos(angle), np.sin(angle), 0 * angle], 1)])
    return corners, np.array([[0, 1 + i, 1 + (i + 1) % columns] for i in range(columns)])


def unit_sphere(columns, rows):
    """Corners and triangles of the unit sphere, which face outwards."""
    theta = np.linspace(0, np.pi, rows + 1)[:, None]
    phi = np.linspace(0, 2 * np.pi, columns, endpoint=False)[None]
    corners = np.stack(np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi),
                                           np.cos(theta) + 0 * phi), -1).reshape(-1, 3)
    at = lambda row, column: row * columns + column % columns
    faces = [triangle for r in range(rows) for c in range(columns)
             for triangle in ([at(r, c), at(r + 1, c), at(r + 1, c + 1)], [at(r, c), at(r + 1, c + 1), at(r, c + 1)])]
    return corners, np.array(faces)


def unit_cylinder(columns):
    """Corners and triangles of the cylinder of radius 1 from z = 0 to 1, without its ends, which faces outwards."""
    angle = np.linspace(0, 2 * np.pi, columns, endpoint=False)
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], 1)
    faces = [triangle for i, j in ((i, (i + 1) % columns) for i in range(columns))
             for triangle in ([i, j, columns + j], [i, columns + j, columns + i])]
    return np.concatenate([ring, ring + [0, 0, 1]]), np.array(faces)


class Scene:
    def __init__(self, folder):
        self.folder, self.shaders, self.shapes, self.images, self.said = folder, [], [], {}, set()

    def say(self, words):
        if words not in self.said:
            self.said.add(words)
            print(f"convert_scene: {words}", file=sys.stderr)

    # ---- shaders: nodes of one shader, each named by its number ----

    def color(self, nodes, parameters, name, default):
        """A colour or a texture, as attributes of a closure and connections to it."""
        if name + ".to_uv" in parameters:  # of a bitmap or a checkerboard
            shape = parameters[name + ".data"].shape if name + ".data" in parameters else CHECKERBOARD_SIZE
            to_uv = np.array(parameters[name + ".to_uv"].matrix, float).reshape(3, 3)
            if np.abs([to_uv[0, 1], to_uv[1, 0]]).max() > 1e-6:
                self.say("textures are not rotated")
            file = self.image(parameters.properties[name + ".to_uv"][2], shape, to_uv)
            nodes.append(f'<image_texture name="t{len(nodes)}" filename="{file}" colorspace="__builtin_raw" '
                         f'tex_mapping.type="point" tex_mapping.scale="{to_uv[0, 0]:.6g} {to_uv[1, 1]:.6g} 1" '
                         f'tex_mapping.translation="{to_uv[0, 2]:.6g} {to_uv[1, 2]:.6g} 0"/>')
            return default, f't{len(nodes) - 1} color'
        value = next((parameters[name + end] for end in (".value", "") if name + end in parameters
                      and not isinstance(parameters[name + end], str)), None)
        if value is None:
            return default, None
        array = np.asarray(value, np.float32).ravel()
        return np.repeat(array, 3) if array.size == 1 else array[:3], None

    def image(self, texture, shape, to_uv):
        """A texture's unit square as Mitsuba sees it, linear, in a file whose last row is that of v = 0."""
        if texture in self.images:
            return self.images[texture]
        height, width = shape[:2]
        row, column = np.meshgrid(np.arange(height)[::-1] + 0.5, np.arange(width) + 0.5, indexing="ij")
        pixels = np.stack([column.ravel() / width, row.ravel() / height, np.ones(height * width)])
        si = mi.SurfaceInteraction3f()
        si.uv = mi.Point2f((np.linalg.inv(to_uv) @ pixels)[:2].astype(np.float32))
        values = np.array(texture.eval(si)).reshape(3, -1).T.reshape(height, width, 3)
        self.images[texture] = f"texture{len(self.images)}.exr"
        mi.Bitmap(np.ascontiguousarray(values, np.float32)).write(str(self.folder / self.images[texture]))
        return self.images[texture]

    def closure(self, nodes, bsdf):
        """Adds the nodes of a BSDF; returns the name of the last one and its output."""
        kind, parameters = bsdf.class_name(), mi.traverse(bsdf)
        inner = [node for node in parameters.hierarchy if isinstance(node, mi.BSDF) and node is not bsdf]
        number = lambda name, default: float(np.mean(np.asarray(parameters[name]))) if name in parameters else default
        alpha = number("alpha", number("alpha.value", 0.0))

        def add(element, attributes, **textures):
            name = f"n{len(nodes)}"
            nodes.append(f'<{element} name="{name}" {attributes}/>')
            nodes.extend(f'<connect from="{source}" to="{name} {socket}"/>'
                         for socket, source in textures.items() if source)
            return name

        def mix(first, second, amount, source=None):
            name = add("mix_closure", f'fac="{amount:.6g}"', fac=source)
            nodes.append(f'<connect from="{first[0]} {first[1]}" to="{name} closure1"/>')
            nodes.append(f'<connect from="{second[0]} {second[1]}" to="{name} closure2"/>')
            return name, "closure"

        def diffuse(name):
            color, texture = self.color(nodes, parameters, name, [0.5] * 3)
            return add("diffuse_bsdf", f'color="{text_of(color)}"', color=texture), "BSDF"

        def glossy(color):
            # Distributions are GGX by default; Cycles 3 and 5 spell that differently.
            return add("glossy_bsdf", f'color="{text_of(color)}" roughness="{math.sqrt(alpha):.6g}"'), "BSDF"

        if kind in ("TwoSidedBRDF", "BumpMap", "NormalMap") and inner:
            return self.closure(nodes, inner[0])
        if kind == "MaskBSDF" and inner:
            below = self.closure(nodes, inner[0])
            opacity, texture = self.color(nodes, parameters, "opacity", [1.0] * 3)
            clear = add("transparent_bsdf", 'color="1 1 1"'), "BSDF"
            return mix(clear, below, float(np.mean(opacity)), texture)
        if kind == "BlendBSDF" and len(inner) >= 2:
            return mix(self.closure(nodes, inner[0]), self.closure(nodes, inner[1]), number("weight.value", 0.5))
        if kind in TINTS:
            return glossy(self.conductor_color(parameters))
        if kind in ("SmoothPlastic", "RoughPlastic"):
            fresnel = add("fresnel", 'IOR="1.5"')
            return mix(diffuse("diffuse_reflectance"), glossy([1.0] * 3), 0.04, f"{fresnel} fac")
        if kind in ("SmoothDielectric", "RoughDielectric"):
            ior = number("eta", 1.5)
            return add("glass_bsdf", f'color="1 1 1" IOR="{ior:.6g}" roughness="{math.sqrt(alpha):.6g}"'), "BSDF"
        if kind in ("ThinDielectric", "Null"):
            return add("transparent_bsdf", 'color="0.92 0.92 0.92"'), "BSDF"
        if kind.startswith("Principled"):
            color, texture = self.color(nodes, parameters, "base_color", [0.5] * 3)
            attributes = (f'base_color="{text_of(color)}" roughness="{number("roughness.value", 0.5):.6g}" '
                          f'metallic="{number("metallic.value", 0):.6g}" specular="{number("specular", 0.5):.6g}"')
            return add("principled_bsdf", attributes, base_color=texture), "BSDF"
        if kind != "SmoothDiffuse":
            self.say(f"{kind} becomes diffuse")
        return diffuse("reflectance")

    @staticmethod
    def conductor_color(parameters):
        """The reflectance at normal incidence, which the index of refraction gives."""
        value = lambda name: np.broadcast_to(np.asarray(parameters.get(name + ".value", 0.0), float).ravel(), 3) \
            if name + ".value" in parameters else np.zeros(3)
        eta, k = value("eta"), value("k")
        reflectance = ((eta - 1) ** 2 + k ** 2) / ((eta + 1) ** 2 + k ** 2)
        return np.where(k + eta > 0, reflectance, 1)

    def shader(self, shape):
        nodes, emitter = [], shape.emitter()
        if emitter is not None:
            radiance, _ = self.color(nodes, mi.traverse(emitter), "radiance", [1.0] * 3)
            return self.emission(radiance)
        last = " ".join(self.closure(nodes, shape.bsdf()))
        return self.named("\n  ".join(nodes + [f'<connect from="{last}" to="output surface"/>']))

    def emission(self, radiance):
        """The shader of a surface that emits on its front."""
        return self.named("\n  ".join([
            f'<emission name="front" color="{text_of(radiance)}" strength="1"/>',
            '<diffuse_bsdf name="back" color="0 0 0"/>', '<geometry name="side"/>', '<mix_closure name="both"/>',
            '<connect from="front emission" to="both closure1"/>', '<connect from="back BSDF" to="both closure2"/>',
            '<connect from="side backfacing" to="both fac"/>', '<connect from="both closure" to="output surface"/>']))

    def named(self, body):
        """The name of a shader, made unless there is one of these nodes."""
        for name, known in self.shaders:
            if known == body:
                return name
        self.shaders.append((f"s{len(self.shaders)}", body))
        return self.shaders[-1][0]

    # ---- shapes ----

    def add_shape(self, shape):
        kind = shape.class_name()
        mesh = self.mesh_of(shape, kind)
        if mesh is None:
            self.say(f"{kind} is left out")
            return
        self.add_mesh(self.shader(shape), *mesh)

    def add_mesh(self, shader, positions, faces, uvs, smooth):
        coordinates = f'\n    UV="{text_of(uvs[faces.ravel()])}"' if uvs is not None else ""
        self.shapes.append(
            f'<state shader="{shader}" interpolation="{"smooth" if smooth else "flat"}">\n'
            f'  <mesh P="{text_of(positions)}"\n    nverts="{" ".join(["3"] * len(faces))}"\n'
            f'    verts="{" ".join(map(str, faces.ravel()))}"{coordinates}/>\n</state>')

    def add_lamp(self, emitter, diagonal):
        """A light without a shape."""
        kind, parameters = emitter.class_name(), mi.traverse(emitter)
        radius = LAMP_RADIUS * diagonal
        if kind == "PointLight":
            corners, faces = unit_sphere(LAMP_COLUMNS, LAMP_ROWS)
            positions = corners * radius + np.array(parameters["position"], float).ravel()
        elif kind == "SpotLight":
            self.say("a spot shines as wide as a disk does")
            corners, faces = unit_disk(LAMP_COLUMNS)
            matrix = np.array(emitter.world_transform().matrix, float).reshape(4, 4)
            axes = matrix[:3, :3] / np.linalg.norm(matrix[:3, :3], axis=0)
            positions = corners @ axes.T * radius + matrix[:3, 3]
        else:
            self.say(f"{kind} is left out")
            return
        intensity, _ = self.color([], parameters, "intensity", [1.0] * 3)
        self.add_mesh(self.emission(intensity / (np.pi * radius ** 2)), positions, faces, None, False)

    @staticmethod
    def mesh_of(shape, kind):
        parameters = mi.traverse(shape)
        if shape.is_mesh() and "faces" in parameters:
            array = lambda name, width: np.array(parameters[name] if name in parameters else []).reshape(-1, width)
            uvs = array("vertex_texcoords", 2)
            return (array("vertex_positions", 3), array("faces", 3).astype(int), uvs if len(uvs) else None,
                    len(array("vertex_normals", 3)) > 0)
        if "to_world" not in parameters:
            return None
        matrix = np.array(parameters["to_world"].matrix, float).reshape(4, 4)
        if kind == "Rectangle":
            corners, uvs = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]), [[0, 0], [1, 0], [1, 1], [0, 1]]
            faces = [[0, 1, 2], [0, 2, 3]]
        elif kind == "Disk":
            (corners, faces), uvs = unit_disk(SPHERE_COLUMNS), None
        elif kind == "Sphere":
            (corners, faces), uvs = unit_sphere(SPHERE_COLUMNS, SPHERE_ROWS), None
        elif kind == "Cylinder":
            (corners, faces), uvs = unit_cylinder(SPHERE_COLUMNS), None
        else:
            return None
        positions = corners @ matrix[:3, :3].T + matrix[:3, 3]
        faces = np.array(faces)
        if np.linalg.det(matrix[:3, :3]) < 0:
            faces = faces[:, ::-1]
        return positions, faces, None if uvs is None else np.array(uvs, float), kind in ("Sphere", "Cylinder")

    def background(self, emitter):
        """The environment as an image in Cycles' equirectangular mapping, of which +z is the pole."""
        if emitter is None:
            return '<background><background name="b" color="0 0 0" strength="0"/>' \
                   '<connect from="b background" to="output surface"/></background>'
        width, height = ENVIRONMENT_SIZE
        row, column = np.meshgrid(np.arange(height) + 0.5, np.arange(width) + 0.5, indexing="ij")
        phi, elevation = (0.5 - column / width) * 2 * np.pi, (0.5 - row / height) * np.pi
        direction = np.stack([np.cos(phi) * np.cos(elevation), np.sin(phi) * np.cos(elevation), np.sin(elevation)])
        si = mi.SurfaceInteraction3f()
        si.wi = -mi.Vector3f(*direction.reshape(3, -1).astype(np.float32))
        values = np.array(emitter.eval(si))
        values = np.broadcast_to(values.reshape(3, -1), (3, width * height)).T.reshape(height, width, 3)
        mi.Bitmap(np.ascontiguousarray(values, np.float32)).write(str(self.folder / "environment.exr"))
        return ('<background>\n  <environment_texture name="e" filename="environment.exr" colorspace="__builtin_raw"/>\n'
                '  <background name="b" strength="1"/>\n  <connect from="e color" to="b color"/>\n'
                '  <connect from="b background" to="output surface"/>\n</background>\n'
                # Without a light of this kind next-event estimation would not choose the environment.
                '<state shader="default_background">\n'
                f'  <light light_type="background" map_resolution="{width}" use_mis="true"/>\n</state>')


def camera(sensor, pixels):
    width, height = sensor.film().crop_size()
    scale = math.sqrt(pixels / (width * height))
    width, height = max(1, round(width * scale)), max(1, round(height * scale))
    matrix = np.array(sensor.world_transform().matrix, float).reshape(4, 4) @ np.diag([-1, 1, 1, 1])
    parameters = mi.traverse(sensor)
    half = math.tan(math.radians(float(np.asarray(parameters["x_fov"]).ravel()[0])) / 2)
    if width > height:
        half *= height / width
    return (f'<transform matrix="{text_of(matrix.T)}">\n  <camera width="{width}" height="{height}" type="perspective" '
            f'fov="{2 * math.atan(half):.7g}" nearclip="1e-4" farclip="1e6"/>\n</transform>')


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("scene")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--pixels", type=int, default=230400)
    parser.add_argument("--bounces", type=int, default=12, help="most bounces of a path")
    args = parser.parse_args()
    args.folder.mkdir(parents=True, exist_ok=True)
    scene, converted = load_file(args.scene), Scene(args.folder)
    # Mitsuba loads shapes in parallel, and their order differs from run to run.
    for shape in sorted(scene.shapes(), key=lambda shape: (str(shape.bbox()), shape.class_name())):
        converted.add_shape(shape)
    box = scene.bbox()
    for emitter in scene.emitters():
        if not emitter.is_environment() and emitter.get_shape() is None:
            converted.add_lamp(emitter, float(np.linalg.norm(np.array(box.max - box.min, float))))
    if scene.environment() is None and not any("<emission" in body for _, body in converted.shaders):
        converted.say("no light is left, and the image will be black")
    bounces = " ".join(f'max_{kind}bounce="{args.bounces}"' for kind in ("", "diffuse_", "glossy_", "transmission_"))
    shaders = "\n".join(f'<shader name="{name}">\n  {body}\n</shader>' for name, body in converted.shaders)
    (args.folder / "scene.xml").write_text("\n".join([
        "<cycles>", camera(scene.sensors()[0], args.pixels), '<film exposure="1" filter_type="box" filter_width="1"/>',
        f'<integrator {bounces} sample_clamp_indirect="0" sample_clamp_direct="0" filter_glossy="0" '
        'use_adaptive_sampling="false" caustics_reflective="true" caustics_refractive="true" '
        'use_guiding="true" seed="0"/>',
        converted.background(scene.environment()), shaders, *converted.shapes, "</cycles>", ""]))


if __name__ == "__main__":
    main()
