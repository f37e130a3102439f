"""test_peer_defects.py DEMAND_PBRT FOLDER: what DemandPbrtScene of the OptiX Toolkit does wrong is right here, in TAP.

Numbers are those of a list of twenty; tests/pbrt/test_pbrt_peer_defects.c has those of the reader of scenes."""
import array
import json
import os
import shutil
import struct
import subprocess
import sys
import zlib

program, folder = sys.argv[1:3]
WIDTH, HEIGHT = 24, 16
CAMERA = "LookAt 0 -5 0  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 40\n"
SUN = "LightSource \"distant\" \"point from\" [ 1 -2 2 ] \"rgb L\" [ 1 1 1 ]\n"
SQUARE = ("Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 0 2 3 ] \"point P\" [ -1 0 -1  1 0 -1  1 0 1  -1 0 1 ] "
          "\"float uv\" [ 0 0  1 0  1 1  0 1 ] ")
number, failed = 0, False


def write(name, text):
    with open(os.path.join(folder, name), "w") as file:
        file.write(text)
    return os.path.join(folder, name)


def write_png(name, rgba):
    """A picture of 4 x 4 equal texels."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = (b"\0" + bytes(rgba) * 4) * 4
    header = struct.pack(">IIBBBBB", 4, 4, 8, 6 if len(rgba) == 4 else 2, 0, 0, 0)
    with open(os.path.join(folder, name), "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) +
                   chunk(b"IEND", b""))


def write_halves():
    """A sky that is 1 where y of the light is positive, and else 1/4."""
    with open(os.path.join(folder, "halves.pfm"), "wb") as file:
        row = [1.0] * 24 + [0.25] * 24
        file.write(b"PF\n16 8\n-1\n" + array.array("f", row * 8).tobytes())


class Picture:
    def __init__(self, scene, *options, width=WIDTH, height=HEIGHT):
        """`scene`: the text of the world, or of all if it has a camera of its own."""
        text = scene if "Camera" in scene else CAMERA + "WorldBegin\n" + scene + "WorldEnd\n"
        path = os.path.join(folder, "picture.pfm")
        done = subprocess.run([program, write("scene.pbrt", text), "--dim", f"{width}x{height}", "--file", path, "--json",
                               "--cache", os.path.join(folder, "cache"), "--verbose-loading", *options],
                              capture_output=True, text=True)
        if done.returncode == 77:
            print("1..0 # SKIP no device traces rays")
            sys.exit(0)
        self.log = done.stderr
        self.done = done.returncode == 0
        self.figures = {line["name"]: line["value"] for line in map(json.loads, done.stdout.splitlines())}
        self.width, self.height, self.bits = width, height, b""
        if self.done:
            with open(path, "rb") as file:
                self.bits = file.read().split(b"\n", 3)[3]
        self.numbers = array.array("f", self.bits)

    def at(self, x, y):
        """Row 0 is on top; PFM begins with the last one."""
        first = 3 * ((self.height - 1 - y) * self.width + x)
        return tuple(self.numbers[first:first + 3])

    def largest_difference(self, other):
        return max(abs(a - b) for a, b in zip(self.numbers, other.numbers))


def fact(name, holds):
    global number, failed
    number += 1
    print(f"{'ok' if holds else 'not ok'} {number} - {name}")
    failed = failed or not holds


def two_ways(scene, *options):
    """Pictures whose parts come one per launch, in coarse boxes, and with everything loaded before."""
    slowly = ("--proxy-granularity", "coarse", "--oneshot-geometry", "--oneshot-material")
    return Picture(scene, *slowly, *options), Picture(scene, "--preload", *options)


def are_equal(one, other):
    return one.done and other.done and one.bits == other.bits


def defect_6():
    ball, rows = "Translate 1 0 0\nShape \"sphere\" \"float radius\" 0.4\n", []
    for width, height in (24, 16), (16, 24):
        p = Picture(ball, "--bg", "0/0/1", width=width, height=height)
        rows.append([p.at(x, height // 2)[2] < 1 for x in range(width // 2 - 8, width // 2 + 8)])
    fact("defect 6: +x of the world is on the left of a camera that looks along +y",
         any(rows[0][:8]) and not any(rows[0][8:]))
    fact("defect 6: the field of view is the angle of the shorter side", rows[0] == rows[1])


# An object of shapes with and without normals and uvs, and of spheres of two sizes and scales.
OBJECT = """ObjectBegin "o"
Material "matte" "rgb Kd" [ .8 .2 .2 ]
Shape "trianglemesh" "integer indices" [ 0 1 2 ] "point P" [ -1 0 -1  0 0 -1  -1 0 0 ] "normal N" [ 1 -1 0  0 -1 1  0 -1 0 ]
Shape "trianglemesh" "integer indices" [ 0 1 2 ] "point P" [ 0 0 0  1 0 0  0 0 1 ]
Shape "trianglemesh" "integer indices" [ 0 1 2 ] "point P" [ 0 0 -1  1 0 -1  1 0 0 ] "normal N" [ 0 -1 0  0 -1 0  1 -2 0 ]
    "float uv" [ 0 0  1 0  1 1 ]
Translate -.6 0 .6
Shape "sphere" "float radius" 0.3
Translate .2 0 0
Scale .2 .5 1
Shape "sphere" "float radius" 0.6
ObjectEnd
Scale 1 1 .5
ObjectInstance "o"
"""


def defects_11_and_12():
    coarse, before = two_ways(SUN + OBJECT)
    fact("defect 11: shapes with and without normals share a coarse box and keep them", are_equal(coarse, before))
    lines = OBJECT.splitlines()
    free = Picture(SUN + "Scale 1 1 .5\n" + "\n".join(lines[1:lines.index("ObjectEnd")]) + "\n")
    fact("defect 11: normals of objects are those of the same shapes in the world",
         free.done and free.largest_difference(coarse) < 1e-4)
    fact("defect 12: two balls of one coarse box are two, each with its scale",
         coarse.figures["shapes_entered"] == 5 and coarse.figures["geometries_built"] == 5)


def defect_13():
    write_png("color.png", (255, 0, 0))
    write_png("hidden.png", (0, 255, 0))
    ball = ("Texture \"t\" \"color\" \"imagemap\" \"string filename\" \"color.png\"\n"
            "Texture \"h\" \"color\" \"imagemap\" \"string filename\" \"hidden.png\"\n"
            "ObjectBegin \"o\"\nMaterial \"matte\" \"texture Kd\" \"t\"\nShape \"sphere\"\n"
            "Material \"matte\" \"texture Kd\" \"h\"\nShape \"sphere\" \"float radius\" 0.5\nObjectEnd\n"
            "ObjectInstance \"o\"\n")
    p = Picture(ball, "--proxy-granularity", "coarse")
    color = p.at(12, 8)
    fact("defect 13: balls show their pictures", color[0] > 0.1 and color[1] == 0)
    fact("defect 13: a coarse box makes only the material that rays hit",
         p.figures["materials_realized"] == 1 and p.figures["textures_opened"] == 1 and "hidden.png" not in p.log)


def defect_14():
    plain = Picture(SUN + SQUARE)
    alpha = Picture(SUN + "Texture \"a\" \"float\" \"constant\" \"float value\" 1\n" + SQUARE +
                    "\"texture alpha\" \"a\"\n")
    fact("defect 14: the first alpha material takes less than 64 KiB of device memory",
         alpha.figures["alphas_realized"] == 1 and
         abs(alpha.figures["peak_device_bytes"] - plain.figures["peak_device_bytes"]) < 1 << 16)


def defect_15():
    write_png("black.png", (0, 0, 0, 255))
    p = Picture("Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"black.png\"\nScale .5 .5 .5\n"
                "Translate 2 0 0\n" + SQUARE + "\"texture alpha\" \"a\"\nTranslate -2 0 0\n" + SQUARE +
                "\nTranslate -2 0 0\n" + SQUARE + "\"float alpha\" -0.0\n", "--bg", "0/0/1")
    left, middle, right = p.at(7, 8), p.at(12, 8), p.at(16, 8)
    fact("defect 15: a black picture cuts out in pbrt-v3, although its own alpha is 255",
         left == (0, 0, 1) and middle != left)
    fact("defect 15: an alpha of -0 cuts out", right == (0, 0, 1) and middle != right)


def defect_16():
    def shiny(ks):
        return Picture(SUN + f"Material \"plastic\" \"rgb Kd\" [ .2 .2 .2 ] \"rgb Ks\" [ {ks} {ks} {ks} ] "
                       "\"float roughness\" .3\nShape \"sphere\"\n")
    lit, matt = shiny(1), shiny(0)
    gains = [a - b for a, b in zip(lit.numbers[::3], matt.numbers[::3])]
    lights = sum(b > 0.1 for b in matt.numbers[::3])  # ambient light is 0.08
    fact("defect 16: highlights cover a part of what a light shines on",
         max(gains) > 0.1 and 0 < sum(g > 0.01 for g in gains) < lights)


def defect_17():
    room = (SUN + "LightSource \"infinite\" \"rgb L\" [ .3 .3 .3 ]\n" + SQUARE + "\nTranslate 0 -1 -.5\n"
            "Shape \"sphere\" \"float radius\" .3\nTranslate .5 0 0\nShape \"disk\" \"float radius\" .4\n" + OBJECT)
    for mode in "near", "path":
        fact(f"defect 17: pictures of mode {mode} do not depend on what was loaded when",
             are_equal(*two_ways(room, "--render-mode", mode, "--samples", "2")))


def defect_18():
    def sky(scale, turn):
        return Picture(f"Rotate {turn} 0 0 1\nLightSource \"infinite\" \"string mapname\" \"halves.pfm\" "
                       f"\"rgb scale\" [ {scale} {scale} {scale} ]\n")
    write_halves()
    one, turned = sky(1, 0), sky(2, 180)
    fact("defect 18: maps of infinite lights are shown, scaled and turned",
         one.at(12, 8)[0] == 1 and turned.at(12, 8)[0] == 0.5)
    scenes = []
    for unit in 0.001, 10000:
        scenes.append(Picture(f"LookAt 0 {-5 * unit} {unit}  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 40\n"
                              f"WorldBegin\nLightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\nScale {unit} {unit} {unit}\n" +
                              SQUARE + "\nShape \"sphere\" \"float radius\" .5\nTranslate 0 0 -.5\n"
                              "Shape \"disk\" \"float radius\" 3\nWorldEnd\n", "--render-mode", "path",
                              "--samples", "64"))
    means = [sum(p.numbers) / len(p.numbers) for p in scenes]
    fact("defect 18: scenes of 1/1000 and of 10 000 units show the same light",
         all(p.done for p in scenes) and 0.2 < means[0] < 1 and abs(means[0] - means[1]) < 0.01 * means[0])


def defect_19():
    write_png("never-alpha.png", (255, 255, 255))
    write_png("seen-alpha.png", (255, 255, 255))
    textures = "".join(f"Texture \"{name}\" \"float\" \"imagemap\" \"string filename\" \"{name}-alpha.png\"\n"
                       for name in ("never", "seen"))
    wall = "AttributeBegin\nScale 4 1 4\n" + SQUARE + "\nAttributeEnd\n"
    # Both leaves reach from before the wall to behind it: rays enter the box of the one that is hidden, too.
    leaf = "Shape \"trianglemesh\" \"integer indices\" [ {} ] \"point P\" [ -1 -.5 -1  -.9 -.5 -1  -1 -.5 -.9  -1 .1 -1" \
           "  1 .1 -1  0 .1 1 ] \"texture alpha\" \"{}\"\n"
    p = Picture(textures + wall + leaf.format("3 4 5", "never") + "Translate 0 -.3 0\n" + leaf.format("3 4 5", "seen"))
    fact("defect 19: alpha is asked for where a leaf is the nearest hit, and not behind a wall",
         p.figures["alphas_realized"] == 1 and "seen-alpha" in p.log and "never-alpha" not in p.log and
         p.figures["shapes_entered"] == 3)


def defect_20():
    write_png("shared.png", (200, 200, 200))
    p = Picture("Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"shared.png\"\n"
                "Texture \"c\" \"color\" \"imagemap\" \"string filename\" \"shared.png\"\n"
                "Texture \"d\" \"color\" \"imagemap\" \"string filename\" \"shared.png\"\n"
                "Material \"matte\" \"texture Kd\" \"c\"\n" + SQUARE + "\"texture alpha\" \"a\"\n"
                "Translate 1.5 0 0\nMaterial \"matte\" \"texture Kd\" \"d\"\n" + SQUARE)
    fact("defect 20: one picture of three textures is read once",
         p.figures["alphas_realized"] == 1 and p.figures["materials_realized"] == 2 and p.figures["textures_opened"] == 1 and
         p.log.count("picture ") == 1)


def materials():
    """The peer shares materials of equal numbers, whatever their pictures are."""
    write_png("one.png", (255, 0, 0))
    write_png("other.png", (0, 255, 0))
    textures = "".join(f"Texture \"{name}\" \"color\" \"imagemap\" \"string filename\" \"{name}.png\"\n"
                       for name in ("one", "other"))
    row = textures + ("Texture \"fields\" \"color\" \"checkerboard\" \"rgb tex1\" [ 0 0 1 ] \"texture tex2\" \"one\"\n"
                      "Scale .3 .3 .3\nTranslate -3 0 0\n")
    for name in "one", "other", "one", "fields", "other":
        row += f"Material \"matte\" \"texture Kd\" \"{name}\"\n" + SQUARE + "\nTranslate 2 0 0\n"
    plain = Picture(row)
    colors = [plain.at(x, 8) for x in (15, 13, 10)]
    fact("materials are shared where all they refer to is equal",
         colors[0][0] > 0.1 and colors[0][1] == 0 and colors[1][1] > 0.1 and colors[1][0] == 0 and
         colors[2][0] > 0.1 and colors[2][1] == 0 and plain.figures["materials_realized"] == 3)
    for path in "pipeline", "compute":
        short = Picture(row, "--material-budget", "1K", "--path", path, "--samples", "2", "--budget", "1K")
        whole = Picture(row, "--path", path, "--samples", "2")
        fact(f"materials and meshes that leave for others come back the same, path {path}",
             are_equal(short, whole) and short.figures["materials_evicted"] > 0 and short.figures["geometries_evicted"] > 0)


def holes_and_skies():
    """Both versions' alpha: below the middle of a ball, and beyond half of the radius of a disk."""
    parts = ("WorldBegin\nTexture \"a\" \"float\" \"checkerboard\" \"float tex1\" 0 \"float tex2\" 1 \"float vscale\" 2\n"
             "Translate 1 0 0\nShape \"sphere\" \"float radius\" .8 \"texture alpha\" \"a\"\nTranslate -2 0 0\n"
             "Rotate 90 1 0 0\nShape \"disk\" \"float radius\" .8 \"texture alpha\" \"a\"\n")
    for side, ball, disk in (-5, 7, 16), (5, 16, 7):
        camera = f"LookAt 0 {side} 0  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 40\n"
        p = Picture(camera + parts, "--bg", "0/0/1")
        fact(f"balls and disks have alpha, seen from {'the front' if side < 0 else 'behind'}",
             [p.at(*at) == (0, 0, 1) for at in ((ball, 6), (ball, 10), (disk, 8), (disk + 3, 8), (disk - 3, 8))] ==
             [False, True, False, True, True])
    write_halves()
    halves = "LightSource \"infinite\" \"string mapname\" \"halves.pfm\"\n"
    fact("all maps of infinite lights add up, the first texture among them",
         Picture(halves + "Rotate 180 0 0 1\n" + halves).at(12, 8)[0] == 1.25)


def shapes_without_a_place():
    triangle = "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 ] \"point P\" [ {} ]\n"
    odd = "".join(triangle.format(points) for points in (
        "0 0 0 0 0 0 0 0 0", "0 0 0 1e35 0 0 0 1e35 0", "0 0 0 1e-35 0 0 0 1e-35 0"))
    plain, beside = Picture(SUN + SQUARE), Picture(SUN + odd + SQUARE)
    fact("shapes that are a point, tiny or beyond all numbers leave the rest of the picture as it is",
         beside.done and are_equal(plain, beside) and "the shape is left out" in beside.log)


shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
for test in (defect_6, defects_11_and_12, defect_13, defect_14, defect_15, defect_16, defect_17, defect_18, defect_19,
             defect_20, materials, holes_and_skies, shapes_without_a_place):
    test()
print(f"1..{number}")
sys.exit(failed)
