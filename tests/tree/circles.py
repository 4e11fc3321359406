#!/usr/bin/env python3
"""Files whose functions call each other in a circle: circles.py NM FOLDER, a folder of object files. Exit code 1 where there are any."""
import collections
import os
import subprocess
import sys

nm, folder = sys.argv[1:]
objects = [os.path.join(path, name) for path, _, names in os.walk(folder) for name in names if name.endswith(".o")]
defined, wanted = {}, collections.defaultdict(set)
for line in subprocess.run([nm, "--print-file-name", "--extern-only", *objects], capture_output=True, text=True, check=True).stdout.splitlines():
    path, _, rest = line.partition(":")
    unit = os.path.relpath(path, folder).replace("_bridge.cpp", ".c")
    kind, name = rest.split()[-2:]
    if kind == "U":
        wanted[unit].add(name)
    else:
        defined[name] = unit


def circles(graph):
    """Strongly connected components of more than one node (Tarjan)."""
    index, low, stack, found = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for other in graph[node]:
            if other not in index:
                visit(other)
                low[node] = min(low[node], low[other])
            elif other in stack:
                low[node] = min(low[node], index[other])
        if low[node] == index[node]:
            part = []
            while not part or part[-1] != node:
                part.append(stack.pop())
            if len(part) > 1:
                found.append(sorted(part))

    sys.setrecursionlimit(10000)
    for node in sorted(graph):
        if node not in index:
            visit(node)
    return found


graph = {one: {defined[name] for name in names if name in defined} - {one} for one, names in wanted.items()}
for one in set(defined.values()):
    graph.setdefault(one, set())
found = circles(graph)
for circle in found:
    print(", ".join(one.removesuffix(".o") for one in circle))
sys.exit(bool(found))
