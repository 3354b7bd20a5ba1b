"""Writes made-up measurements: lacquer.pbsdf for `measured_polarized`, cloth.bsdf and velvet.bsdf for `measured`.

Usage: python measurements.py
"""
import os
import struct

import numpy as np

TYPES = {"uint8": 1, "uint16": 3, "float32": 10}


def write(name, fields):
    header_size = 18 + sum(2 + len(key) + 2 + 1 + 8 + 8 * values.ndim for key, values in fields.items())
    header, body = b"tensor_file\0" + struct.pack("<BBI", 1, 0, len(fields)), b""
    for key, values in fields.items():
        body += bytes(-(header_size + len(body)) % 8)
        header += struct.pack("<H", len(key)) + key.encode()
        header += struct.pack("<HBQ", values.ndim, TYPES[values.dtype.name], header_size + len(body))
        header += struct.pack("<%dQ" % values.ndim, *values.shape)
        body += values.tobytes()
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), name), "wb") as file:
        file.write(header + body)


def lacquer():
    # A diffuse part and a broad highlight, reciprocal: the same at phi_d + pi.
    phi_d = np.linspace(-np.pi, np.pi, 9, dtype=np.float32)
    theta_d = np.linspace(0, np.pi / 2, 4, dtype=np.float32)
    theta_h = np.linspace(0, np.pi / 2, 6, dtype=np.float32) ** 2 * np.float32(2 / np.pi)
    wavelengths = np.array([450, 500, 550, 600, 650], dtype=np.uint16)
    p, d, h, w = np.meshgrid(phi_d, theta_d, theta_h, wavelengths, indexing="ij")
    value = 0.1 + 0.0002 * (w - 450) + 0.3 * np.exp(-8 * h * h) * (1 + 0.5 * d * np.cos(2 * p))
    matrices = np.zeros((*value.shape, 4, 4), dtype=np.float32)
    matrices[..., 0, 0] = value
    # Where nothing was measured there is no number.
    matrices[:, -1, -1] = np.nan
    fields = {"phi_d": phi_d[None], "theta_d": theta_d[None], "theta_h": theta_h[None], "wvls": wavelengths}
    write("lacquer.pbsdf", {**fields, "M": matrices})


def measured(name, alpha, phi_i, theta_i, anisotropy):
    # A GGX surface, of which every visible facet reflects most of the light, more or less as the numbers go.
    def values(*sizes):
        axes = [np.linspace(0, 1, size) for size in sizes]
        return np.meshgrid(*axes, indexing="ij")

    def distribution(theta, phi):
        slope = np.tan(np.minimum(theta, 1.55)) / (alpha * (1 + anisotropy * np.cos(2 * phi)))
        return 1 / (np.pi * alpha**2 * np.cos(np.minimum(theta, 1.55)) ** 4 * (1 + slope**2) ** 2)

    def projected_area(theta):
        tangent = np.tan(np.minimum(theta, 1.55))
        return np.cos(theta) * (1 + np.sqrt(1 + (alpha * tangent) ** 2)) / 2

    y, x = values(12, 16)
    ndf = distribution(x**2 * np.pi / 2, (2 * y - 1) * np.pi)
    sigma = projected_area(x**2 * np.pi / 2)
    vndf = np.zeros((len(phi_i), len(theta_i), 12, 16))
    for i, phi in enumerate(phi_i):
        for j, theta in enumerate(theta_i):
            # Those of isotropic surfaces are relative to the azimuth of the direction.
            theta_m, phi_m = x**2 * np.pi / 2, (2 * y - 1) * np.pi
            away = phi_m - (phi if anisotropy else 0)
            facing = np.cos(theta) * np.cos(theta_m) + np.sin(theta) * np.sin(theta_m) * np.cos(away)
            jacobian = 2 * np.pi**2 * x * np.sin(theta_m)
            vndf[i, j] = distribution(theta_m, phi_m) * np.maximum(facing, 0.01) * jacobian + 1e-3
    v, u = values(6, 6)
    luminance = np.broadcast_to(0.5 + 0.3 * u * v, (len(phi_i), len(theta_i), 6, 6))
    tints = np.array([0.5, 0.4, 0.2])[:, None, None]
    rgb = np.broadcast_to(tints * luminance[0, 0], (len(phi_i), len(theta_i), 3, 6, 6))
    single = {"phi_i": phi_i, "theta_i": theta_i, "ndf": ndf, "sigma": sigma, "vndf": vndf, "luminance": luminance,
              "rgb": rgb}
    fields = {key: np.ascontiguousarray(value, dtype=np.float32) for key, value in single.items()}
    text = np.frombuffer(b"made up", dtype=np.uint8)
    write(name, {**fields, "description": text, "jacobian": np.ones(1, dtype=np.uint8)})


lacquer()
measured("cloth.bsdf", 0.5, np.zeros(1), np.linspace(0, 1.5, 4), 0)
measured("velvet.bsdf", 0.6, np.linspace(-np.pi, 0, 3), np.linspace(0, 1.5, 4), 0.3)
