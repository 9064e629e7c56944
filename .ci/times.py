#!/usr/bin/env python3
"""Processor time of the build and of every test, from nothing, in build/times; writes the table of docs/developer/performance.md.

  .ci/times.py             builds, runs the tests, writes the table
  .ci/times.py --launch LOG COMMAND...   runs one command and adds its processor time to LOG (the build calls this)

Processor time is that of the operating system for each finished process and its children. It varies less than wall
time on a busy machine, and yet by some 20 %: compare figures of one machine, taken on a quiet one.
Exit status 1 where a test took more than 3 s of processor time and tests/slow_tests.txt does not name it.
"""
import collections
import datetime
import os
import re
import shutil
import subprocess
import sys
import time
import xml.etree.ElementTree as xml

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
BUILD = os.path.join(ROOT, "build", "times")
LIMIT_S = 3.0
ROOMS = "core fit wire record fixture cmm plans evaluation reports web app".split()


def launch(log, command):
    child = os.fork()
    if child == 0:
        os.execvp(command[0], command)
    _, status, used = os.wait4(child, 0)
    what = next((a for a in command if a.startswith("--gtest_filter=")), "")
    if not what and "-o" in command:
        what = command[command.index("-o") + 1]
    with open(log, "a") as out:
        out.write(f"{used.ru_utime + used.ru_stime:.2f}\t{used.ru_maxrss // 1024}\t{what}\n")
    return os.waitstatus_to_exitcode(status)


def run(*command):
    """Runs a command; its processor and wall seconds."""
    before, start = os.times(), time.monotonic()
    subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    after = os.times()
    used = after.children_user + after.children_system - before.children_user - before.children_system
    return used, time.monotonic() - start


def rows(log):
    with open(log) as lines:
        for line in lines:
            seconds, megabytes, what = line.rstrip("\n").split("\t")
            yield float(seconds), int(megabytes), what


def room_of(unit):
    parts = unit.split("/")
    if parts[0] in ("tests", "benchmarks"):
        return "tests of " + parts[1] if parts[0] == "tests" and "." not in parts[1] and parts[1] != "CMakeFiles" else "shared by tests"
    return parts[0] if parts[0] in ROOMS else "precompiled headers"


def short(unit):
    return re.sub(r"CMakeFiles/[^/]*\.dir/|_cxx\.cxx\.o$|\.cpp\.o$", "", unit)


def measure():
    shutil.rmtree(BUILD, ignore_errors=True)
    units, tests = os.path.join(BUILD, "units.tsv"), os.path.join(BUILD, "tests.tsv")
    launcher = f"{os.path.abspath(__file__)};--launch;"
    run("cmake", "--preset", "release", "-B", BUILD, "-DBUILD_TESTING=ON", f"-DCMAKE_CXX_COMPILER_LAUNCHER={launcher}{units}",
        f"-DCMAKE_CROSSCOMPILING_EMULATOR={launcher}{tests}")
    product = run("cmake", "--build", BUILD, "--target", "rondure")
    of_tests = run("cmake", "--build", BUILD, "--target", "all")
    os.remove(tests)  # the lists of tests that the build asked for
    junit = os.path.join(BUILD, "tests.xml")
    ran = run("ctest", "--test-dir", BUILD, "-j2", "--output-junit", junit)

    used = {what[len("--gtest_filter="):]: seconds for seconds, _, what in rows(tests) if what.startswith("--gtest_filter=")}
    cases = []
    for case in xml.parse(junit).getroot().iter("testcase"):
        name = case.get("name")
        cases.append((used.get(name.split(".", 1)[1], float(case.get("time"))), name))
    cases.sort(reverse=True)
    return product, of_tests, ran, sorted(rows(units), reverse=True), cases


def table(product, of_tests, ran, units, cases):
    by_room, tests_by_room = collections.Counter(), collections.Counter()
    for seconds, _, unit in units:
        by_room[room_of(unit)] += seconds
    for seconds, name in cases:
        tests_by_room[name.split(".")[0]] += seconds
    model = next((l.split(":")[1].strip() for l in open("/proc/cpuinfo") if l.startswith("model name")), "unknown")
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True).stdout.strip()
    out = [f"{model}, {os.cpu_count()} cores; commit {commit}; {datetime.date.today()}; `.ci/times.py`.", "",
           "from nothing, release | processor s | wall s", "---|--:|--:"]
    for what, (used, wall) in (("build of the program", product), ("build of the tests", of_tests),
                               (f"{len(cases)} tests", ran)):
        out.append(f"{what} | {used:.0f} | {wall:.0f}")
    out += ["", "room | compile, s | compile its tests, s | run its tests, s", "---|--:|--:|--:"]
    rooms = ROOMS + sorted(set(tests_by_room) - set(ROOMS))
    for room in rooms:
        out.append(f"{room} | {by_room[room]:.1f} | {by_room['tests of ' + room]:.1f} | {tests_by_room[room]:.1f}")
    out.append(f"precompiled headers; shared by tests | {by_room['precompiled headers']:.1f} | {by_room['shared by tests']:.1f} |")
    out += ["", "heaviest units | s | MB", "---|--:|--:"]
    out += [f"`{short(unit)}` | {seconds:.1f} | {megabytes}" for seconds, megabytes, unit in units[:5]]
    return "\n".join(out) + "\n"


def main():
    if sys.argv[1:2] == ["--launch"]:
        return launch(sys.argv[2], sys.argv[3:])
    with open(os.path.join(ROOT, "tests", "slow_tests.txt")) as lines:
        known = {line.split("\t")[0] for line in lines}
    measured = measure()
    page = os.path.join(ROOT, "docs", "developer", "performance.md")
    text = open(page).read()
    begin, end = "<!-- build: begin -->\n", "<!-- build: end -->"
    head, tail = text.split(begin)[0], text.split(end)[1]
    with open(page, "w") as out:
        out.write(head + begin + table(*measured) + end + tail)
    slow = [name for seconds, name in measured[-1] if seconds > LIMIT_S and name not in known]
    for name in slow:
        print(f"{name} takes more than {LIMIT_S:.0f} s of processor time and is not in tests/slow_tests.txt", file=sys.stderr)
    return 1 if slow else 0


if __name__ == "__main__":
    sys.exit(main())
