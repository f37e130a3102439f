"""Puts the page's style, scripts and markup together and writes them as a C header.

Usage: embed.py page.html OUTPUT.h DEPFILE

Where page.html names a style sheet or a script, the file's text takes its place. Its pieces are cut
where a script element of JSON says what belongs there: @SWEEP@, @SERIES@, @PICTURES@.
"""

import pathlib
import re
import sys

PARTS = ("SWEEP", "SERIES", "PICTURES")


def inlined(path, used):
    """The page's text with what it names inside it."""
    used.append(path)

    def read(name):
        used.append(path.parent / name)
        text = used[-1].read_text(encoding="utf-8")
        if "</" in text:
            sys.exit(f"{used[-1]}: '</' would end the element that it is put into")
        return text

    text = path.read_text(encoding="utf-8")
    text = re.sub(r'<link rel="stylesheet" href="([\w.]+)">',
                  lambda match: f"<style>\n{read(match[1])}</style>", text)
    return re.sub(r'<script src="([\w.]+)"></script>',
                  lambda match: f"<script>\n{read(match[1])}</script>", text)


def header(text):
    """The text as bytes, for string literals have no more than 4095 of them in C."""
    pieces = re.split(r"@(" + "|".join(PARTS) + ")@", text)
    if sorted(pieces[1::2]) != sorted(PARTS):
        sys.exit(f"the page has {pieces[1::2]} and not each of {PARTS} once")
    pieces, parts = [piece.encode() for piece in pieces[::2]], pieces[1::2]
    places = [sum(map(len, pieces[:i])) for i in range(len(pieces) + 1)]
    data = b"".join(pieces)
    lines = [",".join(map(str, data[i:i + 32])) + "," for i in range(0, len(data), 32)]
    return "\n".join([
        "#include <stddef.h>",
        "#include <stdint.h>",
        "enum page_template_part { " + ", ".join("PAGE_TEMPLATE_" + part for part in PARTS) + " };",
        f"#define PAGE_TEMPLATE_PIECES {len(pieces)}",
        "static const size_t page_template_pieces[] = {" + ", ".join(map(str, places)) + "};",
        "static const enum page_template_part page_template_parts[] = {"
        + ", ".join("PAGE_TEMPLATE_" + part for part in parts) + "};",
        "static const uint8_t page_template[] = {", *lines, "};", ""])


def main():
    page, output, depfile = map(pathlib.Path, sys.argv[1:])
    used = []
    output.write_text(header(inlined(page, used)), encoding="utf-8")
    depfile.write_text(f"{output}: {' '.join(map(str, used))}\n", encoding="utf-8")


main()
