"""Holds NAME.btf.h5, registered from the photographs in NAME/, against NAME.truth.json and NAME.truth.btf.h5.
With TRUTH.json as a second word: against what an independent renderer says of its photographs."""
import json
import sys

import h5py
import numpy as np

def angle_deg(a, b):
    a, b = np.array(a), np.array(b)
    return np.degrees(np.arccos(np.clip(a @ b / np.linalg.norm(a) / np.linalg.norm(b), -1, 1)))


def check(what, value, limit):
    print("%-60s %.4f (at most %.4f)" % (what, value, limit))
    return value <= limit


def check_independent(name, truth):
    """Lamps, ink, and the tone curve from the ink to the paper."""
    told, lamp, covered = json.loads(h5py.File(name + ".btf.h5")["provenance"][()]), [], []
    true_lamps = {p["file"]: p["lamp"]["position"] for p in truth["photos"]}
    for p in told["photographs"]:
        if "left_out" not in p:
            lamp.append(angle_deg(p["lamp_mm"], true_lamps[p["file"]]))
            covered.append(lamp[-1] <= 2 * p["lamp_uncertainty_deg"])
    encoded = np.linspace(0.15, 0.8, 14)
    curve = [np.interp(encoded, *of) for of in ((np.linspace(0, 1, len(told["tone"])), told["tone"]),
                                                (truth["encoded"], truth["linear"]))]
    off = np.abs(np.log(curve[0] / curve[0][-1]) - np.log(curve[1] / curve[1][-1]))
    limits = {"paper-alone": (4, 0.15), "bowed": (0.7, 0.1), "flash": (4, 0.15)}[name]
    good = check(name + ": direction of the lamp, degrees, median", np.median(lamp), limits[0])
    good &= check("share of lamps not within two standard errors", 1 - np.mean(covered), 0.1)
    good &= check("focal length, relative error", abs(told["lens"]["fx"] / truth["K"][0][0] - 1), 0.002)
    reach = np.hypot(62, 84) / 32 * told["opening_mm"]
    bow = truth["bow"] * (reach / truth["corner"]) ** 2
    good &= check("size of the bow, mm, error", abs(told["bend"]["size_mm"] - bow), 0.25 * bow)
    good &= check("logarithm of ink over paper, error", abs(np.log(told["ink_over_paper"] / (0.04 / 0.85))), 0.4)
    return good & check("tone curve, relative to paper, median", np.median(off), limits[1])


name = sys.argv[1]
if len(sys.argv) > 2:
    sys.exit(0 if check_independent(name, json.load(open(sys.argv[2]))) else 1)
found = h5py.File(name + ".btf.h5")
true = h5py.File(name + ".truth.btf.h5")
truth = {p["name"]: (i, p) for i, p in enumerate(json.load(open(name + ".truth.json"))["photographs"])}
told = json.loads(found["provenance"][()])
used = [p for p in told["photographs"] if "left_out" not in p]


good = all(truth[p["file"]][1]["fault"] == "good" for p in used)
view, lamp, covered, error = [], [], [], []
for k, p in enumerate(used):
    index, t = truth[p["file"]]
    view.append(angle_deg(p["camera_mm"], t["pose"]["camera_mm"]))
    lamp.append(angle_deg(p["lamp_mm"], t["lamp"]["at_mm"]))
    covered.append(lamp[-1] <= 2 * p["lamp_uncertainty_deg"])
    if angle_deg(t["pose"]["camera_mm"], [0, 0, 1]) <= 45:
        seen = found["mask"][:, :, k] == 0
        ratio = found["samples"][:, :, k][seen].astype(float) / true["samples"][:, :, index][seen].astype(float)
        error.append(np.median(np.abs(ratio - 1)))
print(name, "lens", told["lens"], "lamps", np.round(lamp, 2))
limits = {"free": (0.03, 0.8, 0.07), "tripod": (0.08, 0.6, 0.07), "pin": (0.15, 1.0, 0.1),
          "series": (0.03, 3.0, 0.08), "linear": (0.03, 0.8, 0.015)}[name]
good &= check("direction of the view, degrees, median", np.median(view), limits[0])
good &= check("direction of the lamp, degrees, median", np.median(lamp), limits[1])
good &= check("reflectance to 45 degrees, relative, median", np.median(error), limits[2])
good &= check("share of lamps not within two standard errors", 1 - np.mean(covered), 0.35)
view_error, weight = found["view_standard_error_deg"][()], found["weight"][()]
good &= check("share of views not within two standard errors", np.mean(np.array(view) > 2 * view_error), 0.35)
good &= check("standard errors of views over their errors, median", np.median(view_error / np.array(view)), 6)
lens_truth = json.load(open(name + ".truth.json"))["lens"]
focal = truth[used[0]["file"]][1]["image_distance_mm"] * lens_truth["width"] / lens_truth["sensor_width_mm"]
focal_error = told["lens"]["standard_error"]["f"]
masked = found["mask"][()]
for bit, key in ((2, "clipped_texels"), (8, "dark_texels")):
    good &= check("texels masked that are not told as " + key, abs(np.sum(masked == bit) - sum(p[key] for p in used)), 0)
if name == "series":
    shots = json.load(open(name + ".truth.json"))["photographs"]
    true_pairs = sorted([a["name"], b["name"]] for a, b in zip(shots, shots[1:])
                        if np.linalg.norm(np.array(a["lamp"]["at_mm"]) - b["lamp"]["at_mm"]) < 20)
    good &= check("pairs of exposures that are others", sorted(told["tone_curve"]["exposure_pairs"]) != true_pairs, 0)
    good &= check("darker twins that are images of their own", len({b for a, b in true_pairs} & {p["file"] for p in used}), 0)
    good &= check("standard error of a tenth of the light", told["tone_curve"]["standard_error_of_a_tenth"], 0.05)
if name in ("free", "linear", "series"):
    good &= check("focal length, relative error", abs(told["lens"]["fx"] / focal - 1), 0.004)
    good &= check("focal length, error over the standard error", abs(told["lens"]["fx"] - focal) / focal_error, 4)
    good &= check("standard error of the focal length, relative", focal_error / focal, 0.004)
else:
    good &= check("standard error of a focal length that is not found", focal_error, 0)
good &= check("weights, mean from 1", abs(np.mean(weight) - 1), 1e-9)
good &= check("share of weights that are alike", np.mean(np.abs(weight - 1) < 1e-6), 0.5)
sys.exit(0 if good else 1)
