"""Reads a .weft file of version 2 with nothing but docs/reference/weft-format.md and Python's standard library: checks
the container and decodes one texel of every section that is stored without a codec (codec 1 needs a Zstandard decoder;
its checksum is checked)."""

import json
import math
import struct
import sys
import zlib

LOBES, COMPONENTS, VIEWS, OPACITY, HEIGHTS, VISIBILITY = 1, 2, 4, 8, 1 << 16, 1 << 17
KNOWN = LOBES | COMPONENTS | VIEWS | OPACITY


def read_header(data):
    assert data[:8] == bytes.fromhex("89574546540D0A1A"), "magic"
    names = "version sections size width height levels lobes views features pitch components checksum".split()
    header = dict(zip(names, struct.unpack("<IIQIIIIIIdII", data[8:64])))
    table_end = 64 + 40 * header["sections"]
    assert header["version"] == 2 and header["size"] == len(data), "size"
    assert zlib.crc32(data[64:table_end], zlib.crc32(data[:60])) == header["checksum"], "checksum of the header"
    assert header["features"] & 0xFFFF & ~KNOWN == 0, "written by a newer Weft"
    return header, table_end


def read_sections(data, header, end):
    sections = {}
    for i in range(header["sections"]):
        kind, level, codec, checksum, offset, stored, decoded = struct.unpack_from("<4sIIIQQQ", data, 64 + 40 * i)
        assert offset % 64 == 0 and 0 <= offset - end < 64 and not any(data[end:offset]), "place of " + kind.decode()
        body = data[offset : offset + stored]
        assert zlib.crc32(body) == checksum, "checksum of " + kind.decode()
        sections[kind.decode(), level] = (body if codec == 0 else None, decoded)
        end = offset + stored
    assert end == len(data), "end"
    return sections


def bytes_of_a_texel(header):
    """Of each kind of section of levels that this file has; without the bounds, which squares of texels share."""
    features = header["features"]
    kinds = []
    if features & LOBES:
        kinds += [("FRAM", 6), ("LOBE", 8 + 24 * header["lobes"])]
    if features & LOBES and features & VIEWS:
        kinds.append(("TABL", 3 * header["views"]))
    if features & OPACITY:
        kinds.append(("ALPH", header["views"]))
    if features & COMPONENTS:
        kinds.append(("COEF", header["components"]))
    return kinds


def texel_of(kind, body, header, texels):
    if kind == "FRAM":
        x, y, azimuth = (code / 32767 for code in struct.unpack_from("<3h", body))
        return {"normal": (x, y, math.sqrt(max(0, 1 - x * x - y * y))), "azimuth_rad": math.pi * azimuth}
    if kind == "LOBE":
        lobes = [struct.unpack_from("<4e", body, 8 * texels * (1 + 3 * lobe)) for lobe in range(header["lobes"])]
        return {"rho and ceiling": struct.unpack_from("<4e", body), "red lobes": lobes}
    if kind == "TABL":
        return {"T": tuple((code / 255) ** 2 for code in body[:3])}
    if kind == "ALPH":
        return {"opacity": body[0] / 255}
    return struct.unpack_from("<4b", body)


def main(path):
    data = open(path, "rb").read()
    header, table_end = read_header(data)
    sections = read_sections(data, header, table_end)
    print(header, json.loads(sections["META", 0][0]))
    width, height = header["width"], header["height"]
    for level in range(header["levels"]):
        for kind, size in bytes_of_a_texel(header):
            body, decoded = sections[kind, level]
            assert decoded == size * width * height, kind
            print(level, kind, texel_of(kind, body, header, width * height) if body else "compressed")
        print(level, "ERRO", struct.unpack_from("<5d", sections["ERRO", 0][0], 40 * level))
        width, height = (width + 1) // 2, (height + 1) // 2


main(sys.argv[1])
