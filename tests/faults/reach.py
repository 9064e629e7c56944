#!/usr/bin/env python3
"""Says by their numbers, as `ctest -I` takes them, which tests to run: see README.md.

reach.py TESTS REACH REGEX           on one line those that have not passed yet
reach.py TESTS REACH REGEX 17 ROOM   those that reach fault 17: on a line each the quick ones of its room, the quick
                                     ones of other rooms, and the slow ones

TESTS: what `ctest --show-only=json-v1` prints. REACH: a folder with the results of the tests that have run (JUnit), and
an empty file for each fault that a test reached: its number and the first 240 letters of the test, `|` for `/`. REGEX: of names.
"""
import json
import pathlib
import re
import sys
import xml.etree.ElementTree


def main():
    reach, fault = pathlib.Path(sys.argv[2]), "".join(sys.argv[4:5])
    tests = {test["name"]: {p["name"]: p["value"] for p in test["properties"]}
             for test in json.loads(pathlib.Path(sys.argv[1]).read_text())["tests"]}

    def line(wanted):
        numbers = [str(number) for number, name in enumerate(tests, 1)
                   if wanted(name) and re.search(sys.argv[3], name)]
        if numbers:
            print(",".join(["0,0,0", *numbers]))

    seconds = {case.get("name"): float(case.get("time")) for file in reach.glob("*.xml")
               for case in xml.etree.ElementTree.parse(file).iter("testcase") if case.get("status") != "fail"}
    if not fault:
        line(lambda name: name not in seconds)
        return
    reaching = {name for name in tests if (reach / f"{fault} {name[:240].replace('/', '|')}").exists()}
    # Who reads what another test made reaches what that one reaches.
    made = {fixture for name in reaching for fixture in tests[name].get("FIXTURES_SETUP", [])}
    reaching |= {name for name in tests if made & set(tests[name].get("FIXTURES_REQUIRED", []))}
    quick = {name for name in reaching if seconds[name] < 1 and "FIXTURES_REQUIRED" not in tests[name]}
    own = f"{sys.argv[5]}."
    line(lambda name: name in quick and name.startswith(own))
    line(lambda name: name in quick and not name.startswith(own))
    line(lambda name: name in reaching - quick)


if __name__ == "__main__":
    main()
