"""psnr.py A.png B.png LEAST: exit status 1 if the pictures are further apart than LEAST dB."""
import math
import struct
import sys
import zlib


def read_png(path):
    """Width, and rows of 8-bit samples as they are in the file, filters undone."""
    with open(path, "rb") as file:
        data = file.read()
    at, packed, header = 8, b"", None
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", data[at + 8 : at + 8 + size])
        elif kind == b"IDAT":
            packed += data[at + 8 : at + 8 + size]
        at += size + 12
    width, height, depth, color = header[:4]
    step = {0: 1, 2: 3, 4: 2, 6: 4}[color]
    assert depth == 8 and header[6] == 0
    raw, rows = zlib.decompress(packed), []
    before = bytearray(width * step)
    for y in range(height):
        kind = raw[y * (width * step + 1)]
        row = bytearray(raw[y * (width * step + 1) + 1 : (y + 1) * (width * step + 1)])
        for i in range(len(row)):
            a = row[i - step] if i >= step else 0
            b, c = before[i], before[i - step] if i >= step else 0
            p = a + b - c
            paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            row[i] = (row[i] + (0, a, b, (a + b) // 2, paeth)[kind]) & 255
        rows.append(row)
        before = row
    return width, rows


def main():
    (width, a), (other, b) = read_png(sys.argv[1]), read_png(sys.argv[2])
    assert width == other and len(a) == len(b)
    squares = sum((x - y) ** 2 for p, q in zip(a, b) for x, y in zip(p, q))
    count = len(a) * len(a[0])
    psnr = 999.0 if squares == 0 else 10 * math.log10(255.0**2 * count / squares)
    print(f"{psnr:.1f} dB")
    return 0 if psnr >= float(sys.argv[3]) else 1


sys.exit(main())
