"""check_nonuniform.py LEAST HEADER...: every image that a module picks out of an array by a number
is marked as non-uniform, where it is loaded and where it is sampled, and not only in the number.

Vulkan looks at the operand of the sample (VUID-RuntimeSpirv-NonUniform-06274). Devices that share a
descriptor among the lanes of a subgroup sample the wrong texture without the mark; others do not show
that it is missing. LEAST samples of arrays must be there. A header has the words of one module. Prints TAP."""
import re
import sys

OP_CONSTANT, OP_SPEC_CONSTANT, OP_LOAD, OP_ACCESS_CHAIN, OP_IN_BOUNDS = 43, 50, 61, 65, 66
OP_DECORATE, OP_SAMPLED_IMAGE, OP_IMAGE, OP_COPY_OBJECT = 71, 86, 100, 83
NON_UNIFORM = 5300
SAMPLES = set(range(87, 98)) | {101, 102, 103, 104, 105} | set(range(305, 316))  # OpImageSample... to OpImageGather


def instructions(path):
    with open(path, encoding="ascii") as file:
        words = [int(word, 16) for word in re.findall(r"\b0x[0-9a-f]{8}\b", file.read())]
    assert words[0] == 0x07230203
    at = 5
    while at < len(words):
        count = words[at] >> 16
        yield words[at] & 0xFFFF, words[at + 1 : at + count]
        at += count


def trace(made, constants, value):
    """All values on the way from an operand of a sample to the array; and whether a number chose it."""
    way, varies, queue = [], False, [value]
    while queue:
        value = queue.pop()
        op, operands = made.get(value, (None, ()))
        if op in (OP_LOAD, OP_IMAGE, OP_COPY_OBJECT, OP_SAMPLED_IMAGE):
            way.append(value)
            queue += operands[: 2 if op == OP_SAMPLED_IMAGE else 1]
        elif op in (OP_ACCESS_CHAIN, OP_IN_BOUNDS):
            way.append(value)
            chosen = [index for index in operands[1:] if index not in constants]
            varies = varies or bool(chosen)
            way += chosen
    return way, varies


def check(path):
    made, constants, marked, samples = {}, set(), set(), []
    for op, words in instructions(path):
        if op == OP_DECORATE and words[1] == NON_UNIFORM:
            marked.add(words[0])
        elif op in (OP_CONSTANT, OP_SPEC_CONSTANT):
            constants.add(words[1])
        elif op in (OP_LOAD, OP_ACCESS_CHAIN, OP_IN_BOUNDS, OP_SAMPLED_IMAGE, OP_IMAGE, OP_COPY_OBJECT):
            made[words[1]] = (op, words[2:])
        elif op in SAMPLES:
            samples.append(words[2])
    count, missing = 0, 0
    for sample in samples:
        way, varies = trace(made, constants, sample)
        if not varies:
            continue
        count += 1
        # A sampled image is made of a marked image and sampler; only its copy can carry the mark.
        unmarked = [v for v in way if v not in marked and made.get(v, (0,))[0] != OP_SAMPLED_IMAGE]
        if sample not in marked or unmarked:
            missing += 1
            print("# %s: sample of %%%d: not marked: %s" % (path, sample, unmarked or sample))
    return count, missing


def main():
    least, paths, failed = int(sys.argv[1]), sys.argv[2:], 0
    print("1..%d" % len(paths))
    for number, path in enumerate(paths, 1):
        count, missing = check(path)
        good = missing == 0 and count >= least
        failed += not good
        name = path.split("/")[-1]
        print("%sok %d - %s_marks_%d_samples_of_arrays" % ("" if good else "not ", number, name, count))
    return failed != 0


sys.exit(main())
