"""A capture with a rig of one's own: somebody sets the axes and takes the photographs, as he is asked to.

Usage: rig.py WEFT ASSETS; in a scratch folder. Stands in for both: answers the questions, and drops the photographs.
"""
import json
import math
import os
import re
import shutil
import subprocess
import sys

WEFT, ASSETS = sys.argv[1:3]
SIDE, BIN = 96, 2
LENS = {"weft_lens": 1, "board": "none", "width": SIDE, "height": SIDE, "fx": 440, "fy": 440, "cx": (SIDE - 1) / 2,
        "cy": (SIDE - 1) / 2, "k1": 0, "k2": 0, "vignetting": [0, 0, 0], "standard_error": {}, "rms_px": 0, "used": [],
        "left_out": []}
COMMAND = [WEFT, "capture", "--rig", "rig.conf", "--sample", "a scarf", "--plan", "plan.csv", "-o", "session", "--json"]
PLAN = [(0, 0, 30, 0), (40, 90, 30, 0), (20, 180, 60, 90), (20, 90, 30, 0), (40, 90, 60, 90)]


def write(path, text):
    with open(path, "w", encoding="ascii") as file:
        file.write(text)


def prepare():
    text = open(ASSETS + "/rigs/photographs.conf", encoding="ascii").read()
    text = text.replace("nominal.lens.json", "lens.json").replace("bin = 4", f"bin = {BIN}")
    text = text.replace("settle_s = 5", "settle_s = 0")
    text = text.replace('pattern = "*.tif"', 'pattern = "*.pgm"')
    write("rig.conf", text)
    write("lens.json", json.dumps(LENS))
    write("plan.csv", "theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n" +
          "".join("%g,%g,%g,%g\n" % row for row in PLAN))
    os.makedirs("incoming", exist_ok=True)


def matrix(degrees):
    """The rotation by a vector (Rodrigues)."""
    w = [math.radians(d) for d in degrees]
    angle = math.hypot(*w)
    x, y, z = (v / angle for v in w)
    c, s = math.cos(angle), math.sin(angle)
    return [[c + x * x * (1 - c), x * y * (1 - c) - z * s, x * z * (1 - c) + y * s],
            [y * x * (1 - c) + z * s, c + y * y * (1 - c), y * z * (1 - c) - x * s],
            [z * x * (1 - c) - y * s, z * y * (1 - c) + x * s, c + z * z * (1 - c)]]


def rotation_vector(rows):
    angle = math.acos((rows[0][0] + rows[1][1] + rows[2][2] - 1) / 2)
    across = [rows[2][1] - rows[1][2], rows[0][2] - rows[2][0], rows[1][0] - rows[0][1]]
    return [math.degrees(angle) * v / (2 * math.sin(angle)) for v in across]


def photograph(number):
    """A grey picture of 16 bits whose level says which one it is."""
    side, level = SIDE * BIN, 20000 + 1000 * number
    with open("incoming/shot.pgm", "wb") as file:
        file.write(b"P5 %d %d 65535\n" % (side, side) + level.to_bytes(2, "big") * (side * side))
    return level


def run(stop_after=None, *more):
    """Serves a capture; returns its exit code, its notes and, for each photograph, where the axes stood."""
    process = subprocess.Popen(COMMAND + list(more), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               text=True)
    axes, taken, notes = {}, [], []
    for line in process.stdout:
        event = json.loads(line)
        if event["event"] == "note":
            notes.append(event["text"])
        if event["event"] != "ask":
            continue
        if len(taken) == stop_after:
            process.stdin.close()
            process.stdin = None
            break
        moved = re.fullmatch(r"Set the axis '(.*)' to (.*) degrees\.", event["text"])
        if moved:
            axes[moved[1]] = float(moved[2])
        else:
            assert event["text"].startswith("Take the photograph, exposed for 0.25 s"), event
            taken.append((dict(axes), photograph(len(taken))))
        process.stdin.write("\n")
        process.stdin.flush()
    out, err = process.communicate(timeout=60)
    notes += [json.loads(line).get("text", "") for line in out.splitlines()]
    return process.returncode, notes, taken, err


def journal():
    return [json.loads(line) for line in open("session/journal.jsonl", encoding="ascii")]


def check_poses(taken, lines):
    """The axes stood where the plan has them, and each photograph lies where its pose says."""
    session = json.load(open("session/session.json", encoding="ascii"))
    for (axes, level), line in zip(taken, lines):
        shot = session["plan"][line["shot"]]
        wanted = {"camera elevation": shot["view"][0], "camera azimuth": shot["view"][1],
                  "lamp elevation": shot["light"][0], "lamp azimuth": shot["light"][1]}
        for name, angle in wanted.items():
            assert abs((axes[name] - angle + 180) % 360 - 180) < 0.01, (axes, shot)
        assert line["exposure_s"] == 0.25, line
        for name, turn in zip(("camera elevation", "camera azimuth"), shot["turns_deg"]):
            assert abs(axes[name] - turn) < 0.01, (axes, shot)
        name = "tl%03d_pl%03d_tv%03d_pv%03d" % tuple(round(a) for a in shot["light"] + shot["view"])
        folder = "session/" + name[12:]
        original = open(f"{folder}/{name}.original.pgm", "rb").read()
        assert int.from_bytes(original[-2:], "big") == level, name
        assert os.path.exists(f"{folder}/{name}.tif"), name


prepare()
code, notes, _, err = run(None, "--dry-run")
assert code == 0 and any("h for" in note and "moves" in note for note in notes), (notes, err)
assert not os.path.exists("session"), "a rehearsal wrote"

# With standard input closed from the start nobody is waited for.
closed = subprocess.run(COMMAND, preexec_fn=lambda: os.close(0), capture_output=True, text=True, timeout=60)
assert closed.returncode == 3 and "Standard input is closed, so nobody can press Enter." in closed.stderr, closed
assert not os.path.exists("session/journal.jsonl"), "a photograph was taken"

# The operator leaves after two photographs; the session goes on when he is back.
code, _, first, err = run(stop_after=2)
assert code == 3 and "Standard input is closed" in err, (code, err)
assert len(first) == 2 and len(journal()) == 2
code, notes, second, err = run()
assert code == 0, err
assert len(second) == len(PLAN) - 2, second
check_poses(first + second, journal())

# A pose is asked for axis by axis, and only of what changes.
shutil.rmtree("session")
code, _, taken, err = run()
assert code == 0 and len(taken) == len(PLAN), err
check_poses(taken, journal())

# A rig whose axes are known: a camera that sits 2 degrees too low on its arm, and a file of another camera.
shutil.rmtree("session")
joint = {"point_mm": [0, 0, 0], "scale": 0, "uneven_deg": [0, 0], "wobble_deg": [0, 0, 0, 0]}
joints = [dict(joint, turns=turns, direction=direction) for turns, direction in
          (("camera theta", [0, -1, 0]), ("camera phi", [0, 0, -1]), ("sample phi", [0, 0, 1]))]
# Of a camera at the zenith: x of its picture is y of the plate, y is x. With 2 degrees more about y of the plate:
tilt = math.radians(2)
rows = [[0, 1, 0], [math.cos(tilt), 0, -math.sin(tilt)], [-math.sin(tilt), 0, -math.cos(tilt)]]
poses = {"weft_poses": 1, "camera": {key: LENS[key] for key in ("width", "height", "fx", "fy", "cx", "cy", "k1", "k2",
                                                              "vignetting")},
         "home": {"rotation_deg": rotation_vector(rows), "translation_mm": [0, 0, 500]}, "joints": joints}
write("rig.poses.json", json.dumps(poses))
write("rig.conf", open("rig.conf", encoding="ascii").read().replace("opening_mm = 40", 'opening_mm = 40\nposes = "rig.poses.json"'))
code, _, taken, err = run()
assert code == 0 and len(taken) == len(PLAN), err
for shot in json.load(open("session/session.json", encoding="ascii"))["plan"]:
    row = matrix(shot["pose"][:3])
    camera = [-sum(row[k][i] * shot["pose"][3 + k] for k in range(3)) for i in range(3)]
    theta = math.degrees(math.acos(camera[2] / 500))
    assert abs(theta - shot["view"][0] - 2) < 1e-6, (camera, shot)
poses["camera"]["width"] = 97
write("rig.poses.json", json.dumps(poses))
code, _, _, err = run()
assert code == 1 and "is for photographs of 97 x 96 pixels" in err, err
write("rig.conf", open("rig.conf", encoding="ascii").read().replace('poses = "rig.poses.json"', ""))
shutil.rmtree("session")
code, _, taken, err = run()
assert code == 0, err

# The settings of the rig are part of the session.
write("rig.conf", open("rig.conf", encoding="ascii").read().replace('name = "folder', 'name = "another folder'))
code, _, _, err = run()
assert code == 1 and "another 'rig_name'" in err, err
write("rig.conf", "name = 1 {")
code, _, _, err = run()
assert code == 1 and "rig.conf:1:" in err, err
print("sound")
