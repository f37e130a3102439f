#!/usr/bin/env python3
"""help_files.py man|bash PROGRAM OUT [SUMMARY VERSION]: a manual page or a bash completion of a --help text.

The --help text is printed from a program's table of options, so both follow the table.
"""
import re
import subprocess
import sys

ROW = re.compile(r"^  (?:-(\w), )?--([\w-]+)(?: (\S.*?))?(?:  +(\S.*))?$")
FILES = re.compile(r"FILE|DIR|OUT|PATH|PLAN|CATALOGUE|RESULTS|TRACE|PICTURE")


class Option:
    def __init__(self, row):
        self.letter, self.name, self.operand, words = row.groups()
        self.words = [words] if words else []

    def choices(self):
        """The words that the option takes. Empty: it takes others, or none."""
        operand = self.operand or ""
        listed = re.search(r"One of ([^.]*(?:\.\d[^.]*)*)\.", " ".join(self.words)) if operand == "NAME" else None
        if listed:
            return listed[1].split(", ")
        words = operand.split("|")
        return words if len(words) > 1 and not any(re.search("[A-Z]", word) for word in words) else []


def parse(text):
    """Blocks in order: ("usage", lines), ("text", lines), ("heading", words) and ("option", Option)."""
    lines, blocks, option = text.splitlines(), [], None
    for number, line in enumerate(lines):
        row = ROW.match(line)
        after = lines[number + 1] if number + 1 < len(lines) else ""
        if row:
            option = Option(row)
            blocks.append(("option", option))
        elif option and line.startswith(" " * 30):
            option.words.append(line.strip())
        elif not line.strip():
            option = None
            blocks.append(("text", []))
        elif blocks and blocks[-1][0] == "usage" and line.startswith(" "):
            blocks[-1][1].append(line)
        elif line.startswith("usage: "):
            blocks.append(("usage", [line]))
        elif not line.startswith(" ") and ROW.match(after):
            blocks.append(("heading", line))
        else:
            option = None
            if not blocks or blocks[-1][0] != "text":
                blocks.append(("text", []))
            blocks[-1][1].append(line)
    return [block for block in blocks if block[1] != []]


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("`", "\\`")
    return re.sub(r"^([.'])", r"\\&\1", text)


def paragraph(lines):
    """Lines that are indented are tables or commands: they keep their ends."""
    filled = not any(line.startswith("  ") for line in lines)
    return [".PP", *map(roff, lines)] if filled else [".PP", ".nf", *map(roff, lines), ".fi"]


def manual(name, text, summary, version):
    out = [f'.TH {roff(name.upper())} 1 "" "Sluice {version}" "Sluice"', ".SH NAME", f"{roff(name)} \\- {roff(summary)}"]
    section = None
    for kind, block in parse(text):
        if kind == "usage":
            out += [".SH SYNOPSIS", ".nf", *(roff(line[len("usage: "):]) for line in block), ".fi"]
            section = "SYNOPSIS"
        elif kind == "text":
            wanted = "NOTES" if section in ("OPTIONS", "NOTES", "EXIT STATUS") else "DESCRIPTION"
            if block[0].startswith("Exit status: "):
                wanted, block = "EXIT STATUS", [block[0][len("Exit status: "):], *block[1:]]
            out += [] if wanted == section else [f".SH {wanted}"]
            out += paragraph(block)
            section = wanted
        else:
            out += [] if section == "OPTIONS" else [".SH OPTIONS"]
            section = "OPTIONS"
            if kind == "heading":
                out.append(f'.SS "{roff(block)}"')
                continue
            flags = ", ".join(f"\\fB{roff(flag)}\\fR" for flag in
                              ([f"-{block.letter}"] if block.letter else []) + [f"--{block.name}"])
            out += [".TP", flags + (f" \\fI{roff(block.operand)}\\fR" if block.operand else ""),
                    *map(roff, block.words)]
    return "\n".join(out) + "\n"


def completion(name, text):
    options = [block for kind, block in parse(text) if kind == "option"]
    lines = [f"# bash completion of {name}, made of its --help text", f"_{name.replace('-', '_')}() {{",
             '    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}', '    case $before in']
    for option in options:
        flags = "|".join(([f"-{option.letter}"] if option.letter else []) + [f"--{option.name}"])
        if option.choices():
            lines.append(f"    {flags}) mapfile -t COMPREPLY < <(compgen -W '{' '.join(option.choices())}' -- \"$word\") ;;")
        elif option.operand and FILES.search(option.operand):
            lines.append(f'    {flags}) mapfile -t COMPREPLY < <(compgen -f -- "$word") ;;')
        elif option.operand:
            lines.append(f"    {flags}) COMPREPLY=() ;;")
    names = " ".join(f"--{option.name}" for option in options)
    return "\n".join(lines + [
        "    *)", "        if [[ $word == -* ]]; then",
        f"            mapfile -t COMPREPLY < <(compgen -W '{names}' -- \"$word\")",
        "        else", '            mapfile -t COMPREPLY < <(compgen -f -- "$word")', "        fi", "        ;;",
        "    esac", "}", f"complete -o filenames -F _{name.replace('-', '_')} {name}", ""])


def main(kind, program, out, summary="", version=""):
    text = subprocess.run([program, "--help"], check=True, capture_output=True, text=True).stdout
    name = program.replace("\\", "/").rsplit("/", 1)[-1]
    with open(out, "w", encoding="utf-8") as file:
        file.write(manual(name, text, summary, version) if kind == "man" else completion(name, text))


if __name__ == "__main__":
    if len(sys.argv) < 4 or sys.argv[1] not in ("man", "bash"):
        sys.exit(__doc__)
    main(*sys.argv[1:])
