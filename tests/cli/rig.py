"""A capture with a rig of one's own: somebody sets the axes and takes the photographs, as he is asked to.

Usage: rig.py WEFT ASSETS; in a scratch folder. Stands in for both: answers the questions, and drops the photographs.
"""
import json
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


def photograph(number):
    """A grey picture of 16 bits whose level says which one it is."""
    side, level = SIDE * BIN, 20000 + 1000 * number
    with open("incoming/shot.pgm", "wb") as file:
        file.write(b"P5 %d %d 65535\n" % (side, side) + level.to_bytes(2, "big") * (side * side))
    return level


def run(stop_after=None, *more):
    """Serves a capture; returns its exit code, its notes and, for each photograph, where the axes stood."""
    command = [WEFT, "capture", "--rig", "rig.conf", "--sample", "a scarf", "--plan", "plan.csv", "-o", "session", "--json"]
    process = subprocess.Popen(command + list(more), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
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
        name = "tl%03d_pl%03d_tv%03d_pv%03d" % tuple(round(a) for a in shot["light"] + shot["view"])
        folder = "session/" + name[12:]
        original = open(f"{folder}/{name}.original.pgm", "rb").read()
        assert int.from_bytes(original[-2:], "big") == level, name
        assert os.path.exists(f"{folder}/{name}.tif"), name


prepare()
code, notes, _, err = run(None, "--dry-run")
assert code == 0 and any("no order of these poses takes less" in note for note in notes), (notes, err)
assert not os.path.exists("session"), "a rehearsal wrote"

# The person leaves after two photographs; the session goes on when he is back.
code, _, first, err = run(stop_after=2)
assert code == 3 and "nobody is there" in err, (code, err)
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

# The settings of the rig are part of the session.
write("rig.conf", open("rig.conf", encoding="ascii").read().replace('name = "folder', 'name = "another folder'))
code, _, _, err = run()
assert code == 1 and "another 'rig_name'" in err, err
write("rig.conf", "name = 1 {")
code, _, _, err = run()
assert code == 1 and "rig.conf:1:" in err, err
print("sound")
