"""blended.py BACK FRONT BOTH: whether BOTH is the mean of the other two PNG files in linear light, within 2 of 255."""
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


def linear(value):
    value /= 255
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def encoded(value):
    return 255 * (12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055)


(back, size), (front, _), (both, _) = (read(path) for path in sys.argv[1:4])
worst, changed = (0, 0, 0, 0), 0
for a, b, c in zip(back, front, both):
    for i in range(len(a)):
        if size == 3 or i % 4 < 3:
            changed += a[i] != b[i]
            off = abs(encoded((linear(a[i]) + linear(b[i])) / 2) - c[i])
            worst = max(worst, (off, a[i], b[i], c[i]))
print(f"{changed} values differ; the mean is off by at most {worst[0]:.2f}: {worst[1]}, {worst[2]} gave {worst[3]}")
sys.exit(0 if changed > 1000 and worst[0] <= 2 else 1)
