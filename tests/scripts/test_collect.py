"""What scripts/lib/collect.py counts. Prints TAP. test_collect.py COLLECT.PY"""

import importlib.util
import sys

spec = importlib.util.spec_from_file_location("collect", sys.argv[1])
collect = importlib.util.module_from_spec(spec)
spec.loader.exec_module(collect)


def count(text, returncode=0, ended_well=True):
    facts = collect.facts_of(text, returncode, ended_well)
    return [sum(1 for fact in facts if fact[0] == s) for s in ("passed", "failed", "skipped")]


def reasons(text):
    return [fact[2] for fact in collect.facts_of(text, 0, True) if fact[0] == "skipped"]


FACTS = {
    "every_subtest_counts": count("1..2\nok 1 - a\nnot ok 2 - b\n", 1, False) == [1, 1, 0],
    "program_without_tap_counts_once": count("hello\n") == [1, 0, 0],
    "program_that_died_counts_as_failure": count("", -11, False) == [0, 1, 0],
    "exit_status_77_is_a_skip": count("no device\n", 77, True) == [0, 0, 1],
    "missing_subtests_are_a_failure": count("1..3\nok 1 - a\n", 0, True) == [1, 1, 0],
    "death_after_the_last_subtest_is_a_failure": count("1..1\nok 1 - a\n", -6, False) == [1, 1, 0],
    "skip_is_no_failure_even_if_not_ok": count("1..1\nnot ok 1 # SKIP a\n") == [0, 0, 1],
    "skip_with_a_name_has_its_reason": reasons("1..1\nok 1 - a # SKIP no GPU\n") == ["no GPU"],
    "skip_without_a_name_takes_the_line_before": reasons("1..1\n# no GPU\nok 1 # SKIP a\n") == ["no GPU"],
    "empty_plan_is_one_skip": count("1..0 # SKIP no device\n") == [0, 0, 1],
    "lines_of_extremes_are_rows": collect.extremes_of("ok 1 - a\n# extremes: b | 3 | 0.5 at 1 | 1 step\n")
    == [["b", "3", "0.5 at 1", "1 step"]],
    "other_lines_are_no_rows": collect.extremes_of("# b | 3 | 1 | 1\n# extremes: b | 3\nextremes: b | 1 | 2 | 3\n") == [],
    "late_plan_is_read": count("ok 1 - a\nok 2 - b\n1..2\n") == [2, 0, 0],
}

print("1..%d" % len(FACTS))
for number, (fact, holds) in enumerate(FACTS.items(), 1):
    print("%s %d - %s" % ("ok" if holds else "not ok", number, fact))
sys.exit(0 if all(FACTS.values()) else 1)
