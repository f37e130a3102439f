#!/usr/bin/env python3
"""test_info_url.py SLUICE_INFO SERVER FILE...: sluice-info says of a URL what it says of the file. Prints TAP."""
import json
import subprocess
import sys
import urllib.parse


def info(program, name):
    answer = subprocess.run([program, "--json", name], capture_output=True, text=True, timeout=60)
    facts = json.loads(answer.stdout) if answer.returncode == 0 else {}
    facts.pop("file", None)
    return answer.returncode, facts, answer.stderr


def main(program, script, files):
    server = subprocess.Popen([sys.executable, script], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    web = "http://127.0.0.1:" + server.stdout.readline().split()[0]
    print(f"1..{len(files) + 1}")
    for number, name in enumerate(files, 1):
        code, local, _ = info(program, name)
        remote_code, remote, said = info(program, f"{web}/file/x?path={urllib.parse.quote(name)}")
        good = code == remote_code == 0 and local == remote and local["fileSize"] > 0
        print("ok" if good else "not ok", number, "-", name.rsplit("/", 1)[-1], "is_the_same_over_the_network")
        if not good:
            print("#", remote_code, local, remote, said.strip())
    code, _, said = info(program, web + "/status-404/x?token=secret")
    good = code == 1 and "answers 404" in said and "secret" not in said
    print("ok" if good else "not ok", len(files) + 1, "- a_missing_file_is_said_to_be_missing")
    server.stdin.close()
    server.wait()


main(sys.argv[1], sys.argv[2], sys.argv[3:])
