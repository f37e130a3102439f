"""What is in the page's file. Prints TAP. test_page_markup.py WRITE_PAGE FOLDER"""

import re
import sys

import page_file

# as page_sweep.h has them
POINTS, DONE = 11, 9
HOSTILE_START = "</script><script>document.title='taken'</script><img src=x"


def memory(i):
    return (1 + 5 * i % 11) * 4194304


def psnr(frame, point):
    return 999 if frame == 1 else 20 + (7 * frame + point) % 30


pages = {kind: page_file.Page(page_file.write(sys.argv[1], kind, sys.argv[2]).read_text(encoding="utf-8"))
         for kind in ("plain", "hostile", "bare", "long")}
plain, hostile, bare, long_page = pages.values()
sweep, series, pictures = (plain.json(f"{part}-data") for part in ("sweep", "series", "picture"))


def long_bins_are_extremes():
    run = next(run for run in long_page.json("series-data")["runs"] if run["point"] == 0)
    column = next(column for column in run["columns"] if column["name"] == "psnr_db")
    bins = [[psnr(frame, 0) for frame in range(first, min(first + 3, 900))] for first in range(0, 900, 3)]
    return run["step"] == 3 and column["least"] == [min(b) for b in bins] and column["most"] == [max(b) for b in bins]


def plain_series():
    run = next(run for run in series["runs"] if run["point"] == 2)
    column = next(column for column in run["columns"] if column["name"] == "psnr_db")
    return run["step"] == 1 and column["most"] == [psnr(frame, 2) for frame in range(60)]


estimates = [point["estimates"] for point in sweep["points"]]
hostile_sweep = hostile.json("sweep-data")

FACTS = {
    "tags_are_balanced": all(page.balanced for page in pages.values()),
    "all_points_are_in_the_json": len(sweep["points"]) == POINTS
        and [i for i in range(POINTS) if sweep["points"][i]["state"] == "done"] == list(range(DONE)),
    "figures_are_exact": all(estimates[i][0][0] == memory(i) for i in range(DONE)),
    "unknown_and_infinite_figures_are_json": estimates[5][3][0] is None and estimates[0][4][0] == "-inf",
    "points_that_are_not_done_have_no_figures": estimates[DONE:] == [None, None]
        and sweep["points"][DONE]["reason"] == "it ended with status 1",
    "recommendations_are_there": [r["point"] for r in sweep["recommendations"]] == [0, 8, -1],
    "figures_over_frames_are_those_of_the_file": plain_series(),
    "many_frames_are_drawn_as_least_and_most": long_bins_are_extremes(),
    "damaged_frames_are_named": [(gone["point"], "line 2" in gone["why"]) for gone in series["left_out"]] == [(8, True)],
    "the_worst_frame_is_the_first_picture": pictures["sets"][0]["point"] == 2
        and pictures["sets"][0]["frame"] == min(range(3), key=lambda frame: psnr(frame, 2)),
    "indices_of_pictures_are_in_the_pool": len(pictures["sets"]) > 3 and all(
        -1 <= entry[kind] < len(pictures["pool"]) for entry in pictures["sets"] for kind in ("streamed", "truth", "flip")),
    "pictures_are_as_large_as_they_say": all((p["width"], p["height"]) == (4, 2) for p in pictures["pool"]),
    "missing_files_are_named": not bare.json("series-data")["runs"] and not bare.json("picture-data")["sets"]
        and len(bare.json("series-data")["left_out"]) == DONE and len(bare.json("picture-data")["left_out"]) > 3,
    "no_page_asks_for_anything_outside": not any(re.search(r"\w:/" + "/|@import|url\\(", page.text) for page in pages.values())
        and not any(a.get("src") or a.get("href", "#")[0] != "#" for page in pages.values() for _, a in page.elements),
    "hostile_words_make_no_elements": hostile.elements == plain.elements and hostile.text.count("<!--") == 0,
    "hostile_words_arrive_whole": all(point["label"].startswith(HOSTILE_START) for point in hostile_sweep["points"])
        and "\n \t \x01 \ufffd \u2028 \u202e =1+1 &lt; @SWEEP@" in hostile_sweep["title"],
    "hostile_columns_are_only_names": any(column["name"] == "</script><b>x" and column["most"] == [1, "inf"]
        for run in hostile.json("series-data")["runs"] for column in run["columns"]),
}
sys.exit(page_file.report(FACTS))
