"""test_targets.py FOLDER OPTIONS...: the targets that `meson test OPTIONS` runs or passes to what it runs.

Prints one name for ninja per line. FOLDER is a build folder that is set up."""
import json
import os
import subprocess
import sys


def introspect(folder, what):
    with open(os.path.join(folder, "meson-info", "intro-%s.json" % what), encoding="utf-8") as file:
        return json.load(file)


def main():
    folder, options = sys.argv[1], sys.argv[2:]
    command = ["meson", "test", "-C", folder, "--no-rebuild", "--list"] + options
    listed = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout
    names = {line.split(" / ", 1)[1].strip() for line in listed.splitlines() if " / " in line}
    files = {target["id"]: target["filename"] for target in introspect(folder, "targets")}
    needed = {one for test in introspect(folder, "tests") if test["name"] in names for one in test["depends"]}
    for name in sorted(name for one in needed for name in files[one]):
        print(os.path.relpath(name, os.path.realpath(folder)))


main()
