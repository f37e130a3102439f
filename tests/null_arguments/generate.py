#!/usr/bin/env python3
"""generate.py HEADERS CALLS OUTPUT...: tests that call every public function with NULL and zero.

HEADERS is the folder of the public headers. Every CALLS (a .c file here) lists valid calls in its
comment that begins with "CALLS", one per line:

    sluiceNoun(argument, ?argument, ...) => statement

`?`: NULL is allowed there. `!` before the name: the call with all of its arguments is left out, as
that would destroy what the others need, or the fixture is not that far. `~`: with all arguments
NULL and 0 it does nothing and succeeds.
The statement runs after each call. OUTPUT, one per CALLS and in their order, gets a test per
function: each argument in turn is NULL or 0, then all of them, then each info that is read is all
zeros. Fails if a function has no line, a line no function, or the number of arguments is wrong.

Functions that take a struct with structSize get a second test (struct sized in calls.h). In both
tests outputs of the form &f->out.NAME have their structSize.
"""
import os
import re
import sys


def strip_comments(text):
    return re.sub(r"//[^\n]*", "", re.sub(r"/\*.*?\*/", "", text, flags=re.S))


def split_commas(text):
    parts, depth, part = [], 0, ""
    for c in text:
        depth += (c in "([{") - (c in ")]}")
        if c == "," and depth == 0:
            parts.append(part.strip())
            part = ""
        else:
            part += c
    return parts + [part.strip()] if part.strip() else parts


def parse_parameter(text):
    """The type, and the name."""
    text = " ".join(text.split())
    array = re.fullmatch(r"(.*?)(\w+)\[\w*\]", text)
    match = array or re.fullmatch(r"(.*?)(\w+)", text)
    return match[1].strip() + (" *" if array else ""), match[2]


def read_headers(folder):
    """Functions by name as (result, [(type, name)]), the structs, and those with structSize."""
    functions, structs, growing = {}, set(), set()
    for name in sorted(os.listdir(folder)):
        if not name.endswith(".h"):
            continue
        with open(os.path.join(folder, name), encoding="utf-8") as file:
            text = strip_comments(file.read())
        structs |= set(re.findall(r"\btypedef struct (\w+) \{", text))
        growing |= set(re.findall(r"\btypedef struct (\w+) \{\s*uint32_t structSize;", text))
        if text.count("uint32_t structSize;") != len(
                re.findall(r"\btypedef struct \w+ \{\s*uint32_t structSize;", text)):
            sys.exit(f"{name}: structSize is not the first field")
        declarations = re.findall(r"\bSLUICE_API\s+([^;{}]*?)\b(sluice\w+)\s*\(([^;]*)\)\s*;", text)
        if len(declarations) != len(re.findall(r"^(?!#).*\bSLUICE_API\b", text, flags=re.M)):
            sys.exit(f"{name}: a declaration is not understood")
        for result, function, parameters in declarations:
            functions[function] = (" ".join(result.split()),
                                   [parse_parameter(p) for p in split_commas(parameters)])
    return functions, structs, growing


def read_calls(path):
    """Valid calls by name as (arguments, statement after, mark before the name)."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    calls = {}
    block = re.search(r"/\* CALLS\n(.*?)\*/", text, flags=re.S)
    for line in block[1].splitlines():
        if not line.strip():
            continue
        match = re.fullmatch(r"\s*(?:\* )?([!~]?)(sluice\w+)\((.*?)\)(?: => (.*))?", line)
        if not match:
            sys.exit(f"{path}: not a call: {line}")
        calls[match[2]] = (split_commas(match[3]), match[4], match[1])
    return calls


def is_pointer(kind):
    return kind.endswith("*") or kind.startswith(("Vk", "PFN_"))


def begin_call(out, arguments, parameters, growing):
    out.append("    calls_begin(f);")
    for argument, (kind, _) in zip(arguments, parameters):
        if argument.startswith("&f->out.") and kind.rstrip(" *") in growing:
            out.append(f"    {argument[1:]}.structSize = sizeof {argument[1:]};")


def write_call(out, function, result, arguments, after, what, expected):
    call = f"{function}({', '.join(arguments)})"
    if result == "SluiceResult":
        out.append(f'    {expected}("{what}", {call});')
    else:
        out.append(f"    (void){call};")
    if after:
        out.append(f"    {after};")


def write_function(out, name, function, call, structs, growing):
    result, parameters = function
    arguments, after, mark = call
    optional = [a.startswith("?") for a in arguments]
    arguments = [a.lstrip("?") for a in arguments]
    if len(arguments) != len(parameters):
        sys.exit(f"{name} has {len(parameters)} parameters, its line {len(arguments)}")
    zeros = [f"({kind})0" for kind, _ in parameters]
    out.append(f"static void {name}_stands_null_and_zero(void **state)")
    out.append("{")
    out.append("    struct fixture *f = calls_setup(state);")
    required = False
    for i, (kind, parameter) in enumerate(parameters):
        given = arguments[:i] + [zeros[i]] + arguments[i + 1:]
        null = is_pointer(kind) and not optional[i]
        required |= null
        begin_call(out, given, parameters, growing)
        write_call(out, name, result, given, after, f"{name}, {parameter} 0",
                   "check_null" if null else "check_any")
    if len(parameters) > 1:
        begin_call(out, zeros, parameters, growing)
        write_call(out, name, result, zeros, after, f"{name}, all 0",
                   "check_error" if required and mark != "~" else "check_any")
    for i, (kind, parameter) in enumerate(parameters):
        pointed = re.fullmatch(r"const (\w+) \*", kind)
        if pointed and pointed[1] in structs:
            given = arguments[:i] + [f"&({pointed[1]}){{0}}"] + arguments[i + 1:]
            begin_call(out, given, parameters, growing)
            write_call(out, name, result, given, after, f"{name}, *{parameter} 0", "check_any")
    if mark != "!":
        begin_call(out, arguments, parameters, growing)
        write_call(out, name, result, arguments, after, f"{name}, valid", "check_good")
    out += ["    calls_finish(f);", "}", ""]


def write_other_sizes(out, name, function, call, growing):
    """The test of the structs with structSize that a function takes. Returns whether there are."""
    _, parameters = function
    arguments, after, mark = call
    arguments = [a.lstrip("?") for a in arguments]
    told = [(i, re.fullmatch(r"(const )?(\w+) \*", kind)) for i, (kind, _) in enumerate(parameters)]
    told = [(i, m[2], bool(m[1])) for i, m in told
            if m and m[2] in growing and arguments[i] != "NULL"]
    if not told:
        return False
    out.append(f"static void {name}_takes_other_sizes(void **state)")
    out.append("{")
    out.append("    struct fixture *f = calls_setup(state);")
    for i, kind, read in told:
        given = arguments[:i] + [f"({kind} *)sized.bytes"] + arguments[i + 1:]
        for case in ("PRESENT", "LEAST", "LARGER", "NEWER", "SMALLER", "EMPTY"):
            refused = case in ("SMALLER", "EMPTY") or case == "NEWER" and read
            if case == "NEWER" and not read or mark == "!" and not refused:
                continue
            begin_call(out, arguments, parameters, growing)
            out.append("    {")
            out.append(f"        struct sized sized = sized_make({arguments[i]}, sizeof({kind}),")
            out.append(f"            SLC_FIRST_{kind}, SIZED_{case}, {str(read).lower()});")
            if refused:
                out.append("        static unsigned char before[sizeof f->out];")
                out.append("        memcpy(before, &f->out, sizeof before);")
            out.append(f'        sized_check("{name}, {parameters[i][1]}", &sized,')
            out.append(f"                    {name}({', '.join(given)}));")
            if refused:
                out.append("        assert_memory_equal(before, &f->out, sizeof before);")
            if after and refused:
                out.append(f"        {after};")
            elif after:  # what was written stands in `sized`
                out.append(f"        {after.replace(arguments[i], given[i])};")
            out.append("    }")
    out += ["    calls_finish(f);", "}", ""]
    return True


def main():
    folder, rest = sys.argv[1], sys.argv[2:]
    sources, outputs = rest[:len(rest) // 2], rest[len(rest) // 2:]
    functions, structs, growing = read_headers(folder)
    missing = set(functions)
    for source, output in zip(sources, outputs):
        calls = read_calls(source)
        unknown = set(calls) - missing
        if unknown:
            sys.exit(f"{source}: no such function, or listed twice: {', '.join(sorted(unknown))}")
        missing -= set(calls)
        out = [f"/* Made by generate.py from the headers and {os.path.basename(source)}. */",
               '#include "base/first_release.h"']
        sized = []
        for name, call in calls.items():
            write_function(out, name, functions[name], call, structs, growing)
            if write_other_sizes(out, name, functions[name], call, growing):
                sized.append(name)
        out.append("#define CALLS_TESTS \\")
        out += [f"    cmocka_unit_test({name}_stands_null_and_zero), \\" for name in calls]
        out += [f"    cmocka_unit_test({name}_takes_other_sizes), \\" for name in sized]
        with open(output, "w", encoding="utf-8") as file:
            file.write("\n".join(out) + "\n\n")
    if missing:
        sys.exit(f"tests/null_arguments has no line for: {', '.join(sorted(missing))}")


main()
