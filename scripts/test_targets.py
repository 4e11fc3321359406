#!/usr/bin/env python3
"""Prints the tests of a build, a line each: its name, and the targets whose programs it runs. test_targets.py BUILD"""
import json
import os
import subprocess
import sys

build = os.path.realpath(sys.argv[1])
listing = json.loads(subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1"], capture_output=True, check=True).stdout)
for test in listing["tests"]:
    programs = [os.path.basename(word) for word in test.get("command", []) if os.path.realpath(word).startswith(build + os.sep)]
    print(test["name"], *dict.fromkeys(programs + ["weft"]))
