#!/usr/bin/env python3
"""public-symbols.py [REVISION]: prints every name of include/sluice, one per line, sorted.

Functions, types and constants stand as they are, parameters as `function(parameter)`, fields and
enumerators as `Type.name`. Without REVISION: the headers of the working tree. Before a release,
compare with the last one:

    diff <(scripts/dev/public-symbols.py v0.1.0) <(scripts/dev/public-symbols.py)
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]


def headers(revision):
    if not revision:
        return [p.read_text() for p in sorted((ROOT / "include/sluice").glob("*.h"))]

    def git(*arguments):
        return subprocess.check_output(["git", "-C", str(ROOT), *arguments], text=True)

    paths = git("ls-tree", "--name-only", revision, "include/sluice/").split()
    return [git("show", f"{revision}:{path}") for path in paths]


def without_comments(text):
    text = re.sub(r"/\*.*?\*/", " ", text, flags=re.S)
    return re.sub(r"//[^\n]*", "", text)


def declared(text):
    """Names that a declaration without its type's braces gives: `uint32_t a, b[2]`, `void (*f)(int)`."""
    pointer = re.search(r"\(\s*\*\s*(\w+)\s*\)", text)
    if pointer:
        return [pointer[1]]
    return [re.findall(r"\w+", re.sub(r"\[.*?\]", "", part))[-1] for part in text.split(",")]


def names(text):
    for name, value in re.findall(r"^#define[ \t]+(SLUICE_\w+)([^\n]*)", text, flags=re.M):
        if value.strip():  # no include guard
            yield name
    text = re.sub(r"^#(?:.*\\\n)*.*$", "", text, flags=re.M)
    for kind, body, name in re.findall(r"typedef (enum|struct) \w+ \{(.*?)\} (\w+);", text, flags=re.S):
        yield name
        if kind == "enum":
            parts = [re.match(r"\s*(\w*)", part)[1] for part in body.split(",")]
        else:
            parts = [n for part in body.split(";") if part.strip() for n in declared(part)]
        yield from (f"{name}.{part}" for part in parts if part)
    text = re.sub(r"typedef (enum|struct) \w+ \{.*?\} \w+;", "", text, flags=re.S)
    for part in re.findall(r"\btypedef\b([^;{}]*);", text):
        yield declared(part)[0]
    for name, parameters in re.findall(r"SLUICE_API[^;{}]*?\b(sluice\w+)\s*\(([^;]*)\)\s*;", text):
        yield name
        for part in parameters.split(","):
            if part.strip() != "void":
                yield f"{name}({declared(part)[0]})"


def main():
    if len(sys.argv) > 2 or any(a.startswith("-") for a in sys.argv[1:]):
        print(__doc__.strip())
        return 0 if sys.argv[1:] == ["--help"] else 2
    texts = [without_comments(text) for text in headers(sys.argv[1] if len(sys.argv) > 1 else None)]
    print("\n".join(sorted({name for text in texts for name in names(text)})))
    return 0


if __name__ == "__main__":
    sys.exit(main())
