#!/usr/bin/env python3
"""Judges a run of rondure_benchmarks against the gates and writes docs/performance.md.

    gates.py RUN.json [--doc docs/performance.md] [--command TEXT] [--allow-noise] [--partial]

Exit status: 0 every gate met; 1 a gate broken, or not measured (but with --partial); 2 the file
cannot be read; 3 the machine was too noisy to judge times (0 with --allow-noise).
Times are CPU times, medians of the repetitions; a gate on several sizes is judged by the worst.
"""

import argparse
import json
import math
import pathlib
import platform
import re
import subprocess
import sys
from collections import namedtuple
from statistics import median

LARGE = 1_000_000
NS = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}
BEGIN, END = "<!-- measured: begin -->", "<!-- measured: end -->"
LARGEST_VARIATION = 0.05  # of S1, between repetitions
LARGEST_LOAD = 1.0

# One demand of a gate. value None: not measured. at_least: the value must not be below accept.
Part = namedtuple("Part", "value accept stretch at_least", defaults=(False,))
# timed: depends on a quiet machine.
Gate = namedtuple("Gate", "id goal parts timed")


class Runs:
    """The rows of a JSON file by name and statistic."""

    def __init__(self, report):
        self.context = report["context"]
        self.rows = {}
        for row in report["benchmarks"]:
            name = re.sub(r"/(iterations|repeats):\d+", "", row["run_name"])
            kind = row.get("aggregate_name", "once")
            self.rows.setdefault(name, {})[kind] = row

    def names(self, pattern):
        return [name for name in self.rows if re.fullmatch(pattern, name)]

    def time_ns(self, name):
        rows = self.rows.get(name, {})
        row = rows.get("median") or rows.get("once")
        return row["cpu_time"] * NS[row["time_unit"]] if row else None

    def worst(self, name, counter):
        """The largest value of a counter over the repetitions; None without it."""
        rows = self.rows.get(name, {})
        row = rows.get("max") or rows.get("median") or rows.get("once") or {}
        return row.get(counter)

    def ratio(self, name, other):
        a, b = self.time_ns(name), self.time_ns(other)
        return a / b if a and b else None

    def ratios_over_seeds(self, what, other):
        """time(what) / time(other) of each seed at the large size."""
        found = []
        for name in self.names(re.escape(f"{what}/n:{LARGE}") + r"/seed:\d+"):
            seed = name.rsplit("/", 1)[1]
            found.append(self.ratio(name, f"{other}/n:{LARGE}/{seed}"))
        return [value for value in found if value is not None]

    def worst_ratio(self, what, peer, smallest=0, largest=LARGE):
        """The largest time(what) / time(peer) over the sizes both were measured at."""
        found = []
        for name in self.names(re.escape(f"{peer}/scan/n:") + r"\d+(/seed:\d+)?"):
            tail = name[len(peer):]
            points = int(re.search(r"/n:(\d+)", name).group(1))
            if smallest <= points <= largest:
                found.append(self.ratio(what + tail, name))
        return max((value for value in found if value is not None), default=None)

    def total(self, pattern, counter):
        """Sum of a counter over the benchmarks of a pattern; None when there are none."""
        found = [self.worst(name, counter) for name in self.names(pattern)]
        found = [value for value in found if value is not None]
        return sum(found) if found else None

    def largest(self, pattern, counter):
        found = [self.worst(name, counter) for name in self.names(pattern)]
        return max((value for value in found if value is not None), default=None)

    def variation(self):
        """Coefficient of variation of S1 at the large size, median over the sets."""
        rows = [self.rows[name].get("cv") for name in self.names(rf"s1/cylinder/scan/n:{LARGE}/.*")]
        values = [row["cpu_time"] for row in rows if row]
        return median(values) if values else None


def over_seeds(ratios, accept, stretch):
    """The demands "median; worst" of a list of ratios."""
    if not ratios:
        return [Part(None, accept[0], stretch[0]), Part(None, accept[1], stretch[1])]
    return [Part(median(ratios), accept[0], stretch[0]), Part(max(ratios), accept[1], stretch[1])]


def median_or_none(values):
    return median(values) if values else None


def share(runs, pattern, counters):
    sets = runs.total(pattern, "sets")
    return sum(runs.total(pattern, c) for c in counters) / sets if sets else None


def time_gates(runs):
    """The gates on time, rows R0 to R13."""
    mz, s1 = "mz/cylinder", "s1/cylinder"
    middle = f"/scan/n:{LARGE // 10}"
    small = "/cylinder/start-5deg/n:24"
    rows = [
        ("R0", "S1 / read-and-sum, cylinder, 1e6",
         [Part(median_or_none(runs.ratios_over_seeds(f"{s1}/scan", "read/cylinder/scan")),
               1.15, 1.05)]),
        ("R1", "MZ cylinder / S1, 1e6, scan order: median; worst",
         over_seeds(runs.ratios_over_seeds(f"{mz}/scan", f"{s1}/scan"), (3, 6), (2.3, 4))),
        ("R2", "MZ cylinder / S1, 1e6, shuffled: median; worst",
         over_seeds(runs.ratios_over_seeds(f"{mz}/shuffled", f"{s1}/shuffled"), (5, 10), (3, 5))),
        ("R3", "MZ circle / S1, 1e6: median; worst",
         over_seeds(runs.ratios_over_seeds("mz/circle/scan", "s1/circle/scan"), (3, 7), (2.3, 4))),
        ("R4", "MZ cylinder / S1; MZ circle / S1, 1e5",
         [Part(runs.ratio(mz + middle, s1 + middle), 5, 2.6),
          Part(runs.ratio("mz/circle" + middle, "s1/circle" + middle), 5, 2.6)]),
        ("R5", "MZ cylinder / NLopt SLSQP, 24 points, start 5 deg off",
         [Part(runs.ratio("mz" + small, "nlopt-slsqp" + small), 1 / 12, 1 / 25)]),
        ("R6", "MZ circle / CGAL Delaunay, 20 points",
         [Part(runs.ratio("mz/circle/scan/n:20", "cgal-delaunay/circle/scan/n:20"), 0.4, 0.2)]),
        ("R7", "MZ circle / CGAL Min_annulus_d, every N; / ALGLIB fitspheremz, N <= 1e4",
         [Part(runs.worst_ratio("mz/circle", "cgal-annulus/circle"), 1 / 100, 1 / 200),
          Part(runs.worst_ratio("mz/circle", "alglib-fitspheremz/circle"), 1 / 1000, 1 / 3000)]),
        ("R8", "MZ cylinder / NLopt Nelder-Mead with S1 as objective, N <= 1e3; N >= 1e4",
         [Part(runs.worst_ratio(mz, "nlopt-nelder-mead/cylinder", 0, 1000), 1 / 8, 1 / 20),
          Part(runs.worst_ratio(mz, "nlopt-nelder-mead/cylinder", 10_000), 1 / 30, 1 / 100)]),
        ("R9", "LS cylinder, 1e6: / S1; / Ceres with automatic differentiation",
         [Part(median_or_none(runs.ratios_over_seeds("ls/cylinder/scan", f"{s1}/scan")), 4.5, 3),
          Part(runs.worst_ratio("ls/cylinder", "ceres/cylinder"), 1 / 300, 1 / 800)]),
        ("R10", "MC circle / CGAL Min_sphere_of_spheres_d, every N",
         [Part(runs.worst_ratio("mc/circle", "cgal-sphere/circle"), 1 / 3, 1 / 5)]),
        ("R12", "Text of 1e6 points / bare from_chars loop",
         [Part(runs.ratio(f"text/ours/n:{LARGE}", f"text/from_chars/n:{LARGE}"), 1.25, 1.0)]),
        ("R13", "LS, MZ, MC, MI of one cylinder together / S1, 1e6",
         [Part(median_or_none(runs.ratios_over_seeds("four/cylinder/scan", f"{s1}/scan")), 14, 9)]),
    ]
    return [Gate(*row, True) for row in rows]


def exact_gates(runs):
    """The gates on the result, which no noise excuses."""
    wide, narrow = r"reach/.*/arc:(180|360)/.*", r"reported/.*/arc:60/.*"
    rows = [
        ("A1", "Excess over the best known, every set above",
         [Part(runs.largest(r"(mz|exact)/.*", "excess"), 1e-9, 1e-11)]),
        ("A2", "Reaches the best known, one call, arc >= 180 deg, 3000 sets",
         [Part(share(runs, wide, ["reached"]), 0.999, 1.0, True)]),
        ("A3", "60 deg arc, 9 and 12 points, reported value: reached or marked as not proven; "
               "reached; time / one call",
         [Part(share(runs, narrow, ["reached", "flagged"]), 1.0, 1.0, True),
          Part(share(runs, narrow, ["reached"]), 0.0, 0.995, True),
          Part(runs.largest(narrow, "time_ratio"), math.inf, 10)]),
        ("A4", "Zones whose certificate does not hold when checked by other code",
         [Part(runs.total(r"(mz|exact|reach)/.*", "faults"), 0, 0)]),
        ("M1", "Heap allocations of a repeated call",
         [Part(runs.largest(r"mz/.*", "allocations"), 0, 0)]),
    ]
    return [Gate(*row, False) for row in rows]


def holds(part, limit):
    return part.value >= limit if part.at_least else part.value <= limit


def verdict(gate, noise):
    measured = [part for part in gate.parts if part.value is not None]
    if measured and gate.timed and noise:
        return "not judged"
    if not all(holds(part, part.accept) for part in measured):
        return "**not met**"
    if len(measured) < len(gate.parts):
        return "not measured"
    return "stretch" if all(holds(part, part.stretch) for part in gate.parts) else "met"


def noise_of(runs):
    """Why times cannot be judged; empty on a quiet machine."""
    why = []
    variation = runs.variation()
    load = (runs.context.get("load_avg") or [0.0])[0]
    if variation is not None and variation > LARGEST_VARIATION:
        why.append(f"S1 varies by {100 * variation:.1f} %, limit {100 * LARGEST_VARIATION:.0f} %")
    if load > LARGEST_LOAD:
        why.append(f"load average {load:.2f}, limit {LARGEST_LOAD:.0f}")
    return "; ".join(why)


def number(value, at_least=False):
    if value is None or (value == math.inf) or (at_least and value == 0):
        return "-"
    if at_least:
        return f"{100 * value:.4g} %"
    if 1e-6 < value < 1 and (value < 0.1 or abs(1 / value - round(1 / value)) < 1e-9):
        return f"1/{1 / value:.4g}"
    return f"{value:.3g}"


def joined(gate, field):
    texts = []
    for part in gate.parts:
        text = number(getattr(part, field), part.at_least)
        sign = "" if field == "value" or text == "-" else ">= " if part.at_least else "<= "
        texts.append(sign + text)
    return "; ".join(texts)


def gate_table(gates, noise):
    lines = ["| # | goal | accept | stretch | measured | |", "|---|---|---|---|---|---|"]
    if noise:
        lines.append(f"| | **noisy machine**: {noise} | | | | times not judged |")
    for gate in gates:
        lines.append(f"| {gate.id} | {gate.goal} | {joined(gate, 'accept')} | "
                     f"{joined(gate, 'stretch')} | {joined(gate, 'value')} | "
                     f"{verdict(gate, noise)} |")
    return lines


def rows_by_size(runs, what):
    """(variant, points) -> names of all seeds."""
    out = {}
    for name in runs.names(re.escape(what) + r"/[^/]+/n:\d+(/seed:\d+)?"):
        variant, points = re.search(r"/([^/]+)/n:(\d+)", name).groups()
        out.setdefault((int(points), variant), []).append(name)
    return dict(sorted(out.items()))


def time_table(runs):
    lines = ["| shape | points | order | T us | T / S1 | passes | pivots |",
             "|---|---|---|---|---|---|---|"]
    for shape in ("cylinder", "circle"):
        for (points, variant), names in rows_by_size(runs, f"mz/{shape}").items():
            time = median(runs.time_ns(name) for name in names)
            ratios = [runs.ratio(name, "s1" + name[2:]) for name in names]
            ratios = [value for value in ratios if value]
            ratio = f"{median(ratios):.3g}" if ratios else "-"
            effort = [max(runs.worst(name, key) or 0 for name in names) or "-"
                      for key in ("passes", "pivots")]
            lines.append(f"| {shape} | {points} | {variant} | {time / 1e3:.4g} | {ratio} | "
                         f"{effort[0]} | {effort[1]} |")
    return lines


PEERS = [("nlopt-slsqp/cylinder", "mz/cylinder"), ("nlopt-nelder-mead/cylinder", "mz/cylinder"),
         ("ceres/cylinder", "ls/cylinder"), ("cgal-annulus/circle", "mz/circle"),
         ("alglib-fitspheremz/circle", "mz/circle"), ("cgal-delaunay/circle", "mz/circle"),
         ("cgal-sphere/circle", "mc/circle")]


def peer_table(runs):
    lines = ["| peer | points | T us | peer / ours |", "|---|---|---|---|"]
    for peer, ours in PEERS:
        for (points, _), names in rows_by_size(runs, peer).items():
            ratio = runs.ratio(names[0], ours + names[0][len(peer):])
            lines.append(f"| {peer} | {points} | {runs.time_ns(names[0]) / 1e3:.4g} | "
                         f"{f'{ratio:.4g}' if ratio else '-'} |")
    return lines


def processor():
    try:
        text = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8")
        return re.search(r"model name\s*:\s*(.*)", text).group(1)
    except (OSError, AttributeError):
        return platform.machine()


def commit():
    def git(*words):
        return subprocess.run(["git", *words], capture_output=True, text=True, check=False,
                              cwd=pathlib.Path(__file__).parent).stdout.strip()
    changed = git("status", "--porcelain", "--untracked-files=no")
    return (git("rev-parse", "--short", "HEAD") or "unknown") + (" with changes" if changed else "")


def about(runs, command):
    c = runs.context
    caches = ", ".join(f"L{x['level']} {x['type'].lower()} {x['size'] // 1024} KiB"
                       for x in c.get("caches", []))
    load = (c.get("load_avg") or ["-"])[0]
    return [f"{processor()}, {c.get('num_cpus')} cores, {c.get('mhz_per_cpu')} MHz; {caches}.",
            f"Load average {load}; commit {commit()}; {c.get('date', '')[:10]}; `{command}`."]


def write_doc(path, lines):
    """Replaces what stands between the two marks."""
    text = path.read_text(encoding="utf-8")
    begin, end = text.index(BEGIN) + len(BEGIN), text.index(END)
    path.write_text(text[:begin] + "\n" + "\n".join(lines) + "\n" + text[end:], encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", type=pathlib.Path)
    parser.add_argument("--doc", type=pathlib.Path)
    parser.add_argument("--command", default="./benchmarks/run.sh")
    parser.add_argument("--allow-noise", action="store_true")
    parser.add_argument("--partial", action="store_true")
    options = parser.parse_args()
    try:
        runs = Runs(json.loads(options.run.read_text(encoding="utf-8")))
    except (OSError, ValueError, KeyError) as problem:
        print(f"{options.run}: not a report of Google Benchmark: {problem!r}", file=sys.stderr)
        return 2
    noise = noise_of(runs)
    gates = time_gates(runs) + exact_gates(runs)
    table = gate_table(gates, noise)
    print("\n".join(table))
    if options.doc:
        write_doc(options.doc, about(runs, options.command) + ["", "### Gates", ""] + table +
                  ["", "### Times", ""] + time_table(runs) + ["", "### Peers", ""] +
                  peer_table(runs))
    verdicts = [verdict(gate, noise) for gate in gates]
    if "**not met**" in verdicts or ("not measured" in verdicts and not options.partial):
        return 1
    return 3 if "not judged" in verdicts and not options.allow_noise else 0


if __name__ == "__main__":
    sys.exit(main())
