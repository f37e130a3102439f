"""The output of sluice-info --formats --json: keys, and that refusals agree with each other."""

import json
import sys

MODES = ("sparse", "paged", "dense", "demand")
STREAMED = {"yes", "nearest only"}
REFUSALS = {"no such mode", "no sampled image", "no linear filter", "no sparse image", "tile not 64 KiB",
            "blocks above 4x4"}


def main():
    for line in sys.stdin.read().splitlines():
        device = json.loads(line)
        assert set(device) == {"index", "deviceName", "driverName", "driverInfo", "missing", "formats"}
        assert set(device["missing"]) == set(MODES)
        for row in device["formats"]:
            assert set(row) == {"format", "linearFilter", *MODES}, row
            assert all(row[m] in STREAMED | REFUSALS for m in MODES), row
            assert all((row[m] == "yes") <= row["linearFilter"] for m in MODES), row
            assert all((row[m] == "no such mode") == bool(device["missing"][m]) for m in MODES), row
            assert row["demand"] != "yes" or row["paged"] == "yes", row
        print(len(device["formats"]))


main()
