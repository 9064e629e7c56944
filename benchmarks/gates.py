#!/usr/bin/env python3
"""Judges a run of rondure_benchmarks against the gates and writes docs/developer/performance.md.

    gates.py RUN.json [--doc docs/developer/performance.md] [--command TEXT] [--allow-noise] [--partial]

Exit status: 0 every gate met; 1 a gate broken, or not measured (but with --partial); 2 the file
cannot be read; 3 the machine was too noisy to judge times (0 with --allow-noise).
Times are CPU times, medians of the repetitions; a gate on several sizes is judged by the worst.
"""

import argparse
import json
import math
import pathlib
import re
import sys
from collections import namedtuple
from statistics import median

from runs import LARGE, Runs, worst_of
from tables import about, peer_table, time_table, write_doc

LARGEST_VARIATION = 0.05  # of S1, between repetitions
LARGEST_LOAD = 1.0
SEEDS = 20  # sets behind a "worst" clause, at least

# One demand of a gate. value None: not measured. at_least: the value must not be below accept.
Part = namedtuple("Part", "value accept stretch at_least", defaults=(False,))
# timed: depends on a quiet machine.
Gate = namedtuple("Gate", "id goal parts timed")


def over_seeds(ratios, accept, stretch):
    """The demands "median; worst" of a list of ratios; of too few sets there is no worst."""
    worst = worst_of(ratios) if len(ratios) >= SEEDS else None
    return [Part(median_or_none(ratios), accept[0], stretch[0]), Part(worst, accept[1], stretch[1])]


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
    if 1e-4 < value < 1 and (value < 0.1 or abs(1 / value - round(1 / value)) < 1e-9):
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
