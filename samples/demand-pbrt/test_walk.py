"""test_walk.py DEMAND_PBRT FOLDER: rays of the compute path hit what a caster without trees hits, in TAP.

The caster looks at all triangles for each ray, in double precision. Each shape has a color of its own, so pixels tell what
was hit. Rays that pass an edge so closely that rounding decides are left out."""
import array
import math
import os
import random
import shutil
import subprocess
import sys

program, folder = sys.argv[1:3]
WIDTH, HEIGHT, FIELD = 48, 32, 60
EDGE = 1e-4  # of barycentric coordinates
number, failed = 0, False


def subtract(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


class Shape:
    """`triangles` are in the world; the scene names them before `scale` and `place`."""
    def __init__(self, index, triangles, scale=(1, 1, 1), place=(0, 0, 0)):
        self.color = ((index % 8 + 1) / 9, (index // 8 % 12 + 1) / 13, 0.5)
        self.triangles = [[[c * s + p for c, s, p in zip(corner, scale, place)] for corner in t] for t in triangles]
        points = " ".join(f"{c:.9g}" for t in triangles for corner in t for c in corner)
        indices = " ".join(str(i) for i in range(3 * len(triangles)))
        moved = "Translate {} {} {}\nScale {} {} {}\n".format(*place, *scale)
        self.text = ("AttributeBegin\n" + moved + "Material \"matte\" \"rgb Kd\" [ {} {} {} ]\n".format(*self.color) +
                     f"Shape \"trianglemesh\" \"integer indices\" [ {indices} ] \"point P\" [ {points} ]\nAttributeEnd\n")


def make_shapes():
    rng, shapes = random.Random(18), []

    def point(around, size):
        return [c + rng.uniform(-size, size) for c in around]

    for i in range(64):
        middle, kind = [rng.uniform(-3, 3), rng.uniform(-2, 2), rng.uniform(3, 9)], i % 4
        corners = [point(middle, 0.7) for _ in range(9)]
        triangles = [corners[0:3], corners[3:6], corners[6:9]]
        if kind == 1:  # boxes without thickness, across an axis
            for corner in corners:
                corner[i // 4 % 3] = middle[i // 4 % 3]
        elif kind == 2:  # triangles without area: a point, two equal corners, corners in a line
            a, b = corners[3:5]
            triangles += [[a, a, a], [a, b, b], [a, b, [2 * y - x for x, y in zip(a, b)]]]
        scale = (2, -0.5, 0.25) if kind == 3 else (1, 1, 1)
        place = (-middle[0], 1.5 * middle[1], 0.75 * middle[2]) if kind == 3 else (0, 0, 0)
        shapes.append(Shape(i, triangles, scale, place))
    return shapes


def meet(origin, direction, triangle):
    """Distance, and the least barycentric coordinate; None beside the triangle."""
    a, b = subtract(triangle[1], triangle[0]), subtract(triangle[2], triangle[0])
    p = cross(direction, b)
    det = dot(a, p)
    if abs(det) < 1e-12:
        return None
    to = subtract(origin, triangle[0])
    q = cross(to, a)
    u, v, t = dot(to, p) / det, dot(direction, q) / det, dot(b, q) / det
    least = min(u, v, 1 - u - v)
    return (t, least) if t > 0 and least > -EDGE else None


def cast(shapes, origin, direction):
    """The nearest shape or None, and whether rounding might decide."""
    hits = sorted((hit[0], hit[1], i) for i, shape in enumerate(shapes) for hit in
                  (meet(origin, direction, t) for t in shape.triangles) if hit)
    for t, least, i in hits:
        if least < EDGE:
            return None, True
        return i, any(other[2] != i and other[0] - t < 1e-4 * t for other in hits)
    return None, False


def rays(parallel):
    reach, wide = math.tan(math.radians(FIELD / 2)), WIDTH / HEIGHT
    for y in range(HEIGHT):
        for x in range(WIDTH):
            at = [wide * (2 * (x + 0.5) / WIDTH - 1), 1 - 2 * (y + 0.5) / HEIGHT]
            if parallel:
                yield x, y, [at[0], at[1], 0], [0, 0, 1]
            else:
                yield x, y, [0, 0, 0], [reach * at[0], reach * at[1], 1]


def render(shapes, camera, options):
    scene, picture = os.path.join(folder, "scene.pbrt"), os.path.join(folder, "picture.pfm")
    with open(scene, "w") as file:
        file.write(f"Camera {camera}\nWorldBegin\n" + "".join(shape.text for shape in shapes) + "WorldEnd\n")
    done = subprocess.run([program, scene, "--dim", f"{WIDTH}x{HEIGHT}", "--path", "compute", "--file", picture, *options],
                          capture_output=True, text=True)
    if done.returncode == 77:
        print("1..0 # SKIP no device traces rays")
        sys.exit(0)
    if done.returncode:
        print("# " + done.stderr.replace("\n", "\n# "))
        return None
    with open(picture, "rb") as file:
        numbers = array.array("f", file.read().split(b"\n", 3)[3])
    return lambda x, y: numbers[3 * ((HEIGHT - 1 - y) * WIDTH + x):][:3]


def is_shown(pixel, shape):
    if shape is None:
        return max(pixel) == 0
    return pixel[2] > 0 and all(abs(pixel[i] / pixel[2] - shape.color[i] / shape.color[2]) < 1e-3 for i in (0, 1))


def compare(name, shapes, camera, parallel, *options):
    global number, failed
    pixels, unclear, wrong, hit = render(shapes, camera, options), 0, [], 0
    for x, y, origin, direction in rays(parallel):
        shape, close = cast(shapes, origin, direction)
        unclear += close
        hit += shape is not None
        if pixels and not close and not is_shown(pixels(x, y), None if shape is None else shapes[shape]):
            wrong.append((x, y, shape))
    good = pixels and not wrong and unclear < 0.05 * WIDTH * HEIGHT and hit > 0.2 * WIDTH * HEIGHT
    number += 1
    print(f"# {hit} of {WIDTH * HEIGHT} rays hit, {unclear} left out, wrong: {wrong[:5]}")
    print(f"{'ok' if good else 'not ok'} {number} - {name}")
    failed = failed or not good


shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
all_shapes = make_shapes()
# Halfway between the two cameras lies the scene's own.
compare("rays in all directions hit what they hit without trees", all_shapes, f"\"perspective\" \"float fov\" {FIELD}", False,
        "--fly-from", "-2/1/0/-2/1/5", "--look-from", "2/-1/0/2/-1/5", "--fly-at", "1/2")
compare("rays along an axis hit what they hit without trees", all_shapes, "\"orthographic\"", True)
print(f"1..{number}")
sys.exit(failed)
