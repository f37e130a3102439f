#!/usr/bin/env python3
"""palette_png.py IN OUT: writes a PNG file with a palette of 256 colors, for pictures in docs/images."""
import collections
import struct
import sys
import zlib


def unfiltered(kind, line, above, size):
    for i in range(len(line)):
        left = line[i - size] if i >= size else 0
        corner = above[i - size] if i >= size else 0
        guess = left + above[i] - corner
        paeth = min((left, above[i], corner), key=lambda value: abs(guess - value))
        line[i] = (line[i] + (0, left, above[i], (left + above[i]) // 2, paeth)[kind]) & 255
    return line


def read(path):
    """Lines of RGB or RGBA bytes, and bytes per pixel."""
    data = open(path, "rb").read()
    width, height, depth, color = struct.unpack(">IIBB", data[16:26])
    assert depth == 8 and color in (2, 6), "only RGB and RGBA of 8 bits"
    packed, at = b"", 8
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        packed += data[at + 8:at + 8 + length] if kind == b"IDAT" else b""
        at += 12 + length
    size = 3 if color == 2 else 4
    raw, lines, above = zlib.decompress(packed), [], bytes(width * size)
    for y in range(height):
        line = raw[y * (width * size + 1):(y + 1) * (width * size + 1)]
        above = unfiltered(line[0], bytearray(line[1:]), above, size)
        lines.append(above)
    return lines, size


def palette_of(counts):
    """The 256 colors that are most frequent among those that differ in their first 5 bits per channel."""
    boxes = collections.defaultdict(lambda: (0, None))
    for color, count in counts.items():
        key = tuple(value >> 3 for value in color)
        total, (most, best) = boxes[key][0], boxes[key][1] or (0, color)
        boxes[key] = (total + count, max((most, best), (count, color)))
    return [best for _, (_, best) in sorted(boxes.values(), reverse=True)[:256]]


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def write(path, width, lines, palette):
    header = struct.pack(">IIBBBBB", width, len(lines), 8, 3, 0, 0, 0)
    rows = zlib.compress(b"".join(b"\0" + bytes(line) for line in lines), 9)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"PLTE", bytes(sum(palette, ()))) +
                   chunk(b"IDAT", rows) + chunk(b"IEND", b""))


def main():
    lines, size = read(sys.argv[1])
    colors = [[tuple(line[i:i + 3]) for i in range(0, len(line), size)] for line in lines]
    palette = palette_of(collections.Counter(color for line in colors for color in line))
    nearest = {color: index for index, color in enumerate(palette)}
    for line in colors:
        for color in line:
            if color not in nearest:
                nearest[color] = min(range(len(palette)),
                                     key=lambda i: sum((a - b) ** 2 for a, b in zip(color, palette[i])))
    write(sys.argv[2], len(colors[0]), [[nearest[color] for color in line] for line in colors], palette)


if __name__ == "__main__":
    main()
