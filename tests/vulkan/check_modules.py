"""check_modules.py SPIRV_VAL HEADER...: spirv-val finds no fault in the modules that programs contain.

A header has the words of one module, as glslangValidator --vn writes them. Prints TAP."""
import concurrent.futures
import os
import re
import struct
import subprocess
import sys


def check(path):
    """Returns what spirv-val says of a header's module; empty if the module is valid."""
    with open(path, encoding="ascii") as file:
        words = [int(word, 16) for word in re.findall(r"\b0x[0-9a-f]{8}\b", file.read())]
    module = struct.pack("<%dI" % len(words), *words)
    command = [sys.argv[1], "--target-env", "vulkan1.2", "-"]
    run = subprocess.run(command, input=module, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    if run.returncode == 0 and words:
        return ""
    return run.stdout.decode(errors="replace") or "exit status %d, %d words" % (run.returncode, len(words))


def main():
    paths, failed = sys.argv[2:], 0
    print("1..%d" % len(paths))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for number, (path, said) in enumerate(zip(paths, pool.map(check, paths)), 1):
            failed += said != ""
            for line in said.splitlines():
                print("# " + line)
            print("%sok %d - %s_is_valid" % ("not " if said else "", number, path.removesuffix(".h")))
    return failed != 0


sys.exit(main())
