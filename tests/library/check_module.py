"""The module for Python against the values that the example printed, and its errors. Usage: check_module.py NAME.weft VALUES"""
import re
import sys

import numpy as np

import weft

cloth = weft.open(sys.argv[1])
printed = np.array([[float(x) for x in re.findall(r"\d+\.\d+", line)] for line in open(sys.argv[2])])
theta = 1.4 * np.arange(8) / 8
view = np.stack([0 * theta, -np.sin(theta), np.cos(theta)], axis=-1)
light = (0, 0.6, 0.8)
brdf = cloth.eval(printed[:, 0], printed[:, 1], light, view, printed[:, 2])
assert brdf.shape == (8, 3) and np.allclose(brdf, printed[:, 3:], atol=1e-4), brdf
level = cloth.level_of_footprint(0.01, 0, 0, 0.01 / np.cos(theta[7]))
assert abs(level - printed[7, 2]) < 0.005 and cloth.level_count > 1

# Broadcasting: a grid of places by many views; the same values one by one.
u = np.linspace(0, 1, 5)[:, None]
grid = cloth.eval(u, 0.25, 2 * np.array(light), view)
assert grid.shape == (5, 8, 3)
assert np.array_equal(grid[3, 2], cloth.eval(u[3, 0], 0.25, light, view[2]))
many = cloth.eval(np.tile(u, 40), 0.25, light, (0, 0, 1))
assert many.shape == (5, 40, 3) and np.array_equal(many[:, 0], many[:, 39])
opacity = cloth.opacity(u, 0.25, view)  # of a knit: it has holes
assert opacity.shape == (5, 8) and opacity.min() >= 0 and 0 < opacity.max() <= 1
assert cloth.mean(light, view).shape == (8, 3)
assert not cloth.eval(0, 0, (0, 0, -1), (0, 0, 1)).any()


def expect(error, part, function, *arguments):
    try:
        function(*arguments)
    except error as found:
        assert part in str(found), found
        return found
    raise AssertionError(f"no {error.__name__}: {part}")


assert expect(weft.Error, "absent.weft", weft.open, "absent.weft").code == 0x11
expect(weft.Error, "level -1", cloth.eval, 0, 0, light, light, -1)
expect(weft.Error, "no direction", cloth.eval, 0, 0, light, (0, 0, 0))
expect(ValueError, "(..., 3)", cloth.eval, 0, 0, 1, light)
assert re.fullmatch(r"\d+\.\d+\.\d+", weft.version)
