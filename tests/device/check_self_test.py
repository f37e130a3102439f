"""What the output of sluice-info --self-test --json has: a device, its checks, and their sum."""

import json
import sys


def main():
    device, *checks, last = [json.loads(line) for line in sys.stdin.read().splitlines()]
    assert device["deviceName"] and device["driverName"] and device["maxImageExtent"] > 0
    assert len(checks) == last["passed"] + last["failed"] + last["skipped"]
    assert last["failed"] == 0 and last["passed"] >= 3
    for check in checks:
        assert set(check) == {"check", "group", "mode", "result", "seconds", "reason"}, check
        assert check["group"] == "sampler" and check["result"] in ("pass", "skip"), check
        assert check["result"] != "pass" or check["reason"] == ""


main()
