#!/usr/bin/env python3
"""Holds the sources to cmake/weft_modules.cmake: a module includes only headers of modules that it USES, and uses none that stands below it
in that list. Folders can be taken in at a glance, and nothing lies beside them: what a
test left behind was once committed.

check_includes.py [--measures]    with --measures: prints how many headers have one user besides their own source
"""
import collections
import os
import re
import subprocess
import sys

os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
TOPS = "base btf reflectance geometry capture registration import relief compress evaluate edit player compare inspect cli include".split()
BESIDE = ".ci assets bench cmake docs examples packaging python scripts tests".split()
FILES = re.compile(r"\.clang-(format|tidy)|\.gitignore|CMake(Lists\.txt|Presets\.json)|LICENSE|Makefile|README\.md")
CROWD = 40  # files a folder; lists of cases may be longer
faults = []


def read_modules():
    """Folders of each module, and what it uses, in the order of the list."""
    text = open("cmake/weft_modules.cmake").read()
    modules = collections.OrderedDict()
    for name, rest in re.findall(r"^weft_module\((\S+?)([\s)][^)]*\)|\))", text, re.M):
        words = collections.defaultdict(list)
        key = None
        for word in rest.strip(") \n").split():
            if word in ("USES", "EXCEPT", "GENERATED", "FOLDERS"):
                key = word
            elif key:
                words[key].append(word)
        for used in words["USES"]:
            if used not in modules:
                faults.append(f"cmake/weft_modules.cmake: {name} uses {used}, which does not stand above it")
        modules[name] = (words["FOLDERS"] or [name], set(words["USES"]))
    modules["cli"] = (["cli", "cli/command"], set(modules))
    return modules


def includes_of(path):
    with open(path, errors="replace") as source:
        for number, line in enumerate(source, 1):
            found = re.match(r'\s*#\s*include\s+"([^"]+)"', line)
            if found:
                yield number, found.group(1)


def check_sources(files, modules):
    owner = {folder: name for name, (folders, _) in modules.items() for folder in folders}
    users = collections.defaultdict(set)
    for path in files:
        module = owner.get(os.path.dirname(path))
        if path.startswith("include/"):
            module = "include"
        if module is None:
            faults.append(f"{path}: is in no module of cmake/weft_modules.cmake")
            continue
        for line, header in includes_of(path):
            if header.startswith("weft/"):
                continue
            target = owner.get(os.path.dirname(header))
            if target is None or not os.path.exists(header):
                faults.append(f'{path}:{line}: "{header}" is no header of a module, named from the root')
            elif module == "include":
                faults.append(f'{path}:{line}: a public header may not include "{header}"')
            elif target != module and target not in modules[module][1]:
                faults.append(f"{path}:{line}: {module} does not use {target}")
            unit, other = os.path.splitext(path)[0], os.path.splitext(header)[0]
            if unit != other:
                users[header].add(unit)
    return users


def check_folders(files):
    count = collections.Counter(os.path.dirname(path) for path in files if not re.match(r"tests/(golden|mutants)/", path))
    for folder, number in sorted(count.items()):
        if folder and number > CROWD:
            faults.append(f"{folder}/: holds {number} files, more than {CROWD}")
    for path in files:
        top = path.split("/")[0]
        if "/" in path and top not in TOPS + BESIDE:
            faults.append(f"{path}: {top}/ is no folder of the tree")
        elif "/" not in path and not FILES.fullmatch(path):
            faults.append(f"{path}: lies beside the folders")
    tidy = open(".clang-tidy").read()
    for top in TOPS:
        if os.path.isdir(top) and not re.search(rf"HeaderFilterRegex:.*[(|]{top}[|)]", tidy):
            faults.append(f"{top}/: .clang-tidy does not look at its headers")


def main():
    listed = subprocess.run(["git", "ls-files"], capture_output=True, text=True, check=True).stdout.split("\n")
    files = [path for path in listed if path and os.path.exists(path)]
    check_folders(files)
    sources = [path for path in files if path.split("/")[0] in TOPS and re.search(r"\.(c|h|cpp)$", path)]
    users = check_sources(sources, read_modules())
    print("\n".join(faults), end="\n" if faults else "")
    if "--measures" in sys.argv:
        headers = [path for path in sources if path.endswith(".h") and not path.startswith("include/")]
        print(f"{sum(len(users[path]) <= 1 for path in headers)} of {len(headers)} headers have at most one user besides their own source")
    return 1 if faults else 0


sys.exit(main())
