"""What stands in docs/developer/performance.md besides the gates: machine, times, peers."""

import pathlib
import platform
import re
import subprocess
from statistics import median

BEGIN, END = "<!-- measured: begin -->", "<!-- measured: end -->"


def rows_by_size(runs, what):
    """(variant, points) -> names of all seeds."""
    out = {}
    for name in runs.names(re.escape(what) + r"/[^/]+/n:\d+(/seed:\d+)?"):
        variant, points = re.search(r"/([^/]+)/n:(\d+)", name).groups()
        out.setdefault((int(points), variant), []).append(name)
    return dict(sorted(out.items()))


SHOWN = {12, 20, 24, 100, 1000, 10000, 100000, 1000000}  # numbers of points; the gates judge all


def time_table(runs):
    lines = ["shape | points | order | T us | T / S1", "---|---|---|---|---"]
    for shape in ("cylinder", "circle"):
        for (points, variant), names in rows_by_size(runs, f"mz/{shape}").items():
            if points not in SHOWN:
                continue
            time = median(runs.time_ns(name) for name in names)
            ratios = [runs.ratio(name, "s1" + name[2:]) for name in names]
            ratios = [value for value in ratios if value]
            ratio = f"{median(ratios):.3g}" if ratios else "-"
            lines.append(f"{shape} | {points} | {variant} | {time / 1e3:.4g} | {ratio}")
    return lines


PEERS = [("nlopt-slsqp/cylinder", "mz/cylinder"), ("nlopt-nelder-mead/cylinder", "mz/cylinder"),
         ("ceres/cylinder", "ls/cylinder"), ("cgal-annulus/circle", "mz/circle"),
         ("alglib-fitspheremz/circle", "mz/circle"), ("cgal-delaunay/circle", "mz/circle"),
         ("cgal-sphere/circle", "mc/circle")]


def peer_table(runs):
    """Each peer at its least and its greatest number of points."""
    lines = ["peer | points | T us | peer / ours | worst excess", "---|---|---|---|---"]
    for peer, ours in PEERS:
        sizes = list(rows_by_size(runs, peer).items())
        for (points, _), names in sizes[:1] + sizes[1:][-1:]:
            ratio = runs.ratio(names[0], ours + names[0][len(peer):])
            excess = runs.worst(names[0], "excess")
            lines.append(f"{peer} | {points} | {runs.time_ns(names[0]) / 1e3:.4g} | "
                         f"{f'{ratio:.4g}' if ratio else '-'} | "
                         f"{'-' if excess is None else f'{excess:.2g}'}")
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
