"""pbrt_scene.py make FOLDER: writes wall.pbrt and its picture. A wall of 16 x 12 units fills what the camera sees.
pbrt_scene.py holes PICTURE ...: whether no pixel is black or magenta.
pbrt_scene.py colored PICTURE: whether a pixel has a color.
pbrt_scene.py gray PICTURE: whether all pixels are gray.
pbrt_scene.py differs A B D: whether D is 16 times the difference of A and B, but at edges, where the frustum of
    frozen wants is.
pbrt_scene.py near A B MOST: whether two PNG files differ by at most MOST in any value."""
import os
import struct
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scripts/dev"))
from palette_png import read  # noqa: E402

WIDTH, HEIGHT = 4096, 3072  # texels of the wall
SCENE = """LookAt 0 0 0  0 1 0  0 0 1
Camera "perspective" "float fov" [ 60 ]
Film "image" "integer xresolution" [ 160 ] "integer yresolution" [ 160 ]
WorldBegin
LightSource "distant" "point from" [ 0 -1 0 ] "point to" [ 0 0 0 ] "rgb L" [ 0.9 0.9 0.9 ]
LightSource "point" "point from" [ 3 0 2 ] "rgb I" [ 9 9 9 ]
Texture "stones" "spectrum" "imagemap" "string filename" "stones.tga"
AttributeBegin
Material "matte" "texture Kd" "stones"
Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "point P" [ -8 8 -6  8 8 -6  8 8 6  -8 8 6 ]
    "float uv" [ 0 0 1 0 1 1 0 1 ]
AttributeEnd
AttributeBegin
Material "matte" "rgb Kd" [ 0.2 0.6 0.3 ]
Translate 2 7 1
Shape "sphere" "float radius" [ 0.9 ]
AttributeEnd
WorldEnd
"""


def make(folder):
    """No texel is dark or magenta, in no mean of texels either."""
    rows = []
    for kind in range(8):
        row = bytearray()
        for x in range(WIDTH):
            mortar = x % 64 < 3 or kind == 0
            row += bytes((110, 160, 170) if mortar else (60 + x // 64 * 37 % 90, 120, 150 + (x * 7 + kind * 29) % 60))
        rows.append(bytes(row))
    with open(os.path.join(folder, "stones.tga"), "wb") as file:
        file.write(struct.pack("<BBBHHBHHHHBB", 0, 0, 2, 0, 0, 0, 0, 0, WIDTH, HEIGHT, 24, 0))
        for y in range(HEIGHT):
            file.write(rows[0 if y % 32 < 3 else 1 + y // 32 % 7])
    with open(os.path.join(folder, "wall.pbrt"), "w", encoding="utf-8") as file:
        file.write(SCENE)


def pixels(path):
    rows, size = read(path)
    return [tuple(row[i:i + 3]) for row in rows for i in range(0, len(row), size)]


def holes(paths):
    for path in paths:
        bad = [p for p in pixels(path) if max(p) < 8 or (p[0] > 120 and p[2] > 120 and p[1] < 60)]
        if bad:
            print(f"{path}: {len(bad)} pixels as {bad[0]}")
            return False
    return True


def near(a, b, most):
    first, second = pixels(a), pixels(b)
    worst = max(abs(x - y) for p, q in zip(first, second) for x, y in zip(p, q))
    print(f"{len(first)} and {len(second)} pixels, off by at most {worst}")
    return len(first) == len(second) and worst <= most


def differs(a, b, d):
    side = len(read(a)[0])
    first, second, third = pixels(a), pixels(b), pixels(d)
    worst = 0
    for i, (p, q, r) in enumerate(zip(first, second, third)):
        if min(i % side, i // side, side - 1 - i % side, side - 1 - i // side) >= 8:
            worst = max(worst, *(abs(min(16 * abs(x - y), 255) - z) for x, y, z in zip(p, q, r)))
    print(f"off by at most {worst}")
    return worst <= 16


if sys.argv[1] == "make":
    make(sys.argv[2])
    good = True
elif sys.argv[1] == "holes":
    good = holes(sys.argv[2:])
elif sys.argv[1] == "colored":
    good = any(max(p) - min(p) > 40 for p in pixels(sys.argv[2]))
elif sys.argv[1] == "gray":
    good = all(max(p) - min(p) < 3 for p in pixels(sys.argv[2]))
elif sys.argv[1] == "differs":
    good = differs(*sys.argv[2:5])
else:
    good = near(sys.argv[2], sys.argv[3], int(sys.argv[4]))
sys.exit(0 if good else 1)
