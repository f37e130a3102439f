#!/usr/bin/env python3
"""Every public function that can reach an allocator is in allocation_list.txt, with a test that is
run and that calls it. Prints TAP.

    check_allocation_list.py SOURCE_ROOT
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1])
TESTS = ROOT / "tests"


def headers():
    for path in sorted((ROOT / "include/sluice").glob("*.h")):
        yield path.read_text()


def functions():
    """Of each function its parameters and the comment before it."""
    found = {}
    for text in headers():
        for match in re.finditer(r"SLUICE_API\s([^;]*?)\b(sluice\w+)\s*\(([^;]*)\);", text):
            before = text[: match.start()].rstrip()
            comment = before[before.rfind("/**"):] if before.endswith("*/") else ""
            found[match.group(2)] = (match.group(3), comment)
    return found


def reaching_types():
    """Handles, and structs that name an allocator or hold one that does."""
    text = "\n".join(headers())
    handles = set(re.findall(r"typedef struct (Sluice\w+) Sluice\w+;", text))
    structs = dict(
        (match.group(1), match.group(2))
        for match in re.finditer(r"typedef struct (Sluice\w+) \{(.*?)\n\} Sluice\w+;", text, re.S))
    names = handles | {"SluiceAllocationCallbacks"}
    return names | {name for name, body in structs.items() if "SluiceAllocationCallbacks" in body}


def can_allocate(name, parameters, types):
    """What only gives back cannot."""
    gives_back = re.fullmatch(r"sluiceDestroy(?!Demand(Texture|Resource))\w+", name)
    return not gives_back and any(word in types for word in re.findall(r"\w+", parameters))


def read_list():
    lines = (ROOT / "tests/extremes/allocation_list.txt").read_text().splitlines()
    return [line.split() for line in lines if line and not line.startswith("#")]


def text_with_helpers(path):
    """The test and the sources behind the headers of tests that it includes."""
    text = path.read_text()
    for header in re.findall(r'#include "([\w/]+)\.h"', text):
        source = TESTS / (header + ".c")
        text += source.read_text() if source.exists() else ""
    return text


def check():
    known, types, entries = functions(), reaching_types(), read_list()
    listed = [entry[0] for entry in entries]
    needed = {name for name, (parameters, _) in known.items()
              if can_allocate(name, parameters, types)}
    yield ("headers_were_understood", [] if len(known) > 100 and len(needed) > 80 else
           [f"{len(known)} functions, of which {len(needed)} can reach an allocator"])
    yield ("every_function_that_can_reach_an_allocator_is_listed", sorted(needed - set(listed)))
    yield ("no_function_is_listed_that_is_not_there_or_twice", sorted(
        name for name in listed if name not in known or listed.count(name) > 1))
    yield ("every_entry_is_whole", [
        " ".join(entry) for entry in entries
        if len(entry) != 4 or entry[1] not in ("refused", "none") or
        not (ROOT / entry[2]).is_file()])
    yield ("what_may_lack_memory_is_not_said_to_take_none", [
        entry[0] for entry in entries if entry[1] == "none" and
        "OUT_OF_HOST_MEMORY" in known.get(entry[0], ("", ""))[1] and
        entry[0] != "sluiceWaitVulkanStreamerIdle"])  # Vulkan may lack it
    yield ("every_test_is_run", [
        " ".join(entry) for entry in entries
        if f"cmocka_unit_test({entry[3]})" not in (ROOT / entry[2]).read_text()])
    yield ("every_test_calls_its_function", [
        " ".join(entry) for entry in entries
        if not re.search(rf"\b{entry[0]}\b", text_with_helpers(ROOT / entry[2]))])


def main():
    facts = list(check())
    print(f"1..{len(facts)}")
    for number, (fact, wrong) in enumerate(facts, 1):
        print(f"{'not ok' if wrong else 'ok'} {number} - {fact}")
        for line in wrong:
            print("# " + line)
    return any(wrong for _, wrong in facts)


sys.exit(main())
