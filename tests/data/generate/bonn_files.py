#!/usr/bin/env python3
"""Remakes tests/golden/good/bonn and tests/golden/bad/bonn: binary BTF files as the University of Bonn publishes them.

    bonn_files.py FOLDER        writes good/ and bad/ below FOLDER
    bonn_files.py               makes them, and compares them with the golden files; exit code 1 where they differ
    bonn_files.py --cloth FILE  writes a larger file that can be compressed: 13 views, 13 lights, 16 x 16 texels

All good files hold the same images, which a formula gives; the matrices are made of the images, by a singular value
decomposition or so that their product is exact. So what a reader must find is known before there is a file, and is
written to pictures.values. The layout is that of docs/reference/import-layouts.md, written a second time: nothing here
is Weft's. What is compared is all but the numbers of the matrices, to the last byte, and the products of the matrices.
Needs python3-numpy.
"""
import os
import struct
import sys

import numpy as np

GOLDEN = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "golden")
OFFSET = 1e-5
YUV = np.array([[1, 0, 1.13983], [1, -0.39465, -0.5806], [1, 2.03211, 0]])
YCOCG = np.array([[1.0, 1, -1], [1, 0, 1], [1, -1, -1]])
AXES = np.array([[0.6, 0.64, 0.48], [-0.8, 0.48, 0.36], [0.0, -0.6, 0.8]])
MEAN = np.array([0.5, 0.375, 0.25])
SCALAR = {2: "<f2", 4: "<f4", 8: "<f8"}

# ---- Images and directions ----

VIEWS = [(35, 20), (0, 0), (60, 250)]
LIGHTS = [(45, 130), (15, 300), (0, 0), (75, 10)]
WIDTH, HEIGHT = 6, 3


def images():
    """[view][light][y][x][channel] in steps of a 64th. The texel at the top right is a highlight. Blue has few
    components."""
    result = np.zeros((len(VIEWS), len(LIGHTS), HEIGHT, WIDTH, 3))
    for v, l, y, x in np.ndindex(result.shape[:4]):
        shine = 170 + 16 * l + 3 * v if (x, y) == (WIDTH - 1, 0) else 0
        red = 9 + 4 * x + 7 * y + 2 * v + (2 * l + x) % 5 + 7 * v * ((x + y + l) % 3) + shine
        green = 3 + x + 2 * y + 3 * v + (x * y + l) % 4 + (v * x + l) % 3 + shine
        blue = 18 + 5 * x + y + 2 * v * l + (20 * l if (x, y) == (WIDTH - 1, 0) else 0)
        result[v, l, y, x] = np.array([red, green, blue]) / 64
    return result


def wide_images():
    """Of one view and two lights, more texels than are multiplied at once."""
    y, x = np.mgrid[0:11, 0:13]
    first = np.stack([8 + x + 2 * y, 40 + x - y, 3 * y + (x % 4)], -1) / 64
    return np.stack([first, first[::-1] / 2 + first])[None]


def many_images():
    """Two texels of more images than are made at once, each another."""
    place = np.arange(5 * 7 * 2).reshape(5, 7, 1, 2)
    return np.stack([1 + place, 100 - place, 3 + 7 * place % 64], -1) / 64


def direction(theta_deg, phi_deg):
    """As a reader finds it who takes the angles of the file, which are single precision."""
    theta, phi = (float(np.float32(np.radians(a))) for a in (theta_deg, phi_deg))
    return np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)


# ---- Files: a list of bytes and of pairs of matrices ----


class Pair:
    """left [rows][components], right [columns][components]."""

    def __init__(self, size, left, right):
        self.size, self.left, self.right = size, np.asarray(left), np.asarray(right)

    def scalars(self):
        singular = np.linalg.norm(self.right, axis=0)
        return [singular.astype(SCALAR[self.size]), *(m.astype(SCALAR[self.size]) for m in (self.left, self.right))]

    def sizes(self):
        return struct.pack("<BIII", self.size, self.left.shape[1], self.left.shape[0], self.right.shape[0])


def decomposed(matrix, size, transposed=False):
    """By singular values, without those that are rounding."""
    if transposed:
        matrix = matrix.T
    left, values, right = np.linalg.svd(matrix, full_matrices=False)
    count = max(1, int(np.sum(values > 1e-10 * values[0])))
    return Pair(size, left[:, :count], right[:count].T * values[:count])


def summed(matrix, size):
    """Each row is the one before it and a difference: exact where the differences are."""
    rows = matrix.shape[0]
    return Pair(size, np.tril(np.ones((rows, rows))), np.diff(matrix, axis=0, prepend=0).T)


def description(version=4, cosine=0, names=(b"R", b"G", b"B"), scale=(1, 1, 1), pixels_per_mm=4, xml=b"<setup/>",
                off=0):
    words = b"Dome 1".ljust(80, b"\0") + b"a camera".ljust(80, b"\0") + b"151 lamps".ljust(80, b"\0")
    body = struct.pack("<I", version) + words + struct.pack("<4f", pixels_per_mm, *scale)
    if version > 1:
        body += struct.pack("<I", cosine)
    if version > 2:
        body += struct.pack("<I", len(xml)) + xml
    if version > 3:
        body += struct.pack("<I", len(names)) + b"".join(struct.pack("<I", len(n)) + n for n in names)
    return struct.pack("<I", 4 + len(body) + off) + body


def directions(views=VIEWS, lights=LIGHTS):
    radians = lambda angles: struct.pack("<2f", *np.radians(angles))
    each = struct.pack("<I", len(lights)) + b"".join(radians(l) for l in lights)
    return struct.pack("<I", len(views)) + b"".join(radians(v) + each for v in views)


def extent(width=WIDTH, height=HEIGHT, frames=None):
    text = struct.pack("<2I", width, height)
    if frames is None:
        return text
    return text + struct.pack("<I", len(frames)) + np.asarray(frames, dtype="<f4").tobytes()


def colour(model, mean=(0, 0, 0), axes=np.eye(3), most=12):
    return struct.pack("<Ii", most, model) + struct.pack("<3f", *mean) + np.asarray(axes, dtype="<f4").tobytes()


def bytes_of(parts):
    whole = b""
    for part in parts:
        whole += part if isinstance(part, bytes) else part.sizes() + b"".join(s.tobytes() for s in part.scalars())
    return whole


# ---- Colour models: the channels that make RGB ----


def signed_log(value):
    assert np.all(np.abs(value) > 1e-3), "0 has no logarithm"
    return np.sign(value) * (np.log(np.abs(value)) - np.log(OFFSET))


def channels_of(rgb, model):
    yuv = rgb @ np.linalg.inv(YUV).T
    y, u, v = np.moveaxis(yuv, -1, 0)
    if model == 0:
        return rgb
    if model == 1:
        return yuv
    if model == 3:
        return (rgb - MEAN) @ np.linalg.inv(AXES.astype("<f4").astype(float))
    if model == 4:
        return rgb @ np.linalg.inv(YCOCG).T
    if model == 5:
        total = rgb.sum(-1)
        return np.stack([total, rgb[..., 1] / total, rgb[..., 2] / total], -1)
    log_y = np.log(y + OFFSET)
    if model == 9:
        return np.stack([log_y, u, v], -1)
    if model == 10:
        return np.stack([log_y, signed_log(u), signed_log(v)], -1)
    if model == 11:
        return np.stack([log_y, u / (y + OFFSET), v / (y + OFFSET)], -1)
    assert model == 12
    return np.log(rgb + OFFSET)


# ---- Good files ----


def by_channel(rgb):
    """[channel][image][texel]"""
    views, lights = rgb.shape[:2]
    return np.moveaxis(rgb.reshape(views * lights, -1, 3), -1, 0)


def joint(rgb):
    """[image, its channels following one another][texel]"""
    return np.moveaxis(by_channel(rgb), 0, 1).reshape(-1, rgb.shape[2] * rgb.shape[3])


def dfmf(model=0, sizes=(4, 4, 4), frames=(), make=decomposed, rgb=None, head=None, places=directions(),
         extents=None):
    rgb = images() if rgb is None else rgb
    channels = by_channel(channels_of(rgb, model))
    signature = b"!DFMF08FC" if frames is None else b"!DFMF08FCR"
    text = colour(model, MEAN, AXES) if model == 3 else colour(model)
    parts = [signature, head or description(), places, extents or extent(frames=frames), text]
    return parts + [make(c, s) for c, s in zip(channels, sizes)]


def fmf(signature, header=b"", logarithm=False, make=decomposed, size=4, transposed=False):
    rgb = images()
    matrix = joint(np.log(rgb + OFFSET) if logarithm else rgb)
    if transposed:
        by_texel = np.moveaxis(by_channel(rgb), 0, -1)
        matrix = np.moveaxis(by_texel, 0, -1).reshape(-1, len(VIEWS) * len(LIGHTS))
    frames = () if signature.endswith(b"R") else None
    return [signature, description(), directions(), extent(frames=frames), header, struct.pack("<I", 12), make(matrix, size)]


def leaning_frames():
    """Tangent, bitangent, normal of each texel; the normal leans by 3 degrees more at every texel. No number is near 0,
    so that all keep their digits."""
    result = []
    for i in range(WIDTH * HEIGHT):
        a, b = np.radians(20 + 3 * i), np.radians(40 + 88 * i)
        normal = np.array([np.sin(a) * np.cos(b), np.sin(a) * np.sin(b), np.cos(a)])
        tangent = np.cross([0.2, 1, 0.3], normal)
        tangent /= np.linalg.norm(tangent)
        result.append(np.concatenate([tangent, np.cross(normal, tangent), normal]))
    return np.array(result)


WIDE_VIEWS, WIDE_LIGHTS = [(20, 45)], [(50, 200), (10, 100)]
MANY_VIEWS, MANY_LIGHTS = [(9 * (i + 1), 80 * i) for i in range(5)], [(80 - 10 * i, 50 * i) for i in range(7)]


def good_files():
    heights = struct.pack("<2I", 3, 2) + np.arange(6).astype("<f2").tobytes()
    transposed = lambda matrix, size: decomposed(matrix, size, True)
    return {
        "rgb": dfmf(),
        "rgb_half": dfmf(sizes=(2, 2, 2), make=summed, frames=None, head=description(version=1)),
        "rgb_double": dfmf(sizes=(8, 8, 8), head=description(version=2)),
        "rgb_cosine": dfmf(head=description(version=3, cosine=1)),
        "rgb_transposed": dfmf(make=transposed),
        "rgb_and_more": dfmf() + [b"\0"],
        "rgb_frames": dfmf(frames=leaning_frames()),
        "wide": dfmf(rgb=wide_images(), places=directions(WIDE_VIEWS, WIDE_LIGHTS), extents=extent(13, 11, ())),
        "many": dfmf(rgb=many_images(), places=directions(MANY_VIEWS, MANY_LIGHTS), extents=extent(2, 1, ())),
        "yuv": dfmf(1),
        "axes": dfmf(3),
        "ycocg": dfmf(4),
        "sum": dfmf(5),
        "log_y": dfmf(9),
        "log_yuv": dfmf(10),
        "log_y_ratio": dfmf(11, sizes=(4, 8, 4)),
        "log_rgb": dfmf(12),
        "joint": fmf(b"!FMF06FC"),
        "joint_half": fmf(b"!FMF06FCR", make=summed, size=2),
        "joint_transposed": fmf(b"!FMF06FC", transposed=True),
        "joint_header_0": fmf(b"!FMF12FCE", b"\0"),
        "joint_header_1": fmf(b"!FMF12FCE", b"\1" + struct.pack("<I", 0)),
        "joint_log": fmf(b"!FMF12FCER", b"\2" + struct.pack("<I", 1) + heights, logarithm=True),
    }


def values_text(rgb, views=VIEWS, lights=LIGHTS, cosine=False, frames=None):
    """What the dataset holds, in the words of `golden print`: sorted by view and light, from the normal down."""
    order = lambda angles: sorted(range(len(angles)), key=lambda i: (-direction(*angles[i])[2], *direction(*angles[i])))
    vector = lambda v: "".join(" %.9g" % n for n in v)
    height, width = rgb.shape[2:4]
    lines = ["texels: %d x %d pitch_mm: 0.25" % (width, height)]
    lines += ["values: reflectance times cosine" if cosine else "values: reflectance", "lights and views: directions"]
    lines += ["view %d:%s" % (i, vector(direction(*views[v]))) for i, v in enumerate(order(views))]
    pairs = [(i, v, l) for i, v in enumerate(order(views)) for l in order(lights)]
    for n, (i, v, l) in enumerate(pairs):
        lines.append("image %d: view %d light:%s" % (n, i, vector(direction(*lights[l]))))
    for y, x in np.ndindex(height, width):
        lines.append("texel %d %d" % (x, y))
        if frames is not None:
            tangent, normal = frames[y * width + x][:3], frames[y * width + x][6:]
            lines.append("  frame:" + vector(np.concatenate([normal, tangent]).astype("<f4")))
        lines += ["  image %d mask 0:%s" % (n, vector(rgb[v, l, y, x])) for n, (i, v, l) in enumerate(pairs)]
    return "\n".join(lines) + "\n"


def texts():
    return {
        "pictures.values": values_text(images()),
        "rgb_cosine.values": values_text(images(), cosine=True),
        "rgb_frames.values": values_text(images(), frames=leaning_frames()),
        "wide.values": values_text(wide_images(), WIDE_VIEWS, WIDE_LIGHTS),
        "many.values": values_text(many_images(), MANY_VIEWS, MANY_LIGHTS),
    }


# ---- Bad files ----


def bad_files():
    rgb = images()[:1, :2, :1, :2]
    places = directions([(0, 0)], [(15, 0), (15, 90)])
    size = extent(2, 1, ())
    good = lambda **with_: dfmf(rgb=rgb, places=with_.pop("places", places), extents=with_.pop("extents", size), **with_)
    cut = lambda parts, count: [bytes_of(parts[:count])[:-1]]
    whole = bytes_of(good())
    matrices = len(bytes_of(good()[:5]))
    patched = lambda at, new: [whole[:at] + new + whole[at + len(new):]]
    nan = np.array([np.nan], dtype="<f4").tobytes()
    header = lambda text: [b"!FMF12FCE", description(), places, extent(2, 1), text]
    bright = rgb.copy()
    bright[0, 1, 0, 1, 2] = 70000
    components = struct.unpack("<I", whole[matrices + 1:matrices + 5])[0]
    first_left = matrices + 13 + 4 * components
    return {
        "each_view": [b"!PVF06FCR", *good()[1:]],
        "not_factored": [b"!BDIF06R2!", *good()[1:]],
        "unknown_signature": [b"!XFMF08FCR", *good()[1:]],
        "version_5": good(head=description(version=5)),
        "description_size": good(head=description(off=4)),
        "xml_beyond_end": good(head=description()[:268] + struct.pack("<I", 1 << 31) + description()[272:]),
        "spectrum": good(head=description(names=(b"400", b"500.5", b"600"))),
        "channels_29": good(head=description(names=[b"%d" % n for n in range(400, 690, 10)])),
        "view_below": good(places=directions([(95, 0)], [(15, 0), (15, 90)])),
        "light_nowhere": good(places=directions([(0, 0)], [(15, 0), (np.nan, 90)])),
        "light_twice": good(places=directions([(0, 0)], [(15, 0), (15, 0)])),
        "no_views": good(places=directions([], [(15, 0)])),
        "no_lights": good(places=directions([(0, 0)], [])),
        "lights_differ": good(places=struct.pack("<I", 2) + directions([(0, 0)], LIGHTS[:2])[4:]
                              + directions([(10, 0)], LIGHTS[:3])[4:]),
        "views_many": good(places=struct.pack("<I", 2 ** 32 - 1) + places[4:]),
        "lights_many": good(places=places[:12] + struct.pack("<I", 2 ** 24) + places[16:]),
        "no_texels": good(extents=extent(0, 1, ())),
        "texels_many": good(extents=extent(2 ** 16, 2 ** 16, ())),
        "frames_many": good(extents=extent(2, 1) + struct.pack("<I", 2 ** 32 - 1)),
        "lab": [*good()[:4], colour(2), *good()[5:]],
        "model_unknown": [*good()[:4], colour(7), *good()[5:]],
        "axes_infinite": [*good()[:4], colour(3, axes=np.full((3, 3), np.inf)), *good()[5:]],
        "numbers_of_3_bytes": patched(matrices, b"\3"),
        "no_components": patched(matrices + 1, struct.pack("<I", 0)),
        "components_above_images": patched(matrices + 1, struct.pack("<I", 3)),
        "other_images": patched(matrices + 5, struct.pack("<I", 3)),
        "sizes_overflow": patched(matrices + 1, struct.pack("<3I", 2 ** 31, 2 ** 31, 2 ** 31)),
        "matrix_nan": patched(first_left, nan),
        "matrix_infinite": patched(first_left + 4, struct.pack("<I", 0x7f800000)),
        "too_bright": dfmf(rgb=bright, places=places, extents=size),
        "header_unknown": header(b"\3" + bytes(8)),
        "heights_many": header(b"\2" + struct.pack("<3I", 0, 2 ** 32 - 1, 2 ** 32 - 1)),
        "joint_sizes": header(b"\0" + struct.pack("<I", 1)) + [decomposed(joint(rgb)[:3], 4)],
        "newer_signature": [b"!DFMF09FCR", *good()[1:]],
        "cut_signature": [b"!DFMF"],
        "cut_description": cut(good(), 2),
        "cut_directions": cut(good(), 3),
        "cut_size": [bytes_of(good()[:3]) + size[:7]],
        "cut_model": cut(good(), 5),
        "cut_matrix": cut(good(), 6),
        "cut_last": cut(good(), 8),
    }


# ---- A larger file ----


def cloth():
    """A weave of shining threads, 4 texels wide, with a red corner at the top left and a blue one at the bottom right."""
    ring = lambda theta, count: [(theta, 360 * i / count) for i in range(count)]
    places = [(0, 0)] + ring(30, 4) + ring(60, 8)
    width, height = 16, 16
    y, x = np.mgrid[0:height, 0:width]
    warp = (x // 4 + y // 4) % 2
    rgb = np.zeros((len(places), len(places), height, width, 3))
    for v, view in enumerate(places):
        for l, light in enumerate(places):
            half = np.add(direction(*view), direction(*light))
            half /= np.linalg.norm(half)
            along = np.where(warp == 1, half[1], half[0])
            level = 0.15 + 0.1 * warp + 2 * np.exp(-30 * along ** 2) * half[2] ** 8
            rgb[v, l] = level[..., None] * np.array([0.9, 0.7, 0.4])
    rgb[:, :, :4, :4] = [0.9, 0.02, 0.02]
    rgb[:, :, -4:, -4:] = [0.02, 0.02, 0.9]
    parts = [b"!DFMF08FCR", description(pixels_per_mm=2), directions(places, places), extent(width, height, ()), colour(11)]
    return parts + [decomposed(c, 4) for c in by_channel(channels_of(rgb, 11))]


# ---- Writing and comparing ----


def write_all(folder):
    for kind, files in (("good", good_files()), ("bad", bad_files())):
        os.makedirs(os.path.join(folder, kind), exist_ok=True)
        for name, parts in files.items():
            with open(os.path.join(folder, kind, name + ".btf"), "wb") as file:
                file.write(bytes_of(parts))
    for name, text in texts().items():
        with open(os.path.join(folder, "good", name), "w") as file:
            file.write(text)


def same(path, parts):
    """Whether the file holds these parts; of matrices whether their product is this one."""
    with open(path, "rb") as file:
        whole = file.read()
    at = 0
    for part in parts:
        head = part if isinstance(part, bytes) else part.sizes()
        if whole[at:at + len(head)] != head:
            return False
        at += len(head)
        if isinstance(part, bytes):
            continue
        found = []
        for scalars in part.scalars():
            found.append(np.frombuffer(whole, SCALAR[part.size], scalars.size, at).reshape(scalars.shape).astype(float))
            at += scalars.nbytes
        expected = part.left @ part.right.T
        if not np.allclose(found[1] @ found[2].T, expected, rtol=0, atol=2e-6 * np.abs(expected).max()):
            return False
    return at == len(whole)


def compare_all():
    wrong = 0
    for kind, files in (("good", good_files()), ("bad", bad_files())):
        folder = os.path.join(GOLDEN, kind, "bonn")
        for name, parts in files.items():
            if not same(os.path.join(folder, name + ".btf"), parts):
                print("%s/%s.btf differs" % (kind, name))
                wrong += 1
    for name, text in texts().items():
        if open(os.path.join(GOLDEN, "good", "bonn", name)).read() != text:
            print("good/%s differs" % name)
            wrong += 1
    print("bonn: %d files, %d differ" % (len(good_files()) + len(bad_files()) + len(texts()), wrong))
    return wrong == 0


if __name__ == "__main__":
    if len(sys.argv) == 3 and sys.argv[1] == "--cloth":
        with open(sys.argv[2], "wb") as output:
            output.write(bytes_of(cloth()))
    elif len(sys.argv) == 2:
        write_all(sys.argv[1])
    else:
        sys.exit(0 if compare_all() else 1)
