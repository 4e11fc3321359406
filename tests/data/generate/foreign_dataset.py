#!/usr/bin/env python3
"""Remakes tests/golden/good/dataset/foreign.btf.h5: a dataset as somebody else's program may write it, with number
types, byte orders, kinds of strings, filters, attributes and datasets that Weft does not write.

    foreign_dataset.py FILE     writes it
    foreign_dataset.py          writes it beside, and compares it with the golden file; exit code 1 where they differ

What is compared is all that a reader of HDF5 gets: values to the last bit, types, shapes, chunks, filters. Nothing here
is Weft's. Needs python3-h5py and python3-numpy.
"""
import os
import sys
import tempfile

import h5py
import numpy as np

GOLDEN = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "golden/good/dataset/foreign.btf.h5")
ROWS, COLUMNS, IMAGES, VIEWS = 2, 3, 5, 3


def direction(theta_deg, phi_deg):
    theta, phi = np.radians(theta_deg), np.radians(phi_deg)
    return np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])


def frames():
    """A normal that leans by 5 degrees more at every texel, and a tangent across y."""
    frame = np.zeros((ROWS * COLUMNS, 2, 3))
    for i in range(ROWS * COLUMNS):
        normal = direction(5 * i, 70 * i)
        tangent = np.array([-normal[2], 0, normal[0]])
        frame[i] = normal, tangent / np.linalg.norm(tangent)
    return frame.reshape(ROWS, COLUMNS, 2, 3)


def masks():
    mask = np.zeros((ROWS, COLUMNS, IMAGES), dtype="<i2")
    mask[0, 0] = 0, 1, 2, 4, 7
    mask[1, 2, 3] = 6
    return mask


def samples():
    """Steps of a 64th; not a number where the mask says everything at once."""
    value = (np.arange(ROWS * COLUMNS * IMAGES * 3) / 64 - 0.125).astype("<f4").reshape(ROWS, COLUMNS, IMAGES, 3)
    value[0, 0, 4] = np.nan
    return value


def write(path):
    with h5py.File(path, "w") as file:
        file.attrs["format"] = "weft btf"
        file.attrs["version"] = 1
        file.attrs["values"] = np.bytes_("reflectance")
        file.attrs["distance"] = "far"
        file.attrs["texel_pitch_mm"] = np.float32(0.75)
        file.attrs["colour_space"] = "linear Rec. 709"
        file.attrs["camera"] = "an attribute that the format does not know"
        file["light"] = np.array([direction(20 * i if i < 4 else 89, 30 * i) for i in range(IMAGES)], dtype="<f4")
        file["view"] = np.array([direction(10, 200), direction(50, 10), direction(90, 45)], dtype=">f8")
        file["view_of_image"] = np.array([2, 0, 1, 1, 0], dtype=">i8")
        file["opacity"] = (np.arange(ROWS * COLUMNS * VIEWS) / 17).reshape(ROWS, COLUMNS, VIEWS)
        file["frame"] = frames()
        file["comment"] = np.arange(4)
        file["provenance"] = '{"made_by": "h5py", "note": "märz"}'
        file.create_dataset("mask", data=masks(), chunks=(2, 1, 5))
        file.create_dataset("samples", data=samples(), chunks=(1, 2, 5, 3), compression="gzip", compression_opts=4,
                            shuffle=True, fletcher32=True)


def described(item):
    """All that there is to know of a dataset; a string has no layout to speak of."""
    if h5py.check_string_dtype(item.dtype):
        return (str(item.dtype), item.shape, item[()])
    layout = (item.dtype.str, item.shape, item.chunks, item.compression, item.compression_opts, item.shuffle,
              item.fletcher32)
    return layout + (item[()].tobytes(),)


def contents(path):
    with h5py.File(path, "r") as file:
        found = {name: described(item) for name, item in file.items()}
        for name in file.attrs:
            value = file.attrs[name]
            found["@" + name] = (type(value).__name__, value)
        return found


def compare(path):
    made, golden = contents(path), contents(GOLDEN)
    wrong = [name for name in sorted(set(made) | set(golden)) if made.get(name) != golden.get(name)]
    for name in wrong:
        print(f"{name}: {made.get(name)} instead of {golden.get(name)}")
    print(f"foreign.btf.h5: {len(golden)} attributes and datasets, {len(wrong)} differ")
    return 1 if wrong else 0


def main():
    if len(sys.argv) > 1:
        write(sys.argv[1])
        return 0
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "foreign.btf.h5")
        write(path)
        return compare(path)


if __name__ == "__main__":
    sys.exit(main())
