"""Turns test output into one line per fact: status, build, test, fact, reason (tab-separated).

    collect.py meson BUILD FOLDER        what `meson test` left in FOLDER/meson-logs/*.json
    collect.py tap BUILD TEST FILE RC    the TAP output of one program and its exit status
    collect.py extremes FOLDER           the same logs' "# extremes:" lines, as a table
    collect.py summary FILE              prints failures, skips with reasons, and the totals

Programs that print TAP count once per subtest, all others once.
"""

import json
import pathlib
import re
import sys

LINE = re.compile(r"^(not )?ok\b\s*(\d+)?\s*(?:- )?([^#]*)(?:#\s*(.*))?$", re.IGNORECASE)
PLAN = re.compile(r"^1\.\.(\d+)\s*(?:#\s*skip\S*\s*(.*))?$", re.IGNORECASE)


def parse_tap(text):
    """Returns (facts, planned): facts are (status, name, reason), planned is None without a plan."""
    facts, planned, note = [], None, ""
    for line in text.splitlines():
        plan = PLAN.match(line)
        result = LINE.match(line)
        if plan:
            planned = int(plan.group(1))
            if planned == 0:
                facts.append(("skipped", "all of it", plan.group(2) or "no reason given"))
        elif result:
            refused, number, name, directive = result.groups()
            directive = directive or ""
            if directive.lower().startswith("skip"):
                rest = directive[4:].strip()
                status, name, reason = "skipped", name.strip() or rest, rest if name.strip() else note
            else:
                status, name, reason = ("failed" if refused else "passed"), name.strip(), ""
            if status == "skipped":
                reason = reason or "no reason given"
            facts.append((status, name or "test %s" % number, reason))
            note = ""
        elif line.strip():
            note = line.lstrip("# ").strip()
    return facts, planned


def facts_of(text, returncode, ended_well):
    facts, planned = parse_tap(text)
    if planned is None and not facts:
        status = "skipped" if returncode == 77 else "passed" if ended_well else "failed"
        lines = text.strip().splitlines()
        return [(status, "exit status %s" % returncode, lines[-1] if lines else "")]
    counted = len([fact for fact in facts if fact[1] != "all of it"])
    if planned and counted < planned:
        facts.append(("failed", "ended after %d of %d" % (counted, planned), "exit status %s" % returncode))
    elif not ended_well and not any(fact[0] == "failed" for fact in facts):
        facts.append(("failed", "exit status %s" % returncode, ""))
    return facts


def emit(build, test, facts):
    for status, name, reason in facts:
        row = [status, build, test, name, "" if status == "passed" else reason]
        print("\t".join(" ".join(str(field).split()) for field in row))


def runs_of(folder):
    logs = [p for p in pathlib.Path(folder, "meson-logs").glob("testlog*.json") if "junit" not in p.name]
    for log in sorted(logs):
        for line in log.read_text(encoding="utf-8", errors="replace").splitlines():
            yield json.loads(line)


def collect_meson(build, folder):
    for run in runs_of(folder):
        good = run["result"] in ("OK", "SKIP", "EXPECTEDFAIL")
        facts = facts_of(run.get("stdout", ""), run["returncode"], good)
        said = [line for line in run.get("stderr", "").splitlines() if line.strip()]
        facts = [(status, name, reason or (said[-1].strip()[:200] if said and status == "failed" else ""))
                 for status, name, reason in facts]
        emit(build, run["name"], facts)
        if any(fact[0] == "failed" for fact in facts):
            print("---- %s: %s (%s)" % (build, run["name"], run["result"]), file=sys.stderr)
            for stream in ("stdout", "stderr"):
                print(run.get(stream, "")[-8000:].rstrip(), file=sys.stderr)


def extremes_of(text):
    """[name, cases, worst, bound] of each line "# extremes: name | cases | worst | bound"."""
    lines = (line for line in text.splitlines() if line.startswith("# extremes:"))
    rows = [[field.strip() for field in line[len("# extremes:"):].split("|")] for line in lines]
    return [row for row in rows if len(row) == 4]


def print_extremes(folder):
    rows = sorted(row for run in runs_of(folder) for row in extremes_of(run.get("stdout", "")))
    rows = [["name", "cases", "worst", "bound"]] + rows if rows else []
    width = [max([len(row[i]) for row in rows], default=0) for i in (0, 1, 3)]
    for name, cases, worst, bound in rows:
        print("  %-*s %*s  %-*s %s" % (width[0], name, width[1], cases, width[2], bound, worst))


def summary(path):
    rows = [line.rstrip("\n").split("\t") for line in open(path, encoding="utf-8")]
    count = {"passed": 0, "failed": 0, "skipped": 0}
    per_build, reasons = {}, {}
    for status, build, test, name, reason in rows:
        count[status] += 1
        per_build.setdefault(build, dict.fromkeys(count, 0))[status] += 1
        if status == "skipped":
            reasons.setdefault((reason, test, name), []).append(build)
    for build, counts in per_build.items():
        print("  %-24s %5d passed %3d failed %3d skipped" % ((build,) + tuple(counts.values())))
    for (reason, test, name), builds in reasons.items():
        print("  skipped: %s: %s (%s) [%s]" % (test, name, reason, ", ".join(builds)))
    for status, build, test, name, reason in rows:
        if status == "failed":
            print("  FAILED: %s: %s: %s%s" % (build, test, name, " (%s)" % reason if reason else ""))
    print("%(passed)d passed, %(failed)d failed, %(skipped)d skipped" % count)
    return 1 if count["failed"] or not count["passed"] else 0


def main(arguments):
    if len(arguments) == 3 and arguments[0] == "meson":
        collect_meson(arguments[1], arguments[2])
    elif len(arguments) == 2 and arguments[0] == "extremes":
        print_extremes(arguments[1])
    elif len(arguments) == 5 and arguments[0] == "tap":
        text = pathlib.Path(arguments[3]).read_text(encoding="utf-8", errors="replace")
        code = int(arguments[4])
        emit(arguments[1], arguments[2], facts_of(text, code, code in (0, 77)))
    elif len(arguments) == 2 and arguments[0] == "summary":
        return summary(arguments[1])
    else:
        sys.exit(__doc__)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
