"""blended.py BACK FRONT BOTH: whether BOTH is the mean of the other two PNG files in linear light, within 2 of 255."""
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scripts/dev"))
from palette_png import read  # noqa: E402


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
