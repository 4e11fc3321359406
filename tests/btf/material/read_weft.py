"""Reads a .weft file with nothing but docs/reference/weft-format.md and Python's standard library: checks the
container and decodes one texel of every section that is stored without a codec
(codec 1 needs a Zstandard decoder; its checksum is checked)."""

import json
import math
import struct
import sys
import zlib


def read_header(data):
    assert data[:8] == bytes.fromhex("89574546540D0A1A"), "magic"
    names = "version sections size width height levels lobes views lights pitch reserved2 checksum".split()
    header = dict(zip(names, struct.unpack("<IIQIIIIIIdII", data[8:64])))
    table_end = 64 + 40 * header["sections"]
    assert header["version"] == 1 and header["size"] == len(data), "size"
    assert zlib.crc32(data[64:table_end], zlib.crc32(data[:60])) == header["checksum"], "checksum of the header"
    return header, table_end


def read_sections(data, header, end):
    sections = {}
    for i in range(header["sections"]):
        kind, level, codec, checksum, offset, stored, decoded = struct.unpack_from("<4sIIIQQQ", data, 64 + 40 * i)
        assert offset % 64 == 0 and 0 <= offset - end < 64 and not any(data[end:offset]), "place of " + kind.decode()
        body = data[offset : offset + stored]
        assert zlib.crc32(body) == checksum, "checksum of " + kind.decode()
        sections[kind.decode().strip(), level] = (body if codec == 0 else None, decoded)
        end = offset + stored
    assert end == len(data), "end"
    return sections


def expected_size(kind, header, texels):
    lobes, views, lights = header["lobes"], header["views"], header["lights"]
    return {"FRAM": 6, "RHO": 8, "LOBE": 24 * lobes, "TABL": 4 * views, "STAB": 4 * lights, "MODL": 1}[kind] * texels


def compact_size(kind, header, models):
    """Bytes of a section that leaves out the texels without such a part."""
    if kind == "LOBE":
        return sum(24 * min(model & 3, header["lobes"]) for model in models)
    shift, count = {"TABL": (2, header["views"]), "STAB": (4, header["lights"])}[kind]
    return sum(4 * count for model in models if model >> shift & 3)


def texel_of(kind, body):
    if kind == "FRAM":
        x, y, azimuth = (code / 32767 for code in struct.unpack_from("<3h", body))
        return {"normal": (x, y, math.sqrt(max(0, 1 - x * x - y * y))), "azimuth_rad": math.pi * azimuth}
    if kind == "TABL":
        return {"T": tuple((code / 255) ** 2 for code in body[:3]), "opacity": body[3] / 255}
    if kind == "STAB":
        return {"S": tuple((code / 255) ** 2 for code in body[:3])}
    if kind == "MODL":
        bits = (0, 4, 6, 8)
        return {"lobes": body[0] & 3, "bits of T": bits[body[0] >> 2 & 3], "bits of S": bits[body[0] >> 4 & 3]}
    return struct.unpack_from("<4e", body)


def main(path):
    data = open(path, "rb").read()
    header, table_end = read_header(data)
    sections = read_sections(data, header, table_end)
    print(header, json.loads(sections["META", 0][0]))
    width, height = header["width"], header["height"]
    models = ["MODL"] if ("MODL", 0) in sections else []
    for level in range(header["levels"]):
        optional = [("LOBE", "lobes"), ("TABL", "views"), ("STAB", "lights")]
        for kind in ["FRAM", "RHO"] + [kind for kind, count in optional if header[count] > 0] + models:
            body, decoded = sections[kind, level]
            if decoded != expected_size(kind, header, width * height):
                assert decoded == compact_size(kind, header, sections["MODL", level][0]), kind
                kind += ", compact"
            print(level, kind, texel_of(kind.split(",")[0], body) if body else "compressed")
        print(level, "ERRO", struct.unpack("<5d", sections["ERRO", level][0]))
        width, height = (width + 1) // 2, (height + 1) // 2


main(sys.argv[1])
