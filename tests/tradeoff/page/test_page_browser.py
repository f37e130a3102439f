"""What a browser makes of the page. Prints TAP; skipped where there is no Chromium.

Usage: test_page_browser.py WRITE_PAGE FOLDER
"""

import re
import shutil
import subprocess
import sys
import tempfile

import page_file

POINTS, DONE, BASE, UNKNOWN = 11, 9, 2, 5

chromium = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
if not chromium:
    print("1..0 # SKIP there is no Chromium")
    sys.exit(0)


# What a reader does, one page each; each leaves the page as it is then.
ACTIONS = {
    "click": "document.querySelector('#front [data-point=\"4\"]').dispatchEvent(new Event('click'));",
    "keys": "for (const key of ['ArrowRight', 'ArrowRight', 'Enter'])"
            " document.querySelector('#front svg').dispatchEvent(new KeyboardEvent('keydown', {key}));",
    "sort": "for (let i = 0; i < 2; i++) document.querySelectorAll('#table thead button')[2].click();",
    "filter": "const box = document.getElementById('table-filter'); box.value = 'SLOW';"
              "box.dispatchEvent(new Event('input'));",
    "axes": "const x = document.getElementById('front-x'); x.value = '4'; x.dispatchEvent(new Event('change'));",
    "csv": "document.getElementById('says').textContent = csvText();",
}


def drawn(kind, action=""):
    """The page's elements after its scripts ran; None where the browser itself does not start."""
    path = page_file.write(sys.argv[1], kind, sys.argv[2]).resolve()
    if action:
        script = f"<script>{ACTIONS[action]}</script></body>"
        text = path.read_text(encoding="utf-8").replace("</body>", script)
        path = path.with_name(f"{action}.html")
        path.write_text(text, encoding="utf-8")
    with tempfile.TemporaryDirectory() as profile:
        run = subprocess.run(
            [chromium, "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--disable-sync",
             "--disable-dev-shm-usage", f"--user-data-dir={profile}", "--dump-dom", path.as_uri()],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=120, check=False)
    text = run.stdout.decode(errors="replace")
    return page_file.Page(text) if "<body" in text else None


pages = {kind: drawn(kind) for kind in ("plain", "hostile", "bare", "long", "failed", "single")}
if not all(pages.values()):
    print("1..0 # SKIP Chromium does not start here")
    sys.exit(0)
plain, hostile, bare, *_ = pages.values()


def ready(page):
    trouble = next(attributes for _, attributes in page.elements if attributes.get("id") == "trouble")
    if page.texts.get("trouble"):
        print("#", page.texts["trouble"].strip().replace("\n", "; "))
    return page.tags("html")[0].get("data-ready") == "yes" and "hidden" in trouble


def marks(page, word=None):
    """Points of the marks in all fronts, one list per front; the large one comes first."""
    found = []
    for tag, attributes in page.elements:
        if tag == "svg" and "against" in (attributes.get("aria-label") or ""):
            found.append([])
        words = (attributes.get("class") or "").split()
        if found and "data-point" in attributes and (word is None or word in words):
            found[-1].append(int(attributes["data-point"]))
    return found


def memory(i):
    return 1 + 5 * i % 11


def flip(i):
    return 1 + 7 * i % 11


def best():
    """By the definition: no other run is as good in both and better in one."""
    return {i for i in range(DONE) if not any(memory(k) <= memory(i) and flip(k) <= flip(i) and k != i for k in range(DONE))}


def options_of(page):
    """The options that the panel of the chosen run shows."""
    return page.texts["chosen"]


def rows_of(page):
    """Numbers of the points in the table, from its top."""
    table = re.search(r'<table id="table">.*?</table>', page.text, re.DOTALL)[0]
    return [int(number) - 1 for number in re.findall(r"<tr[^>]*><td>(\d+)</td>", table)]


after = {action: drawn("plain", action) for action in ACTIONS}
by_memory = sorted(range(DONE), key=memory)
beside_chosen = by_memory[by_memory.index(8) + 1]  # the balanced one, 8, is chosen when the page opens
csv_lines = after["csv"].texts["says"].strip().split("\n")
rows = plain.texts["table"]
labels = "\n".join(a.get("aria-label") or "" for a in plain.tags("svg"))
FACTS = {f"{kind}_page_runs_without_errors": ready(page) for kind, page in pages.items()}
FACTS.update({
    "the_front_shows_every_run": sorted(marks(plain)[0]) == list(range(DONE)),
    "stairs_go_through_what_nothing_beats": set(marks(plain, "best")[0]) == best(),
    "runs_without_a_figure_are_left_out_of_its_front": any(sorted(front) == [i for i in range(DONE) if i != UNKNOWN] for front in marks(plain)),
    # three figures for each of two settings that are numbers, and three columns over the frames
    "plots_have_lines": len([a for a in plain.of_class("line") if (a.get("d") or "").startswith("M")]) == 3 * 2 + 3,
    "zero_that_means_no_cap_comes_last": re.search(
        f"for budget: 8: {4 * memory(5)}\u00a0MiB.*, 16: {4 * memory(6)}\u00a0MiB.*, 0: {4 * memory(BASE)}\u00a0MiB", labels) is not None,
    "no_coordinate_is_lost": not any("NaN" in (value or "") or "Infinity" in (value or "")
        for page in pages.values() for tag, a in page.elements if tag in ("path", "line", "circle", "rect", "text", "g", "svg") for value in a.values()),
    "table_has_all_points": all(text in rows for text in ("budget 16", "it ended with status 1", "not run yet", "\u221e\u00a0dB")),
    "failures_have_their_reasons": "budget 4: it ended with status 1" in plain.texts["failed"],
    "rule_that_no_run_keeps_is_said": "No run keeps to this rule" in plain.texts["cards"],
    "pictures_are_shown": len([a for a in plain.tags("img") if a["src"].startswith("data:image/png;base64,")]) >= 4,
    "missing_pictures_and_frames_are_said": "no pictures on this page" in bare.texts["picture-body"]
        and "No run has figures over its frames" in bare.texts["series-plots"],
    # point 0 has 4 MiB where the base has 44, and 2 ms less than the base's 4, give or take 3
    "differences_are_those_of_repeats": "4\u00a0MiB\u2009\u00b1\u20090.08\u221291\u00a0%" in plain.texts["cards-table"]
        and "2\u00a0ms\u2009\u00b1\u20090.04\u2248 same" in plain.texts["cards-table"],
    "click_chooses_a_run": "--probability 1/256" in options_of(after["click"]) and "--mode slow" not in options_of(after["click"]),
    "keys_choose_a_run": beside_chosen == 6 and "--budget 16" in options_of(after["keys"]) and "--mode" not in options_of(after["keys"]),
    "table_is_sorted_and_unknown_comes_last": rows_of(after["sort"]) == sorted(range(DONE), key=memory, reverse=True) + [9, 10],
    "filter_leaves_what_contains_the_word": rows_of(after["filter"]) == [7, 8, 10],
    "a_sweep_without_runs_says_so": "nothing to compare with" in pages["failed"].texts["cards-table"] and not marks(pages["failed"]),
    "the_base_alone_is_a_sweep": marks(pages["single"])[0] == [0],
    "without_a_better_there_is_no_front": not marks(after["axes"], "best")[0] and "there is no front" in after["axes"].texts["front-text"],
    "csv_has_a_line_per_point": len(csv_lines) == 1 + POINTS and csv_lines[1 + UNKNOWN].startswith("6,done,1/16,8,fast,"),
    "pages_that_were_used_have_no_errors": all(ready(page) for page in after.values()),
    "every_control_has_a_label": not any(page.unnamed for page in pages.values()),
    "letters_that_turn_words_around_are_written_out": "\\u202e =1+1" in hostile.texts["title"] and "\u202e" not in "".join(
        text for identity, text in hostile.texts.items() if not identity.endswith("-data")),
    "hostile_words_run_nothing": hostile.title != "taken" and not any("onerror" in a for _, a in hostile.elements)
        and not any(a.get("src") == "x" for a in hostile.tags("img")),
})
sys.exit(page_file.report(FACTS))
