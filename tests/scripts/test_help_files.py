#!/usr/bin/env python3
"""test_help_files.py HELP_FILES [TOOL PAGE COMPLETION]...: manual pages and completions. Prints TAP."""
import os
import re
import shutil
import subprocess
import sys
import tempfile

HELP = """usage: probe [options] FILE

Says .dots and it's `done`.

  -o, --output OUT            where to write,
                              if anywhere
Texels
  --format NAME               of the texels.
                              One of auto, bc7, v1.5, r8. [auto]
  --mode fast|best            work [fast]
  --depth N                   levels [0]
  --help                      this text

Exit status: 0 all is well.
"""


def run(*words, **more):
    return subprocess.run(words, capture_output=True, text=True, check=True, **more).stdout


def complete(file, name, *words):
    """What bash offers for the last word."""
    script = 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); ' \
        f'_{name.replace("-", "_")}; printf "%s\\n" "${{COMPREPLY[@]}}"'
    return run("bash", "-c", script, "bash", file, name, *words).split()


def shown(page):
    return re.sub(r"\s+", " ", re.sub(r"\\f[BRI]|\\&", "", page.replace("\\-", "-").replace("\\e", "\\")))


def facts(script, tools):
    with tempfile.TemporaryDirectory() as folder:
        probe, page, words = (os.path.join(folder, name) for name in ("probe", "probe.1", "words"))
        with open(probe, "w", encoding="utf-8") as file:
            file.write(f"#!/bin/sh\ncat <<'END'\n{HELP}END\n")
        os.chmod(probe, 0o755)
        run(sys.executable, script, "man", probe, page, "probes", "1.2")
        run(sys.executable, script, "bash", probe, words)
        with open(page, encoding="utf-8") as file:
            text = file.read()
        yield ".TP\n\\fB\\-o\\fR, \\fB\\-\\-output\\fR \\fIOUT\\fR\nwhere to write,\nif anywhere\n.SS \"Texels\"" in text, \
            "an_option_has_its_letter_operand_words_and_heading"
        yield "\n.SH EXIT STATUS\n.PP\n0 all is well.\n" in text and '"Sluice 1.2"' in text, "the_exit_status_has_a_section"
        yield complete(words, "probe", "--fo") == ["--format"], "names_of_options_are_completed"
        yield complete(words, "probe", "--format", "") == ["auto", "bc7", "v1.5", "r8"] and \
            complete(words, "probe", "--mode", "b") == ["best"], "words_to_choose_from_are_completed"
        yield complete(words, "probe", "--depth", "") == [], "numbers_are_not_guessed"
        yield complete(words, "probe", "--output", page[:-1]) == [page] == complete(words, "probe", "-o", page[:-1]), \
            "names_of_files_are_completed"
    for tool, page, words in zip(tools[::3], tools[1::3], tools[2::3]):
        names = set(re.findall(r"^  (?:-\w, )?(--[\w-]+)", run(tool, "--help"), flags=re.M))
        name = os.path.basename(tool)
        with open(page, encoding="utf-8") as file:
            text = shown(file.read())
        missing = [n for n in names if n + " " not in text]
        good = len(names) > 3 and not missing and set(complete(words, name, "--")) == names
        if shutil.which("man") and shutil.which("groff"):
            good = good and not subprocess.run(["man", "--warnings", "-l", page], capture_output=True, check=True).stderr
        yield good, f"all_options_of_{name}_are_in_its_page_and_completion"


number = status = 0
for good, fact in facts(sys.argv[1], sys.argv[2:]):
    number += 1
    status |= not good
    print("ok" if good else "not ok", number, "-", fact)
print(f"1..{number}")
sys.exit(status)
