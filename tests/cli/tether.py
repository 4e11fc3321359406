"""A capture with a camera on a network, through libgphoto2. Usage: tether.py WEFT ASSETS; in a scratch folder."""
import json
import os
import subprocess
import sys

from ptp_camera import Camera

WEFT, ASSETS = sys.argv[1:3]
SIDE = 96
LENS = {"weft_lens": 1, "board": "none", "width": SIDE, "height": SIDE, "fx": 440, "fy": 440, "cx": (SIDE - 1) / 2,
        "cy": (SIDE - 1) / 2, "k1": 0, "k2": 0, "vignetting": [0, 0, 0], "standard_error": {}, "rms_px": 0, "used": [],
        "left_out": []}
SHOTS = 6


def write_rig(port, more=""):
    text = open(ASSETS + "/rigs/photographs.conf", encoding="ascii").read()
    for old, new in [("nominal.lens.json", "lens.json"), ("bin = 4", "bin = 2"), ("settle_s = 5", "settle_s = 0"),
                     ("backend = folder", "backend = gphoto2"), ('device = "incoming"', f'device = "{port}"'),
                     ("trigger = hand", "trigger = none\n timeout_s = 20\n" + more), ("longest_exposure_s = 0.25", "longest_exposure_s = 2"),
                     ("shortest_exposure_s = 0.25", "shortest_exposure_s = 0.001")]:
        assert old in text, old
        text = text.replace(old, new)
    with open("rig.conf", "w", encoding="ascii") as file:
        file.write(text)
    with open("lens.json", "w", encoding="ascii") as file:
        json.dump(LENS, file)
    with open("plan.csv", "w", encoding="ascii") as file:
        file.write("theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n")
        file.writelines("%d,0,30,0\n" % (10 * shot + 5) for shot in range(SHOTS))


def capture(camera, session, more=""):
    write_rig(camera.port, more)
    command = [WEFT, "capture", "--rig", "rig.conf", "--sample", "scarf", "--plan", "plan.csv", "-o", session]
    return subprocess.run(command, input="\n" * 100, text=True, capture_output=True, timeout=150)


def journal(session):
    return [json.loads(line) for line in open(session + "/journal.jsonl", encoding="ascii")]


def level_of(path):
    """The last sample: of the last pixel, which is as all others are."""
    return int.from_bytes(open(path, "rb").read()[-2:], "little")


# Busy, gone in the middle, and silent about an exposure: every photograph is the one that was taken for it.
camera = Camera(2 * SIDE, busy=(2,), drop=(5,), silent=(4,))
done = capture(camera, "session")
assert done.returncode == 0, done.stderr
lines = journal("session")
assert sorted(line["shot"] for line in lines) == list(range(SHOTS)), lines
assert camera.sessions == 3, camera.sessions  # opened again after each
taken = [exposure for exposure, _ in camera.taken]
for line in lines:
    assert any(abs(line["exposure_s"] / exposure - 1) < 1e-3 for exposure in taken), (line, taken)
for folder, _, names in os.walk("session"):
    for name in names:
        if name.endswith(".original.TIF"):
            level = level_of(folder + "/" + name)
            assert level != 1, "the photograph of somebody else"
            light = int(name[2:5])
            line = next(line for line in lines if abs(10 * line["shot"] + 5 - light) < 1)
            assert abs(level - min(65535, 65535 * line["exposure_s"] * 2)) <= 1, (level, line)
            assert 0.3 < level / 65535 < 0.9, "metered"
assert sum(name.endswith(".original.TIF") for _, _, names in os.walk("session") for name in names) == SHOTS

# A card that is full stops the night with one line, and the session goes on when there is room.
camera = Camera(2 * SIDE, room=5)
done = capture(camera, "full")
assert done.returncode == 3, (done.returncode, done.stderr)
assert done.stderr.endswith("weft capture: camera: its card is full\n") and done.stderr.count("card") == 1, done.stderr
before = journal("full")
assert 0 < len(before) < SHOTS and subprocess.run([WEFT, "verify", "full"], capture_output=True).returncode == 0
camera.room = 1000
done = capture(camera, "full")
assert done.returncode == 0, done.stderr
lines = journal("full")
assert lines[:len(before)] == before and sorted(line["shot"] for line in lines) == list(range(SHOTS)), lines

# Exposures longer than the longest that has a name: by bulb, timed by the clock, for the file has whole seconds.
camera = Camera(2 * SIDE, bulb=True)
done = capture(camera, "bulb")
assert done.returncode == 0, done.stderr
lines = journal("bulb")
opened = [exposure for exposure, _ in camera.taken]
assert len(lines) == SHOTS
for line in lines:
    assert line["exposure_s"] > 0.3, line  # no named time is longer than 0.1 s
    assert min(abs(line["exposure_s"] - exposure) for exposure in opened) < 0.2, (line, opened)

# One whose shutter did not do what it was told.
camera = Camera(2 * SIDE, bulb=True, off=2)
done = capture(camera, "stuck")
assert done.returncode == 3 and "its shutter was open for" in done.stderr, (done.returncode, done.stderr)
assert not os.path.exists("stuck/journal.jsonl")

# Frames of the sensor: somebody covers the lens of a rig whose lamp has no switch, and puts an even field before it.
camera = Camera(2 * SIDE)
done = capture(camera, "frames", "dark_frames = 2\n flat_frames = 1\n")
assert done.returncode == 0, done.stderr
asked = [done.stderr.index(text) for text in ("Cover the lens", "Put an evenly lit white field", "see the sample again")]
assert asked == sorted(asked), done.stderr
times = [line["exposure_s"] for line in journal("frames")[:5]]
wanted = [0.001, 0.001, 2, 2, 0.25]  # as briefly and as long as the rig exposes, and metered
assert all(abs(time / asked - 1) < 1e-3 for time, asked in zip(times, wanted)), times
assert len(os.listdir("frames/sensor")) == 5
assert subprocess.run([WEFT, "verify", "frames"], capture_output=True).returncode == 0

# Nobody there.
camera.port = "ptpip:127.0.0.1:1:1"
done = capture(camera, "nobody")
assert done.returncode == 3 and "cannot open it" in done.stderr, (done.returncode, done.stderr)
print("sound")
