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
    """Functions by name as (result, [(type, name)]), and the structs that are defined."""
    functions, structs = {}, set()
    for name in sorted(os.listdir(folder)):
        if not name.endswith(".h"):
            continue
        with open(os.path.join(folder, name), encoding="utf-8") as file:
            text = strip_comments(file.read())
        structs |= set(re.findall(r"\btypedef struct (\w+) \{", text))
        declarations = re.findall(r"\bSLUICE_API\s+([^;{}]*?)\b(sluice\w+)\s*\(([^;]*)\)\s*;", text)
        if len(declarations) != len(re.findall(r"^(?!#).*\bSLUICE_API\b", text, flags=re.M)):
            sys.exit(f"{name}: a declaration is not understood")
        for result, function, parameters in declarations:
            functions[function] = (" ".join(result.split()),
                                   [parse_parameter(p) for p in split_commas(parameters)])
    return functions, structs


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


def write_call(out, function, result, arguments, after, what, expected):
    call = f"{function}({', '.join(arguments)})"
    out.append("    calls_begin(f);")
    if result == "SluiceResult":
        out.append(f'    {expected}("{what}", {call});')
    else:
        out.append(f"    (void){call};")
    if after:
        out.append(f"    {after};")


def write_function(out, name, function, call, structs):
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
        write_call(out, name, result, given, after, f"{name}, {parameter} 0",
                   "check_null" if null else "check_any")
    if len(parameters) > 1:
        write_call(out, name, result, zeros, after, f"{name}, all 0",
                   "check_error" if required and mark != "~" else "check_any")
    for i, (kind, parameter) in enumerate(parameters):
        pointed = re.fullmatch(r"const (\w+) \*", kind)
        if pointed and pointed[1] in structs:
            given = arguments[:i] + [f"&({pointed[1]}){{0}}"] + arguments[i + 1:]
            write_call(out, name, result, given, after, f"{name}, *{parameter} 0", "check_any")
    if mark != "!":
        write_call(out, name, result, arguments, after, f"{name}, valid", "check_good")
    out += ["    calls_finish(f);", "}", ""]


def main():
    folder, rest = sys.argv[1], sys.argv[2:]
    sources, outputs = rest[:len(rest) // 2], rest[len(rest) // 2:]
    functions, structs = read_headers(folder)
    missing = set(functions)
    for source, output in zip(sources, outputs):
        calls = read_calls(source)
        unknown = set(calls) - missing
        if unknown:
            sys.exit(f"{source}: no such function, or listed twice: {', '.join(sorted(unknown))}")
        missing -= set(calls)
        out = [f"/* Made by generate.py from the headers and {os.path.basename(source)}. */"]
        for name, call in calls.items():
            write_function(out, name, functions[name], call, structs)
        out.append("#define CALLS_TESTS \\")
        out += [f"    cmocka_unit_test({name}_stands_null_and_zero), \\" for name in calls]
        with open(output, "w", encoding="utf-8") as file:
            file.write("\n".join(out) + "\n\n")
    if missing:
        sys.exit(f"tests/null_arguments has no line for: {', '.join(sorted(missing))}")


main()
