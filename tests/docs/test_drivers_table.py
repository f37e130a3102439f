"""scripts/dev/drivers-table.py: the page has the table of the reports, and no broken report gets a row. Prints TAP.

test_drivers_table.py ROOT
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(sys.argv[1])
SCRIPT = ROOT / "scripts/dev/drivers-table.py"


def run(root, *arguments):
    done = subprocess.run([sys.executable, SCRIPT, "--root", root, *arguments], capture_output=True, text=True,
                          check=False)
    return done.returncode == 0, done.stderr


def copied(folder):
    """Returns a checkout with only the page and its reports, and one of these."""
    root = pathlib.Path(folder)
    shutil.copytree(ROOT / "docs/drivers", root / "docs/drivers")
    shutil.copy(ROOT / "docs/drivers.md", root / "docs")
    return root, sorted((root / "docs/drivers").glob("*.txt"))[0]


def the_page_has_the_table_of_the_reports():
    return run(ROOT, "--check")


def a_new_report_gets_a_row():
    with tempfile.TemporaryDirectory() as folder:
        root, report = copied(folder)
        before = (root / "docs/drivers.md").read_text().count("\n")
        shutil.copy(report, report.with_name("zz-new.txt"))
        stale, _ = run(root, "--check")
        made, message = run(root)
        good, _ = run(root, "--check")
        text = (root / "docs/drivers.md").read_text()
        return not stale and made and good and text.count("\n") == before + 1 and "(drivers/zz-new.txt)" in text, message


def refuses(old, new, why):
    with tempfile.TemporaryDirectory() as folder:
        root, report = copied(folder)
        text = report.read_text()
        assert old in text
        report.write_text(text.replace(old, new, 1))
        before = (root / "docs/drivers.md").read_text()
        made, message = run(root)
        return not made and why in message and (root / "docs/drivers.md").read_text() == before, message


def a_report_whose_sum_is_not_that_of_its_checks_is_refused():
    return refuses("\n  pass  ", "\n  fail  ", "the sum says otherwise")


def a_report_of_some_groups_is_refused():
    return refuses("groups                  all", "groups                  fades", "only a part of the groups")


def a_report_that_was_cut_is_refused():
    return refuses("; validation ", "", "no whole report")


def main():
    tests = [the_page_has_the_table_of_the_reports, a_new_report_gets_a_row,
             a_report_whose_sum_is_not_that_of_its_checks_is_refused, a_report_of_some_groups_is_refused,
             a_report_that_was_cut_is_refused]
    failed = False
    print(f"1..{len(tests)}")
    for number, test in enumerate(tests, 1):
        good, message = test()
        failed = failed or not good
        print(f"{'ok' if good else 'not ok'} {number} {test.__name__}")
        if not good:
            print("# " + message.strip().replace("\n", "\n# "))
    return 1 if failed else 0


sys.exit(main())
