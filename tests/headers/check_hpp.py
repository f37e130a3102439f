#!/usr/bin/env python3
"""check_hpp.py ROOT HEADERS COMPILER...: sluice.hpp owns every handle. Prints TAP.

Handles are found by their functions sluiceDestroy in the headers, not in sluice.hpp. A program is
made that defines those functions itself, so that it sees each call, and is compiled with COMPILER.
HEADERS is one argument: the names of the headers that the program includes beside sluice.hpp, whose
declarations must agree.
"""
import pathlib
import subprocess
import sys
import tempfile

FLAGS = ["-std=c++17", "-fno-exceptions", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"]

PROGRAM = """#include <sluice/sluice.hpp>
#include <utility>

static int destroyed, handles_made;

template <typename Handle> SluiceResult make(int count, Handle **handle)
{
    static int place;
    handles_made += count;
    if (count > 0)
        *handle = reinterpret_cast<Handle *>(&place);
    return count > 0 ? SLUICE_SUCCESS : SLUICE_ERROR_IO;
}

/* The number of the check that fails, or 0. */
template <typename Owner> int check()
{
    using Handle = typename Owner::element_type;
    static_assert(sizeof(Owner) == sizeof(void *), "no larger than the handle");
    static_assert(!std::is_copy_constructible_v<Owner> && !std::is_copy_assignable_v<Owner>, "moves alone");
    static_assert(std::is_nothrow_move_constructible_v<Owner>, "moves without throwing");
    static_assert(std::is_nothrow_destructible_v<Owner>, "dies without throwing");
    destroyed = handles_made = 0;
    {
        auto [failure, none] = sluice::create(make<Handle>, 0);
        if (failure != SLUICE_ERROR_IO || none)
            return 1;
        auto [result, owner] = sluice::create(make<Handle>, 1);
        if (result != SLUICE_SUCCESS || !owner || handles_made != 1)
            return 2;
        Owner other = std::move(owner);
        if (owner || !other || destroyed != 0)
            return 3;
        other = sluice::create(make<Handle>, 1).owner;
        if (destroyed != 1)
            return 4;
    }
    return destroyed == 2 ? 0 : 5;
}

static_assert(sluice::sized<SluiceImageInfo>().structSize == sizeof(SluiceImageInfo), "knows its size");
static const SluiceLogCallback LOG = {
    nullptr, sluice::callback(+[](void *, SluiceLogSeverity, const char *) noexcept { destroyed = 0; })};
"""

THROWING = """#include <sluice/sluice.hpp>
void (*function)(void *) = sluice::callback(+[](void *)%s {});
"""


def handles(root):
    names = subprocess.check_output([sys.executable, root / "scripts/dev/public-symbols.py"], text=True).split()
    return [n.removeprefix("sluiceDestroy") for n in names if n.startswith("sluiceDestroy") and "(" not in n]


def program(owners, headers):
    lines = [f"#include <sluice/{name}.h>" for name in headers] + [PROGRAM, 'extern "C" {']
    lines += [f"void sluiceDestroy{name}(Sluice{name} *) {{ destroyed++; }}" for name in owners]
    lines += ["SluiceResult sluiceEndRecording(SluiceRecorder *) { destroyed++; return SLUICE_SUCCESS; }", "}"]
    lines += ["int main()", "{", "    LOG.pfnLog(nullptr, SLUICE_LOG_INFO, nullptr);", "    int failed;"]
    for name in owners + ["Recorder"]:
        lines += [f"    if ((failed = check<sluice::{name}>()) != 0)", "        return failed;"]
    return "\n".join(lines + ["    return 0;", "}", ""])


def main(root, headers, *compiler):
    root, number, failed = pathlib.Path(root), 0, 0
    compile_it = [*compiler, *FLAGS, "-I", root / "include", "-x", "c++", "-"]
    owners = handles(root)

    def report(fact, good, output=""):
        nonlocal number, failed
        number, failed = number + 1, failed + (not good)
        print(f"{'ok' if good else 'not ok'} {number} - {fact}")
        for line in "" if good else output.splitlines():
            print("#", line)

    def syntax(text):
        return subprocess.run([*compile_it, "-fsyntax-only"], input=text, text=True, stderr=subprocess.PIPE)

    print("1..4")
    report("headers_have_functions_that_destroy", len(owners) >= 17)
    with tempfile.TemporaryDirectory() as folder:
        made = subprocess.run([*compile_it, "-o", f"{folder}/program"], input=program(owners, headers.split()),
                              text=True, stderr=subprocess.PIPE)
        status = made.returncode or subprocess.run([f"{folder}/program"]).returncode
        report("every_handle_has_an_owner_that_moves_and_destroys_it_once", status == 0, f"{status}\n" + made.stderr)
    alone = syntax(THROWING % " noexcept")
    report("the_header_compiles_alone", alone.returncode == 0, alone.stderr)
    report("callbacks_that_may_throw_do_not_compile", syntax(THROWING % "").returncode != 0)
    return failed > 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
