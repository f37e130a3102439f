#!/usr/bin/env python3
"""exported_symbols.py [--write VERSION] NM LIBRARY LIST [LIBRARY LIST]...: compares what libraries export with lists.

A LIST is a symbols file of Debian (packaging/debian/*.symbols): a line of soname and package, then " NAME@Base VERSION",
where VERSION is the first release with the function. Prints TAP. A function that is in the list alone was removed or
renamed, which breaks programs; one that is in the library alone has to be added. --write adds such functions, with
VERSION, and drops the others.
"""
import pathlib
import re
import subprocess
import sys


def exported(nm, library):
    lines = subprocess.run([nm, "-D", "--defined-only", library], check=True, capture_output=True, text=True).stdout
    return {line.split()[-1] for line in lines.splitlines()}


def listed(path):
    return dict(re.findall(r"^ (\w+)@Base (\S+)$", path.read_text(), flags=re.M)) if path.exists() else {}


def write(path, library, names, known, version):
    soname = re.sub(r"(\.so\.\d+\.\d+)\..*", r"\1", pathlib.Path(library).resolve().name)
    lines = [f" {name}@Base {known.get(name, version)}" for name in sorted(names)]
    path.write_text("\n".join([f"{soname} {path.stem} #MINVER#", *lines]) + "\n")


def main(arguments):
    version = None
    if arguments[:1] == ["--write"]:
        version, arguments = arguments[1], arguments[2:]
    if len(arguments) < 3 or len(arguments) % 2 == 0:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    nm, libraries, lists = arguments[0], arguments[1::2], arguments[2::2]
    status = 0
    print(f"1..{len(lists)}")
    for number, (library, path) in enumerate(zip(libraries, map(pathlib.Path, lists)), 1):
        names, known = exported(nm, library), listed(path)
        if version:
            write(path, library, names, known, version)
            known = listed(path)
        gone, new = sorted(known.keys() - names), sorted(names - known.keys())
        good = names and not gone and not new
        print("ok" if good else "not ok", number, "-", path.stem, "exports_what_is_listed")
        for word, found in (("gone", gone), ("not listed", new)):
            if found:
                print(f"# {word}: {' '.join(found)}")
        status |= not good
    return status


sys.exit(main(sys.argv[1:]))
