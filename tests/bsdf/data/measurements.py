"""Writes lacquer.pbsdf, made-up measurements in the format of Mitsuba's `measured_polarized`.

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


lacquer()
