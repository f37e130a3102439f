"""test_neural_gallery.py STREAMING MAKE_NEURAL_FILE FOLDER: a neural set hangs in the gallery.

What the C decoder makes (mode load) is the oracle of what the GPU and the shader make. Prints TAP.
"""
import json
import math
import os
import shutil
import struct
import subprocess
import sys
import zlib

STREAMING, MAKE, FOLDER = (os.path.abspath(path) for path in sys.argv[1:4])
FIGURES = ("psnr_final_db", "flip_final", "texture_bytes_peak", "latent_bytes_peak", "file_bytes_read",
           "frames_to_first_sharp", "frames_to_final")
LAST = "frame-0004.png"
number = 0


def fact(name, holds):
    global number
    number += 1
    print("%sok %d - %s" % ("" if holds else "not ", number, name), flush=True)
    return holds


def run(*options):
    done = subprocess.run([STREAMING, "--cache", "cache", *options], capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


def write_exr(path, size):
    """A picture of floats from 0.25 to 16: one uncompressed line after the other."""
    def attribute(name, kind, value):
        return name + b"\0" + kind + b"\0" + struct.pack("<I", len(value)) + value
    channels = b"".join(name + b"\0" + struct.pack("<IIII", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    box = struct.pack("<IIII", 0, 0, size - 1, size - 1)
    head = struct.pack("<II", 20000630, 2) + attribute(b"channels", b"chlist", channels) + \
        attribute(b"compression", b"compression", b"\0") + attribute(b"dataWindow", b"box2i", box) + \
        attribute(b"displayWindow", b"box2i", box) + attribute(b"lineOrder", b"lineOrder", b"\0") + \
        attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1)) + \
        attribute(b"screenWindowCenter", b"v2f", struct.pack("<ff", 0, 0)) + \
        attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0"
    lines = [struct.pack("<II", y, 12 * size) +
             b"".join(struct.pack("<f", 0.25 * 2.0 ** ((x + y + c) % 7)) for c in range(3) for x in range(size))
             for y in range(size)]
    first = len(head) + 8 * size
    with open(path, "wb") as file:
        file.write(head + struct.pack("<%dQ" % size, *(first + y * len(lines[0]) for y in range(size))) +
                   b"".join(lines))


def walk(mode, *options, folder="in"):
    """Figures of a walk in which the camera rests before a picture."""
    status, out, err = run("--neural-set", folder + "/set.ntc", "--neural-as", mode, "--generate-scale", "32", "--size",
                           "160x90", "--samples", "1", "--frames", "5", "--rest-frames", "5", "--deterministic",
                           "--probability", "1", "--needs", "off", "--output", mode, "--json", *options)
    if status:
        print("# " + err.replace("\n", "\n# "))
    figures = (json.loads(line) for line in out.splitlines())
    return {figure["name"]: figure["value"] for figure in figures} if status == 0 else {}


def read_png(path):
    """Bytes of an RGB picture."""
    with open(path, "rb") as file:
        data = file.read()[8:]
    packed, at = b"", 0
    while at < len(data):
        size, kind = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width = int.from_bytes(body[:4], "big")
        packed += body if kind == b"IDAT" else b""
        at += size + 12
    lines, row, pixels = zlib.decompress(packed), [0] * (3 * width), []
    for start in range(0, len(lines), 3 * width + 1):
        above, kind, row = row, lines[start], []
        for i, byte in enumerate(lines[start + 1:start + 1 + 3 * width]):
            left, up, corner = (row[i - 3] if i > 2 else 0), above[i], (above[i - 3] if i > 2 else 0)
            nearest = min((left, up, corner), key=lambda v: abs(left + up - corner - v))
            row.append(byte + (0, left, up, (left + up) // 2, nearest)[kind] & 255)
        pixels += row
    return pixels


def psnr(a, b):
    error = sum((x - y) ** 2 for x, y in zip(a, b)) / len(a)
    return 10 * math.log10(255 ** 2 / error) if error else math.inf


def same(a, b):
    with open(a, "rb") as one, open(b, "rb") as other:
        return one.read() == other.read()


def check_dot():
    dot = walk("sample", "--neural-picks", "8", "--neural-path", "dot", "--output", "dot")
    return bool(dot) and same("sample/" + LAST, "dot/" + LAST)


def check_light():
    os.makedirs("light")
    write_exr("light/light.exr", 64)
    if subprocess.run([MAKE, "light/set.ntc", "light"]).returncode:
        return False
    modes = ("load", "sample")
    if not all(walk(mode, "--neural-picks", "8", "--output", "light-" + mode, folder="light") for mode in modes):
        return False
    load, sample = (read_png("light-%s/%s" % (mode, LAST)) for mode in modes)
    print("# light: %.2f dB to load" % psnr(sample, load))
    return psnr(sample, load) > 12 and 0.9 < sum(sample) / sum(load) < 1.1


def main():
    shutil.rmtree(FOLDER, ignore_errors=True)
    os.makedirs(FOLDER)
    os.chdir(FOLDER)
    status, _, err = run("--neural-material", "in")
    made = status == 0 and subprocess.run([MAKE, "in/set.ntc", "mosaic"]).returncode == 0
    good = fact("a_material_is_written", made and sorted(os.listdir("in")) ==
                ["albedo.png", "height.png", "roughness.png", "set.ntc"])
    figures = {"load": walk("load", "--reference", "truth", "--compare-with", "dense"),
               "feedback": walk("feedback", "--format", "rgba8"),
               "sample": walk("sample", "--neural-picks", "8", "--neural-path", "plain", "--validation")}
    if not all(figures.values()):
        print("Bail out! a walk failed")
        return 1
    good &= fact("all_figures_are_reported", all(figures["load"].get(name) is not None for name in FIGURES))
    good &= fact("the_truth_is_the_pictures_that_were_compressed", figures["load"]["psnr_final_db"] < 30 and
                 not same("load/" + LAST, "load/" + LAST.replace("frame", "truth")))
    good &= fact("decoded_on_feedback_they_are_the_c_decoders_bit_by_bit", same("load/" + LAST, "feedback/" + LAST))
    decibels = psnr(read_png("sample/" + LAST), read_png("load/" + LAST))
    print("# sample: %.2f dB to load" % decibels)
    good &= fact("the_mean_of_8_texels_is_the_c_decoders_picture_to_18_db", decibels > 18)
    good &= fact("latents_take_memory_where_they_are_decoded_on_the_gpu",
                 [figures[mode]["latent_bytes_peak"] > 0 for mode in ("load", "feedback", "sample")] ==
                 [False, True, True])
    good &= fact("only_one_copy_of_the_latents_is_read_on_sample",
                 figures["sample"]["file_bytes_read"] < 2 * os.path.getsize("in/set.ntc"))
    good &= fact("integer_dot_products_give_the_same_picture", check_dot())
    good &= fact("colors_above_1_come_through_in_all_modes", check_light())
    os.rename("in/height.png", "height.png")
    status, _, err = run("--neural-set", "in/set.ntc", "--output", "refused")
    good &= fact("a_texture_without_its_original_is_named", status == 1 and "in/set.ntc" in err and
                 "height.png" in err)
    status, _, err = run("--neural-set", "height.png", "--output", "refused")
    good &= fact("a_file_that_is_no_set_is_refused_by_name", status == 1 and "height.png" in err)
    wrong = [run(*options, "--output", "refused")[0] for options in (
        ("--neural-set", "a.ntc", "--neural-as", "all"), ("--neural-set", "a.ntc", "--neural-as", "raw", "raw"),
        ("--neural-set", "a.ntc", "--images", "in"), ("--neural-set", "a.ntc", "--neural-picks", "65"),
        ("--neural-set", "a.ntc", "--neural-path", "matrix"))]
    good &= fact("wrong_options_exit_with_2", wrong == [2] * 5)
    print("1..%d" % number)
    return 0 if good else 1


sys.exit(main())
