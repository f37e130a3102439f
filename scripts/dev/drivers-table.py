#!/usr/bin/env python3
"""Makes the table of self-tests in docs/drivers.md from the reports in docs/drivers, or checks it.

    scripts/dev/drivers-table.py [--check] [--root FOLDER]

A report is a file that `sluice-info --self-test --report` wrote, of all groups. The table has a row for each, sorted by
name. A report that was cut or edited is refused: its sum must be that of its checks.

--check  changes nothing; exit status 1 and a message if the table is not that of the reports
--root   the checkout (default: that of this script)
"""

import argparse
import pathlib
import re
import sys

BEGIN = "<!-- Made by: scripts/dev/drivers-table.py -->\n"
END = "<!-- End of the table -->\n"
HEAD = ("| report | device | driver | system | passed | failed | skipped | processor time | validation |\n"
        "|---|---|---|---|---|---|---|---|---|\n")
SUM = re.compile(r"(\d+) passed, (\d+) failed, (\d+) skipped in \d+ s; processor time (\d+) s; validation (\w+)")


class Wrong(Exception):
    pass


def field(lines, name, path):
    found = [line for line in lines if line.startswith(f"  {name} ")]
    if len(found) != 1:
        raise Wrong(f"{path.name}: {len(found)} lines say '{name}'")
    return found[0][2 + len(name):].strip()


def row(path):
    """Returns the row of a report."""
    lines = path.read_text().splitlines()
    last = SUM.fullmatch(lines[-1]) if lines else None
    device = [line for line in lines if re.match(r"device \d+: ", line)]
    if not last or len(device) != 1 or not lines[0].startswith("Self-test of Sluice "):
        raise Wrong(f"{path.name}: no whole report of sluice-info --self-test --report")
    if field(lines, "groups", path) != "all":
        raise Wrong(f"{path.name}: only a part of the groups")
    results = [line.split()[0] for line in lines if re.match(r"  (pass|fail|skip)  ", line)]
    counts = [str(results.count(result)) for result in ("pass", "fail", "skip")]
    if counts != list(last.groups()[:3]):
        raise Wrong(f"{path.name}: {', '.join(counts)} checks passed, failed and were skipped; the sum says otherwise")
    name = device[0].split(": ", 1)[1]
    system = field(lines, "system", path).split(",")
    cells = [f"[{field(lines, 'date', path)}](drivers/{path.name})", name, field(lines, "driver", path),
             system[0].split()[0] + "," + system[1], *counts, f"{last[4]} s", last[5]]
    return "| " + " | ".join(cells) + " |\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2])
    options = parser.parse_args()
    page = options.root / "docs/drivers.md"
    text = page.read_text()
    if text.count(BEGIN) != 1 or text.count(END) != 1:
        raise Wrong(f"{page}: the table needs one '{BEGIN.strip()}' and one '{END.strip()}'")
    before, rest = text.split(BEGIN)
    after = rest.split(END)[1]
    reports = sorted((options.root / "docs/drivers").glob("*.txt"))
    made = before + BEGIN + "\n" + HEAD + "".join(row(path) for path in reports) + "\n" + END + after
    if options.check and made != text:
        raise Wrong("docs/drivers.md: the table is not that of docs/drivers; run scripts/dev/drivers-table.py")
    if not options.check:
        page.write_text(made)


if __name__ == "__main__":
    try:
        main()
    except Wrong as wrong:
        sys.exit(f"drivers-table.py: {wrong}")
