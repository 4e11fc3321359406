"""Opens the example dataset with h5py, as a user would, and checks shapes, types and values (tests/support/tiny_dataset.c)."""

import json
import sys

import h5py
import numpy as np

WIDTH, HEIGHT, VIEWS, LIGHTS = 6, 5, 3, 4
IMAGES = VIEWS * LIGHTS


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


f = h5py.File(sys.argv[1], "r")
assert text(f.attrs["format"]) == "weft btf" and f.attrs["version"] == 1
assert text(f.attrs["values"]) == "reflectance_cosine" and text(f.attrs["distance"]) == "far"
assert text(f.attrs["colour_space"]) == "linear Rec. 709" and f.attrs["texel_pitch_mm"] == 0.25
assert f["samples"].shape == (HEIGHT, WIDTH, IMAGES, 3) and f["samples"].dtype == np.float16
assert f["mask"].shape == (HEIGHT, WIDTH, IMAGES) and f["mask"].dtype == np.uint8
assert f["light"].shape == (IMAGES, 3) and f["view"].shape == (VIEWS, 3)
assert "opacity" not in f and json.loads(f["provenance"][()]) == {}

number = np.arange(HEIGHT * WIDTH * IMAGES).reshape(HEIGHT, WIDTH, IMAGES)
masked = number % 7 == 6
value = (1 + (3 * number[..., None] + np.arange(3)) % 2039) / 16
dark = masked & (number % 2 == 1)
assert np.array_equal(f["mask"][:], np.where(dark, 8, np.where(masked, 2, 0)))
assert np.array_equal(f["samples"][:], np.where(dark[..., None], 0, value).astype(np.float16))
assert np.array_equal(f["view_of_image"][:], np.arange(IMAGES) // LIGHTS)
assert np.allclose(f["light"][0], [0, 0, 1]) and np.allclose(f["light"][1], [np.sin(np.pi / 12), 0, np.cos(np.pi / 12)])
print(f["samples"], "agrees")
