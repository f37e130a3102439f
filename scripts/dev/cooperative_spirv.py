#!/usr/bin/env python3
"""Makes the kept SPIR-V of shaders with cooperative vectors and matrices, or checks it.

    scripts/dev/cooperative_spirv.py [--check] [--glslang PROGRAM]
    scripts/dev/cooperative_spirv.py --words FILE.spv SYMBOL OUT.h

glslang 16 compiles GL_NV_cooperative_vector and GL_KHR_cooperative_matrix; that of Debian 12, with which all else is
compiled, does not. So shaders/cooperative keeps their SPIR-V, and sources.txt there says of which text it was made.

--check   compares: text with sources.txt always, SPIR-V if PROGRAM has the kept version. Prints TAP.
--glslang compiler (default: glslangValidator)
--words   writes a module as an array in a C header, as glslangValidator --vn does
"""

import argparse
import hashlib
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
KEPT = ROOT / "shaders/cooperative"
VECTOR = ["-DSLUICE_NEURAL_VECTOR", "-DSLUICE_NEURAL_SCHEMA=3"]
FP8 = ["-DSLUICE_NEURAL_FP8"]
MATRIX = ["-DNEURAL_MATRIX"]
TEST = ROOT / "tests/device/shaders/neural.comp"
BENCH = ROOT / "bench/neural/shaders/neural_bench.comp"
GALLERY = ROOT / "samples/streaming/neural.frag"
MODULES = {
    "neural_vector_int8": (TEST, VECTOR),
    "neural_vector_fp8": (TEST, VECTOR + FP8),
    "neural_matrix": (TEST, MATRIX),
    "neural_bench_vector_int8": (BENCH, VECTOR),
    "neural_bench_vector_fp8": (BENCH, VECTOR + FP8),
    "neural_bench_matrix": (BENCH, MATRIX + ["-DSLUICE_NEURAL_SCHEMA=3"]),
    "gallery_neural_vector_int8": (GALLERY, VECTOR),
    "gallery_neural_vector_fp8": (GALLERY, VECTOR + FP8),
}


def included(path, seen):
    """Adds a shader and the files that it includes to `seen`."""
    if path in seen:
        return
    seen.append(path)
    for name in re.findall(r'#include "([^"]+)"', path.read_text()):
        for folder in (path.parent, ROOT / "shaders/include"):
            if (folder / name).exists():
                included((folder / name).resolve(), seen)
                break


def text_hash(shader):
    """Returns a hash of a shader and what it includes, without comments and spacing."""
    files = []
    included(shader, files)
    text = "\n".join(path.read_text() for path in files)
    text = re.sub(r"/\*.*?\*/|//[^\n]*", " ", text, flags=re.S)
    return hashlib.sha256(" ".join(text.split()).encode()).hexdigest()


def compiler_version(glslang):
    """Returns the version of a compiler, or None."""
    try:
        out = subprocess.run([glslang, "--version"], capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return None
    found = re.search(r"Glslang Version: \d+:(\S+)", out)
    return found.group(1) if found else None


def compile_module(glslang, shader, defines, out):
    command = [glslang, "-V", "-g0", "--quiet", "--target-env", "vulkan1.2", f"-I{ROOT / 'shaders/include'}",
               f"-I{shader.parent}", *defines, "-o", str(out), str(shader)]
    return subprocess.run(command, check=False).returncode == 0


def write_words(spv, symbol, out):
    data = pathlib.Path(spv).read_bytes()
    words = struct.unpack(f"<{len(data) // 4}I", data)
    lines = [", ".join(f"0x{word:08x}" for word in words[i:i + 8]) for i in range(0, len(words), 8)]
    pathlib.Path(out).write_text(f"const uint32_t {symbol}[] = {{\n" + ",\n".join(lines) + "\n};\n")


def make(glslang):
    version = compiler_version(glslang)
    if not version:
        print(f"{glslang} does not run", file=sys.stderr)
        return 1
    lines = [f"glslang {version}"]
    for name, (shader, defines) in MODULES.items():
        if not compile_module(glslang, shader, defines, KEPT / f"{name}.spv"):
            return 1
        lines.append(f"{name} {text_hash(shader)}")
    (KEPT / "sources.txt").write_text("\n".join(lines) + "\n")
    return 0


def check(glslang):
    kept = dict(line.split() for line in (KEPT / "sources.txt").read_text().splitlines())
    has_compiler = compiler_version(glslang) == kept["glslang"]
    status = 0
    print(f"1..{2 * len(MODULES)}")
    for number, (name, (shader, defines)) in enumerate(MODULES.items()):
        same = text_hash(shader) == kept.get(name)
        status |= not same
        print(f"{'' if same else 'not '}ok {2 * number + 1} - {name} was made of today's text")
        if not has_compiler:
            print(f"ok {2 * number + 2} - {name} is what its text gives # SKIP there is no glslang {kept['glslang']}")
            continue
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "out.spv"
            same = compile_module(glslang, shader, defines, out) and \
                out.read_bytes() == (KEPT / f"{name}.spv").read_bytes()
        status |= not same
        print(f"{'' if same else 'not '}ok {2 * number + 2} - {name} is what its text gives")
    return status


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--glslang", default="glslangValidator")
    parser.add_argument("--words", nargs=3, metavar=("SPV", "SYMBOL", "OUT"))
    arguments = parser.parse_args()
    if arguments.words:
        write_words(*arguments.words)
        return 0
    return check(arguments.glslang) if arguments.check else make(arguments.glslang)


if __name__ == "__main__":
    sys.exit(main())
