#!/usr/bin/env python3
"""compare_runs.py DEMAND_PBRT SCENE [OPTION ...]: tells which ways of loading change a picture, and in which pixels.

Renders the scene in mode path, 1920x1080, twice in each way, and counts pixels that differ between both and from
--preload. Then prints what the first rays of the pixels that differ hit, in each way. OPTION is added to each run."""
import array
import json
import os
import subprocess
import sys
import tempfile

WAYS = [["--preload"], [], ["--preload-shapes"], ["--uncompacted"], ["--threads", "1"], ["--oneshot-material"],
        ["--sort-proxies"], ["--proxy-granularity", "coarse"], ["--depth", "0", "--preload"], ["--depth", "0"]]
MOST_PIXELS = 3


def render(program, scene, folder, options):
    """The picture as rows of floats from the bottom up, its size, launches, and what was said."""
    path = os.path.join(folder, "run.pfm")
    done = subprocess.run([program, scene, "--dim", "1920x1080", "--render-mode", "path", "--json", "--file", path,
                           "--cache", os.path.join(folder, "cache"), *options], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(options)}: exit status {done.returncode}\n{done.stderr}")
    with open(path, "rb") as file:
        file.readline()
        width, height = map(int, file.readline().split())
        file.readline()
        floats = array.array("I", file.read())
    figures = {line["name"]: line["value"] for line in map(json.loads, done.stdout.splitlines())}
    return floats, width, height, figures["launches"], done.stderr


def different(one, other):
    """(x, y) of pixels, from the top."""
    floats, width, height = one[:3]
    if floats == other[0]:
        return []
    return [(i % width, height - 1 - i // width) for i in range(width * height)
            if floats[3 * i:3 * i + 3] != other[0][3 * i:3 * i + 3]]


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program, scene, options = sys.argv[1], sys.argv[2], sys.argv[3:]
    pixels = []
    with tempfile.TemporaryDirectory() as folder:
        truth = {}
        for way in WAYS:
            depth = tuple(way[:2]) if "--depth" in way else ()
            one, other = (render(program, scene, folder, options + way) for _ in range(2))
            if "--preload" in way:
                truth[depth] = one
            line = f"{' '.join(way) or '(on demand)'}: launches {one[3]} and {other[3]}"
            line += f"; runs differ in {len(different(one, other))} pixels"
            if depth in truth:
                found = different(one, truth[depth])
                line += f"; from --preload in {len(found)}: {found[:MOST_PIXELS]}"
                pixels += found[:MOST_PIXELS]
            print(line, flush=True)
        for x, y in sorted(set(pixels))[:MOST_PIXELS]:
            for way in ["--preload"], []:
                said = render(program, scene, folder, options + way + ["--debug", f"{x}/{y}"])[4]
                print(f"pixel {x}/{y} {' '.join(way) or '(on demand)'}")
                print("".join(f"    {line}\n" for line in said.splitlines() if "pixel" in line), end="", flush=True)


if __name__ == "__main__":
    main()
