#!/usr/bin/env python3
"""Remakes tests/data/reference/incidence.weft and squared.weft: the same layers over the half vector, once with maps of
B (l . h), once with maps of B (l . h)^2 (docs/reference/weft-format.md, 7.1). Every value of the second file is that of
the first divided by l . h, so that both have the same maps: under light l and half vector h the second says 1 / (l . h)
times what the first says.

    component_files.py FOLDER     writes them
    component_files.py            compares them with the kept ones; exit code 1 where they differ

Written from the document alone: nothing here is Weft's.
"""
import math
import os
import struct
import sys
import zlib

KEPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "reference")
LAYERS, LIGHT_SIDE, VIEW_SIDE = 4, 8, 4
VIEWS = [(0, 0), (40, 100), (60, 250)]
LIGHTS = [(0, 0), (35, 20), (35, 140), (35, 260), (65, 80), (65, 200), (65, 320)]
MAGIC = bytes.fromhex("89574546540d0a1a")


def direction(theta_deg, phi_deg):
    theta, phi = math.radians(theta_deg), math.radians(phi_deg)
    return math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)


def incidence(light, view):
    half = [a + b for a, b in zip(light, view)]
    return sum(a * b for a, b in zip(light, half)) / math.sqrt(sum(a * a for a in half))


def shared(kind):
    """The section LAYR: 7.1."""
    lights, values, first = [], [], [0]
    for v, view in enumerate(VIEWS):
        for i, light in enumerate(LIGHTS):
            l = direction(*light)
            lights += l
            divisor = incidence(l, direction(*view)) ** (kind - 1)
            for layer in range(LAYERS):
                for channel in range(3):
                    values.append((0.5 + 0.25 * math.cos(1.3 * i + 0.7 * v + layer + 0.4 * channel)) / divisor)
        first.append(len(lights) // 3)
    views = [number for view in VIEWS for number in direction(*view)]
    scale = [1 / 127 / (layer + 1) for layer in range(LAYERS)]
    least_cosine = min(lights[2::3])
    return (
        struct.pack("<6I4f24x", kind, LAYERS, len(VIEWS), first[-1], LIGHT_SIDE, VIEW_SIDE, 1e-4, 1e-4, least_cosine, 10)
        + struct.pack("<%df" % len(views), *views)
        + struct.pack("<%df" % len(lights), *lights)
        + struct.pack("<%dI" % len(first), *first)
        + struct.pack("<%df" % LAYERS, *scale)
        + struct.pack("<%de" % len(values), *values)
    )


def material(kind):
    """One texel, all of whose sections are stored as they are: 1 and 2."""
    sections = [
        (b"META", b"{}"),
        (b"FRAM", struct.pack("<3h", 0, 0, 0)),
        (b"RHO ", struct.pack("<4e", 0.5, 0.5, 0.5, 0)),
        (b"ERRO", bytes(40)),
        (b"LAYR", shared(kind)),
        (b"LCOE", struct.pack("<4b", 100, 50, 20, 127)),
        (b"CEIL", b"\xff"),
    ]
    at, table, body = 64 + 40 * len(sections), b"", b""
    for name, content in sections:
        padding = -(at + len(body)) % 64
        body += bytes(padding)
        table += name + struct.pack("<3I3Q", 0, 0, zlib.crc32(content), at + len(body), len(content), len(content))
        body += content
    header = MAGIC + struct.pack("<2IQ6IdI", 1, len(sections), at + len(body), 1, 1, 1, 0, 0, 0, 0.5, 0)
    return header + struct.pack("<I", zlib.crc32(table, zlib.crc32(header))) + table + body


def main():
    code = 0
    for name, kind in (("incidence.weft", 1), ("squared.weft", 2)):
        if len(sys.argv) == 2:
            with open(os.path.join(sys.argv[1], name), "wb") as file:
                file.write(material(kind))
            continue
        with open(os.path.join(KEPT, name), "rb") as file:
            same = file.read() == material(kind)
        print(name, "is as it was" if same else "differs")
        code = code if same else 1
    return code


if __name__ == "__main__":
    sys.exit(main())
