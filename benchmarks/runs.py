"""A report of rondure_benchmarks by name: times, ratios, counters."""

import math
import re
from statistics import median

LARGE = 1_000_000  # the size that stands for "large" in the gates
NS = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}


def worst_of(values):
    """The largest; NaN if any is NaN, which meets no gate; None of nothing."""
    values = [value for value in values if value is not None]
    if any(math.isnan(value) for value in values):
        return math.nan
    return max(values, default=None)


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
        return worst_of(found)

    def total(self, pattern, counter):
        """Sum of a counter over the benchmarks of a pattern; None when there are none."""
        found = [self.worst(name, counter) for name in self.names(pattern)]
        found = [value for value in found if value is not None]
        return sum(found) if found else None

    def largest(self, pattern, counter):
        return worst_of(self.worst(name, counter) for name in self.names(pattern))

    def variation(self):
        """Coefficient of variation of S1 at the large size, median over the sets."""
        rows = [self.rows[name].get("cv") for name in self.names(rf"s1/cylinder/scan/n:{LARGE}/.*")]
        values = [row["cpu_time"] for row in rows if row]
        return median(values) if values else None
