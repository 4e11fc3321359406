"""Holds a dataset that was made with --colour, or of files that say their colours, against the same without."""
import json
import sys

import h5py
import numpy as np

plain, coloured = (h5py.File(name) for name in sys.argv[1:3])
matrix = np.array(json.load(open(sys.argv[3]))["matrix"])
seen = (plain["mask"][()] == 0) & (coloured["mask"][()] == 0)
wanted = plain["samples"][()][seen].astype(float) @ matrix.T
off = np.abs(coloured["samples"][()][seen].astype(float) - wanted)
told = json.loads(coloured["provenance"][()])
good = seen.mean() > 0.5 and off.max() < 0.004 * np.abs(wanted).max()
good = good and ("colour" not in told if len(sys.argv) > 4 else told["colour"]["model"] == "linear")
print("samples %d, off by %.5f at most of %.3f" % (seen.sum(), off.max(), np.abs(wanted).max()))
sys.exit(0 if good and "colour" not in json.loads(plain["provenance"][()]) else 1)
