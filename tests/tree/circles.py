#!/usr/bin/env python3
"""Files whose functions call each other in a circle: circles.py NM LIBRARY. Exit code 1 where there are more than MOST."""
import collections
import re
import subprocess
import sys

MOST = 0
nm, library = sys.argv[1:]
listing = subprocess.run([nm, "--extern-only", library], capture_output=True, text=True, check=True).stdout
defined, wanted, member = {}, collections.defaultdict(set), None
for line in listing.split("\n"):
    if re.fullmatch(r"\S+\.o:", line):
        member = line[:-3]
    elif line.split()[-2:-1] == ["U"]:
        wanted[member].add(line.split()[-1])
    elif line:
        defined[line.split()[-1]] = member

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
    print(", ".join(circle))
sys.exit(len(found) > MOST)
