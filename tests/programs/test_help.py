"""test_help.py PROGRAM...: what the --help texts of all programs have in common, in TAP.

A program is a path; "path:word" is a subcommand of it."""
import re
import subprocess
import sys

# Options whose default belongs to what a program draws or measures, and those of one program.
OWN_DEFAULT = {
    "output": "each program writes something else",
    "size": "pictures of scenes",
    "frames": "length of a walk",
    "samples": "pictures of scenes",
    "anisotropy": "pictures of scenes",
    "texture-size": "textures of scenes",
    "residency": "benches measure all modes",
    "only": "benches measure all or one",
    "bits-per-texel": "benches measure all or one",
}
# A trace holds what all pixels of all textures asked for; playing it leaves nothing out by itself.
OWN_IN = {("sluice-tradeoff play", "probability"), ("sluice-tradeoff play", "textures-per-frame"),
          ("devices_figures", "devices"), ("devices_figures", "textures"), ("devices_figures", "store"),
          ("sluice-info", "device"), ("demand-pbrt", "cache"),
          ("sluice-view", "fade"), ("sluice-view", "camera"), ("sluice-view", "frames")}  # people watch
# Shapes of a scene fill a file; decisions of a replay are printed.
OWN_KIND = {"dump"}

number = 0
failed = False


def fact(name, complaints):
    global number, failed
    number += 1
    print(f"{'not ok' if complaints else 'ok'} {number} - {name}")
    for complaint in complaints:
        print(f"# {complaint}")
    failed = failed or bool(complaints)


class Program:
    def __init__(self, word):
        path, _, command = word.partition(":")
        self.command = [path] + ([command] if command else [])
        self.name = " ".join([path.rsplit("/", 1)[-1]] + self.command[1:])
        self.help = self.run("--help")
        self.options = []  # (name, operand or None, rest of the entry)
        for line in self.help.stdout.splitlines():
            row = re.match(r"  (?:-\w, )?--([a-z-]+)(?: ((?:\S| (?! ))+))?(?:  +(.*))?$", line)
            if row:
                self.options.append([row[1], row[2], row[3] or ""])
            elif self.options and re.match(r" {30}\S", line):
                self.options[-1][2] += " " + line.strip()

    def run(self, *arguments):
        return subprocess.run(self.command + list(arguments), capture_output=True, text=True, timeout=60)

    def default(self, words):
        found = re.search(r"(\[[^][]*\]|\([^()]*\))$", words)
        return found[1] if found else None


programs = [Program(word) for word in sys.argv[1:]]

fact("help_begins_with_usage_and_ends_well",
     [p.name for p in programs if p.help.returncode or not p.help.stdout.startswith("usage: ") or p.help.stderr])

fact("each_option_is_listed_once",
     [f"{p.name} --{name}" for p in programs for name in {row[0] for row in p.options}
      if sum(row[0] == name for row in p.options) != 1] +
     [p.name for p in programs if "help" not in [row[0] for row in p.options]])

fact("each_option_with_a_value_shows_its_default",
     [f"{p.name} --{name}" for p in programs for name, operand, words in p.options
      if operand and not p.default(words)])

fact("help_fits_into_96_columns",
     [f"{p.name}: {line}" for p in programs for line in p.help.stdout.splitlines() if len(line) > 96])

seen, kinds, other = {}, {}, []
for p in programs:
    for name, operand, words in p.options:
        if name == "help":
            continue
        first = kinds.setdefault(name, (p.name, bool(operand)))
        if first[1] != bool(operand) and name not in OWN_KIND:
            other.append(f"--{name} takes a value in one of {first[0]} and {p.name}")
        if not operand or name in OWN_DEFAULT or (p.name, name) in OWN_IN:
            continue
        first = seen.setdefault(name, (p.name, p.default(words)))
        if first[1] != p.default(words):
            other.append(f"--{name}: {first[1]} in {first[0]}, {p.default(words)} in {p.name}")
fact("an_option_of_several_programs_has_one_default", other)

wrong = []
for p in programs:
    names = [row[0] for row in p.options if len(row[0]) > 3 and row[0] != "help"]
    for name in {names[0], names[len(names) // 2], names[-1]} if names else ():
        typed = name[:1] + name[2:]
        answer = p.run(f"--{typed}")
        if answer.returncode != 2 or f"did you mean --{name}?" not in answer.stderr or answer.stdout:
            wrong.append(f"{p.name} --{typed}: {answer.returncode} {answer.stderr.strip()}")
fact("an_unknown_option_is_refused_and_the_nearest_one_named", wrong)

print(f"1..{number}")
sys.exit(failed)
