"""Writes Display P3 as `chromaticities` into the heads of EXR files: exr_primaries.py FILE..."""
import struct
import sys

P3 = (0.68, 0.32, 0.265, 0.69, 0.15, 0.06, 0.3127, 0.3290)
ATTRIBUTE = b"chromaticities\0chromaticities\0" + struct.pack("<i8f", 32, *P3)


def end_of_header(data):
    """Behind the byte that ends the list of attributes: the table of blocks begins there."""
    at = 8
    while data[at]:
        for _ in range(2):
            at = data.index(b"\0", at) + 1
        at += 4 + struct.unpack_from("<i", data, at)[0]
    return at + 1


for name in sys.argv[1:]:
    data = open(name, "rb").read()
    table = end_of_header(data)
    first = struct.unpack_from("<q", data, table)[0]  # the blocks follow their table
    offsets = struct.unpack_from("<%dq" % ((first - table) // 8), data, table)
    moved = struct.pack("<%dq" % len(offsets), *(offset + len(ATTRIBUTE) for offset in offsets))
    open(name, "wb").write(data[:8] + ATTRIBUTE + data[8:table] + moved + data[first:])
