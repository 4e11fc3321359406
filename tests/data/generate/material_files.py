#!/usr/bin/env python3
"""Remakes the files of tests/golden that are of version 2 and that no command made: good/material/document_2.weft, and
bad/material/*_2.weft. Written from docs/reference/weft-format.md alone, with Python's standard library.

    material_files.py FOLDER    writes good/ and bad/ below FOLDER
    material_files.py           makes them, and compares them with the golden files; exit code 1 where they differ
"""
import os
import struct
import sys
import zlib

GOLDEN = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "golden")
LOBES, COMPONENTS, VIEWS, OPACITY, HEIGHTS, VISIBILITY, UNKNOWN = 1, 2, 4, 8, 1 << 16, 1 << 17, 1 << 24
WIDTH, HEIGHT, LEVELS = 4, 3, 2  # of three levels
LOBE_COUNT, K = 2, 4
DIRECTIONS = [(0, 0, 1), (0.6, 0, 0.8), (1, 0, 0), (0.6, 0, 0.8), (0, 0.6, 0.8)]  # one on the horizon, one twice
STORED_VIEWS = [(0, 0, 1), (0.48, 0.36, 0.8)]
LIGHTS = [(0, 0, 1), (0.6, 0, 0.8), (0, 0.8, 0.6), (0, 0, 1), (-0.6, 0, 0.8)]
FIRST = [0, 3, 5]


def pack(kind, values):
    values = list(values)
    return struct.pack("<%d%s" % (len(values), kind), *values)


# ---- Codecs ----

def zstandard(data):
    """One frame of raw blocks, with the size of its content."""
    return struct.pack("<IBI", 0xFD2FB528, 0xA0, len(data)) + pack("B", (len(data) * 8 + 1).to_bytes(3, "little")) + data


def repeated(byte, count):
    """One frame of a single block that repeats a byte."""
    return struct.pack("<IBI", 0xFD2FB528, 0xA0, count) + (count * 8 + 3).to_bytes(3, "little") + bytes([byte])


def skippable(size):
    return struct.pack("<II", 0x184D2A53, size) + bytes(range(size))


# ---- Sections ----

def size_of(level):
    return (WIDTH + (1 << level) - 1) >> level, (HEIGHT + (1 << level) - 1) >> level


def texels(level):
    width, height = size_of(level)
    return width * height


def lobes(level):
    count = texels(level)
    diffuse = [(7 * i + c) % 64 / 128 if c < 3 else (i % 3) * 0.75 for i in range(count) for c in range(4)]
    parts = [(1 + p + i % 5) * 2 if c == 3 else ((3 * i + 5 * p + c) % 17 - 8) / 8
             for p in range(3 * LOBE_COUNT) for i in range(count) for c in range(4)]
    return pack("e", diffuse + parts)


def shared(**changed):
    field = dict(kind=1, K=K, V=len(STORED_VIEWS), I=len(LIGHTS), light_side=6, view_side=4, light_smoothness=0.01,
                 view_smoothness=0.02, least_cosine=0.25, threshold=0.5, reserved=0, scale=0.001, light=LIGHTS,
                 first=FIRST, view=STORED_VIEWS, code=None)
    field.update(changed)
    names = "kind K V I light_side view_side light_smoothness view_smoothness least_cosine threshold".split()
    header = struct.pack("<6I4f", *(field[name] for name in names)) + pack("I", [field["reserved"]] + [0] * 5)
    directions = pack("f", (x for d in field["view"] + field["light"] for x in d))
    weight = pack("b", ((k * 3 + i) % 33 for k in range(K) for i in range(9)))
    codes = [field["code"] if field["code"] is not None else (i * 37) % 300 for i in range(len(LIGHTS) * K * 3)]
    scale = pack("f", (field["scale"] * (1 + k) for k in range(K)))
    return (header + directions + pack("I", field["first"]) + scale + weight + pack("B", (c & 255 for c in codes)) +
            pack("B", (c >> 8 for c in codes)))


def bounds(level):
    width, height = size_of(level)
    return pack("B", (c * 40 + level for s in range((width + 7) // 8 * ((height + 7) // 8)) for c in range(4)))


def heights(places=(3, 2), levels=1, reserved=0, size=(1.0, 0.75), low=-0.125, high=0.25):
    header = struct.pack("<4I2d2f", *places, levels, reserved, *size, low, high)
    return header + bytes(24) + pack("B", (i * 50 for i in range(6)))


def visibility(side=4, levels=LEVELS, finer=1, cell=1):
    cells = [i % 2 for i in range((2 + LEVELS) * 16 - 1)] + [cell]
    return struct.pack("<4I", side, levels, finer, 0) + bytes(16) + pack("B", cells)


def sections():
    """{(type, level): (codec, stored bytes, decoded size)}, in the order of the file."""
    metadata = '{"provenance": "from the document", "note": "°"}'.encode()
    errors = pack("d", [0.1, 0.2, 0.3, 0.4, float("inf"), 0, 0, 0, 0, 0])
    plain = {("VISI", 0): visibility(), ("HGHT", 0): heights(), ("NEW!", 7): b"of a later Weft",
             ("ERRO", 0): errors, ("META", 0): metadata, ("VIEW", 0): pack("f", (x for d in DIRECTIONS for x in d))}
    for level in reversed(range(LEVELS)):
        count = texels(level)
        plain["BNDS", level] = bounds(level)
        plain["COEF", level] = pack("b", ((i * 31 + level) % 255 - 127 for i in range(K * count)))
        plain["ALPH", level] = pack("B", (255 - i * 3 % 200 for i in range(len(DIRECTIONS) * count)))
        plain["TABL", level] = pack("B", (255 - i * 7 % 256 for i in range(3 * len(DIRECTIONS) * count)))
        plain["LOBE", level] = lobes(level)
        plain["FRAM", level] = pack("h", ((i * 1111) % 20000 - 10000 for i in range(3 * count)))
    plain["COMP", 0] = shared()
    made = {key: (0, data, len(data)) for key, data in plain.items()}
    for key in [("LOBE", 0), ("TABL", 1), ("VISI", 0)]:
        made[key] = (1, zstandard(plain[key]) + (skippable(5) if key[0] == "LOBE" else b""), len(plain[key]))
    return made


# ---- Files ----

HEADER = dict(version=2, width=WIDTH, height=HEIGHT, levels=LEVELS, lobes=LOBE_COUNT, views=len(DIRECTIONS),
              features=LOBES | COMPONENTS | VIEWS | OPACITY | HEIGHTS | VISIBILITY | UNKNOWN, pitch=0.25, components=K)


def material(made, twice=None, **changed):
    header = {**HEADER, **changed}
    entries = list(made.items()) + ([(twice, made[twice])] if twice else [])
    table, body, start = b"", b"", 64 + 40 * len(entries)
    for (kind, level), (codec, stored, decoded) in entries:
        body += bytes(-(start + len(body)) % 64)
        table += struct.pack("<4sIIIQQQ", kind.encode(), level, codec, zlib.crc32(stored), start + len(body), len(stored),
                             decoded)
        body += stored
    names = "width height levels lobes views features pitch components".split()
    head = bytes.fromhex("89574546540D0A1A") + struct.pack("<IIQ6IdI", header["version"], len(entries),
                                                           start + len(body), *(header[name] for name in names))
    return head + struct.pack("<I", zlib.crc32(table, zlib.crc32(head))) + table + body


def with_section(kind, data, level=0, codec=0, decoded=None):
    made = sections()
    made[kind, level] = (codec, data, len(data) if decoded is None else decoded)
    return material(made)


def without(*keys, **changed):
    return material({key: value for key, value in sections().items() if key[0] not in keys and key not in keys}, **changed)


def patched(kind, at, data, level=0):
    old = sections()[kind, level][1]
    return with_section(kind, old[:at] + data + old[at + len(data):], level)


def bad_files():
    made, nan, half = sections(), float("nan"), pack("e", [-1])
    plain_lobes = lobes(0)
    return {
        "unknown_feature": material(made, features=HEADER["features"] | 32),
        "newer_version_3": material(made, version=3),
        "no_lobes_no_components": without("FRAM", "LOBE", "TABL", "COMP", "COEF", "BNDS", lobes=0, components=0,
                                          features=VIEWS | OPACITY | HEIGHTS | VISIBILITY),
        "lobes_without_feature": without("FRAM", "LOBE", "TABL", features=HEADER["features"] & ~LOBES),
        "components_without_feature": without("COMP", "COEF", "BNDS", features=HEADER["features"] & ~COMPONENTS),
        "components_0": material(made, components=0),
        "components_68": material(made, components=68),
        "components_other": material(made, components=8),
        "views_without_feature": without("VIEW", "TABL", "ALPH", features=HEADER["features"] & ~(VIEWS | OPACITY)),
        "views_0": material(made, views=0),
        "opacity_without_views": without("VIEW", "TABL", "ALPH", views=0, features=HEADER["features"] & ~VIEWS),
        "section_without_feature": material(made, features=HEADER["features"] & ~HEIGHTS),
        "section_missing": without(("BNDS", 1)),
        "section_twice": material(made, twice=("COEF", 1)),
        "section_of_version_1": with_section("TABL", bytes(4 * len(DIRECTIONS) * texels(0))),
        "errors_of_one_level": with_section("ERRO", bytes(40)),
        "error_nan": patched("ERRO", 8, pack("d", [nan])),
        "codec_of_version_1": with_section("COMP", zstandard(shared()), codec=3, decoded=len(shared())),
        "bomb": with_section("LOBE", repeated(0, 1 << 20), codec=1, decoded=1 << 20),
        "bytes_after_frame": with_section("LOBE", zstandard(plain_lobes) + b"12345678", codec=1, decoded=len(plain_lobes)),
        "skippable_cut": with_section("LOBE", zstandard(plain_lobes) + skippable(9)[:-1], codec=1,
                                      decoded=len(plain_lobes)),
        "diffuse_negative": with_section("LOBE", half + plain_lobes[2:]),
        "ceiling_negative": with_section("LOBE", plain_lobes[:6] + half + plain_lobes[8:]),
        "exponent_negative": with_section("LOBE", plain_lobes[:-2] + half),
        "lobe_infinite": with_section("LOBE", plain_lobes[:-8] + pack("e", [float("inf")]) + plain_lobes[-6:]),
        "view_below": patched("VIEW", 0, pack("f", [0, 0, -1])),
        "coefficient_128": patched("COEF", 3, b"\x80", 1),
        "kind_3": with_section("COMP", shared(kind=3)),
        "shared_other_count": with_section("COMP", shared(K=8)),
        "shared_cut": with_section("COMP", shared()[:-1]),
        "shared_reserved": with_section("COMP", shared(reserved=1)),
        "shared_no_views": with_section("COMP", shared(V=0)),
        "light_side_3": with_section("COMP", shared(light_side=3)),
        "smoothness_0": with_section("COMP", shared(view_smoothness=0)),
        "least_cosine_0": with_section("COMP", shared(least_cosine=0)),
        "threshold_negative": with_section("COMP", shared(threshold=-1)),
        "scale_nan": with_section("COMP", shared(scale=nan)),
        "light_on_horizon": with_section("COMP", shared(light=[(1, 0, 0)] + LIGHTS[1:])),
        "view_without_images": with_section("COMP", shared(first=[0, 0, 5])),
        "images_other": with_section("COMP", shared(first=[0, 3, 4])),
        "value_too_large": with_section("COMP", shared(code=4000)),
        "heights_low_above_high": with_section("HGHT", heights(low=0.5)),
        "heights_reserved": with_section("HGHT", heights(reserved=1)),
        "heights_size": with_section("HGHT", heights(places=(3, 3))),
        "heights_levels_0": with_section("HGHT", heights(levels=0)),
        "visibility_cell_2": with_section("VISI", visibility(cell=2)),
        "visibility_levels": with_section("VISI", visibility(levels=3)),
        "visibility_side_3": with_section("VISI", visibility(side=3)),
        "visibility_finer_17": with_section("VISI", visibility(finer=17)),
    }


def all_files():
    files = {"good/material/document_2.weft": material(sections())}
    files.update(("bad/material/%s_2.weft" % name, data) for name, data in bad_files().items())
    return files


def main(folder):
    differ = 0
    for name, data in all_files().items():
        if folder:
            path = os.path.join(folder, name)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            open(path, "wb").write(data)
        elif open(os.path.join(GOLDEN, name), "rb").read() != data:
            print(name, "differs")
            differ = 1
    return differ


sys.exit(main(sys.argv[1] if len(sys.argv) > 1 else None))
