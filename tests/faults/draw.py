#!/usr/bin/env python3
"""Plants switched faults in a copy of the sources that is configured with the release preset: see README.md.

draw.py --tree COPY --seed 1 --count 60 --out faults.tsv       draws faults, and adds those of by_hand.json
draw.py --tree COPY --apply faults.tsv [--only 3,17] --out f   plants faults of a table in a copy of other sources
"""
import argparse
import bisect
import concurrent.futures
import itertools
import json
import os
import pathlib
import random
import re
import shlex
import shutil
import subprocess
import sys

ROOMS = "core fit wire record fixture cmm plans evaluation reports web app".split()
HERE = pathlib.Path(__file__).resolve().parent

TOKEN = re.compile(r"""
  (?P<gap>\s+|//[^\n]*|/\*.*?\*/)
 |(?P<directive>(?:(?<=\n)|\A)\#(?:\\\n|[^\n])*)
 |(?P<string>(?:u8|[uUL])?(?:R"(?P<end>[^()\\\s]{0,16})\(.*?\)(?P=end)"|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])+'))
 |(?P<number>\.?\d(?:(?<=[eEpP])[+-]|'?[\w.])*)
 |(?P<name>[A-Za-z_]\w*)
 |(?P<mark><=>|<<=|>>=|\.\.\.|::|->|\+\+|--|<<|>>|<=|>=|==|!=|&&|\|\||[-+*/%&|^]=|\S)
""", re.X | re.S)

TURNED = {"<": ">=", ">=": "<", ">": "<=", "<=": ">", "==": "!=", "!=": "=="}
KEYWORDS = set("if for while switch return catch sizeof decltype throw noexcept assert else case operator".split())
# Not evaluated when the program runs, in what stands before a token of its statement.
FIXED = re.compile(r"\b(constexpr|consteval|static_assert|using|template|enum|assert)\b|\bcase\b([^:]|::)*$")
# A larger buffer, a longer wait, one more attempt, another precision of a search: the same answer by construction.
PATIENCE = re.compile(r"timeout|time_limit|deadline|patience|wait|sleep|poll|reserve|capacity|buffer|chunk|retr(y|ies)|"
                      r"attempt|iteration|milliseconds|seconds|minutes|precision|backlog|thread|seed|noise|"
                      r"(\b|_)(pass|round|trie)(s|es)?(\b|_)|step_limit|max_(steps|lines|bytes)", re.I)
# Added to a value, they change it by less than any tolerance of a test, and are meant to.
TINY = re.compile(r"(\b|_|k)(eps|tiny|roundoff|noise_floor)|e-([6-9]|\d\d)$|^0(\.0)?$", re.I)
SYMMETRIC = re.compile(r"^(min|max|minmax|swap|hypot|gcd|lcm|midpoint)$|distance|difference|same|equal|between|near|"
                       r"close|overlap|apart|gap|agree|differ", re.I)
UNIT = re.compile(r"_([munk]?m|u?rad|deg|n|s|ms|hz|per_\w+)$|\.[xyz]\(\)$")
ERROR_RETURN = re.compile(r"\b(fail|unexpected|refuse)\s*\(|\.error\(\)|\bfailure\w*$|\berror$")


class Source:
    """The tokens of one file: kinds, words, where they begin and end, and whether a run evaluates them."""

    def __init__(self, path, file):
        self.file, self.text = file, path.read_text()
        tokens = [m for m in TOKEN.finditer(self.text) if m.lastgroup not in ("gap", "directive")]
        self.kinds, self.words = [m.lastgroup for m in tokens], [m.group() for m in tokens]
        self.begins, self.ends = [m.start() for m in tokens], [m.end() for m in tokens]
        self.pair, self.runs, stack = {}, [], []
        for i, word in enumerate(self.words):
            if word in ("(", "[", "{"):
                stack.append(i)
            elif word in (")", "]", "}"):
                self.pair[i] = stack.pop()
                self.pair[self.pair[i]] = i
        stack, start = [False], 0
        for i, word in enumerate(self.words):
            self.runs.append(stack[-1])
            if word == "{":
                head = set(self.words[start:i])
                code = stack[-1] or "(" in head or (not head and self.words[i - 1] == "}")
                stack.append(code and not {"enum", "namespace"} & head)
            elif word == "}":
                stack.pop()
            if word in ("{", "}", ";"):
                start = i + 1

    def piece(self, first, last):
        return self.text[self.begins[first]:self.ends[last]]

    def line(self, first, last=None):
        end = self.ends[first if last is None else last]
        return self.text[self.text.rfind("\n", 0, self.begins[first]) + 1:self.text.find("\n", end)]

    def spaced(self, i):
        """A binary operator: the formatter puts a space on either side of it and of nothing else."""
        return self.text[self.begins[i] - 1].isspace() and self.text[self.ends[i]].isspace()

    def in_template(self, i):
        """Whether a token stands among template arguments: after `<` without a space."""
        return re.search(r"\w<([^<>()=;{}?]|<[^<>]*>)*$", self.text[max(0, self.begins[i] - 120):self.begins[i]])

    def statement(self, i):
        """Where the statement of a token begins and ends, nearly."""
        first = max(self.text.rfind(mark, 0, self.begins[i]) for mark in ";{}") + 1
        return first, min(self.text.find(mark, self.ends[i]) % len(self.text) for mark in ";{}")

    def postfix(self, i):
        """The last token of the simple operand that starts at i, or None."""
        if self.kinds[i] == "number":
            return i
        if self.words[i] == "(":
            i = self.pair[i]
        elif self.kinds[i] != "name" or self.words[i] in KEYWORDS:
            return None
        while True:
            after = self.words[i + 1]
            if after in ("::", ".", "->") and self.kinds[i + 2] == "name":
                i += 2
            elif after in ("(", "["):
                i = self.pair[i + 1]
            else:
                return None if after in ("++", "--", "{") or (after == "<" and not self.spaced(i + 1)) else i

    def side(self, i, step):
        """The far end of the operand of the comparison at i, or None where it is not surely one."""
        ends = {",", "=", ";", "{", "}", "return", "&&", "||", "?", ":", ")" if step > 0 else "("}
        k = i + step
        while 0 < k < len(self.words) and self.words[k] not in ends:
            word = self.words[k]
            if word in KEYWORDS | {"!", "<<", ">>", "&", "|", "^", "<=>"} or (word in TURNED and self.spaced(k)):
                return None
            k = self.pair.get(k, k) + step
        return None if k == i + step else k - step

    def apparent_type(self, i, operand):
        """The type by which a name was declared last before i, or else the unit in it, or None."""
        found = re.findall(rf"([\w:<>]+)[ &*]+{re.escape(operand)} ?[,)=;{{:]", self.text[:self.begins[i]])
        if operand.isidentifier() and found and found[-1] not in ("auto", "return", "const"):
            return found[-1]
        unit = UNIT.search(operand)
        return unit and unit.group()


# Each finds the ways in which a place can be wrong: (kind, first token, last token, text in their place); `@` stands
# for the number of the fault.

def comparisons(s, i):
    if s.words[i] not in TURNED or not s.spaced(i):
        return []
    a, b, op = s.side(i, -1), s.side(i, +1), s.words[i]
    if a is None or b is None or "EINTR" in s.line(i):  # interrupted by chance
        return []
    left, right, before = s.piece(a, i - 1), s.piece(i + 1, b), s.text[:s.statement(i)[0]]
    written = [("comparison turned", TURNED[op])]
    # Of floating-point numbers `<` and `<=` are alike: only where one is whole, or in the head of a loop.
    whole = re.search(r"(?<![\w.])(?<!e-)\d+[uUlLzZ]*(?![\w.])|\b(size|length)\(\)", f"{left} {right}")
    looped = re.search(r"\bfor \([^;]*;$", before[-120:])
    if op[0] in "<>" and (whole or looped) and not PATIENCE.search(s.line(i)):
        written.append(("comparison off by one", op[0] if op[1:] else op + "="))
    return [(kind, a, b, f"(rondure_fault(@) ? {left} {to} {right} : {left} {op} {right})") for kind, to in written]


def constants(s, i):
    word, before = s.words[i], s.words[i - 1]
    whole = re.fullmatch(r"(0|[1-9][\d']*|0x[0-9a-fA-F']+)[uUlLzZ]*", word)
    sizes_array = re.search(r"[\w>&*] \w+\[$", s.text[s.begins[i] - 40:s.begins[i]])
    if s.kinds[i] != "number" or not whole or s.in_template(i) or sizes_array:
        return []
    if PATIENCE.search(s.text[slice(*s.statement(i))] + s.line(i)):
        return []
    if before in ("=", "{") and s.kinds[i - 2] == "name" and s.words[i + 1] in (";", "}"):
        later = next((k for k in range(i + 1, len(s.words)) if s.words[k] == s.words[i - 2]), None)
        if not later or s.words[later - 1] == "&" or s.words[later + 1] == "=" or s.words[later - 2] in ("into", "use"):
            return []  # a first value that is written over before it is read, or bound to a statement of the database
    signs = "+" if re.match(r"0(x0+)?\b", word) else "+-"
    return [("constant off by one", i, i, f"({word} {sign} rondure_fault(@))") for sign in signs]


def signs(s, i):
    before = s.words[i - 1]
    unary = s.words[i] == "-" and s.text[s.ends[i]] != " " and (
        before in ("return", "(", ",", "=", "?", ":", "{", "[", "*", "/", "&&", "||") or before in TURNED)
    if not unary and not (s.words[i] in ("+", "-", "+=", "-=") and s.spaced(i)):
        return []
    end = s.postfix(i + 1)
    if end is None or s.in_template(i) or "string" in s.kinds[i - 1:end + 1] or TINY.search(s.piece(i + 1, end)):
        return []
    return [("sign", i + 1, end, f"rondure_signed(@, {s.piece(i + 1, end)})")]


def guards(s, i):
    if s.words[i] != "if" or s.words[i + 1] != "(":
        return []
    close = s.pair[i + 1]
    start = max([k for k in range(i + 2, close) if s.words[k] == ";"], default=i + 1) + 1
    back = close + 1 + (s.words[close + 1] == "{")
    returned = s.piece(back, s.words.index(";", back) - 1)
    if s.words[back] != "return" or "=" in s.words[start:close] or not ERROR_RETURN.search(returned):
        return []
    return [("dropped error return", start, close - 1, f"!rondure_fault(@) && ({s.piece(start, close - 1)})")]


def swaps(s, i):
    if s.words[i] != "(" or s.kinds[i - 1] != "name" or s.words[i - 1] in KEYWORDS or SYMMETRIC.search(s.words[i - 1]):
        return []
    found, args, start, k = [], [], i + 1, i + 1
    while k <= s.pair[i]:
        if s.words[k] == "," or k == s.pair[i]:
            args.append((start, k - 1))
            start = k + 1
        k = (s.pair[k] if s.words[k] in ("(", "[", "{") else k) + 1
    simple = re.compile(r"[A-Za-z_]\w*((::|\.|->)\w+|\[\w+\])*(\.[xyz]\(\))?")
    for (a, b), (c, d) in zip(args, args[1:]):
        one, other = s.piece(a, b), s.piece(c, d)
        if one == other or not simple.fullmatch(one) or not simple.fullmatch(other):
            continue
        kind = s.apparent_type(i, one)  # indices are mostly those of a symmetric matrix
        if kind and kind == s.apparent_type(i, other) and not re.fullmatch("[ijkmn]{2}", one + other):
            text = f"rondure_pick(@, {one}, {other}), rondure_pick(@, {other}, {one})"
            found.append(("swapped arguments", a, d, text))
    return found


KINDS = [comparisons, constants, signs, guards, swaps]


def candidates(tree, room):
    """The lines of a room's sources, and by kind its places that can be wrong, each with its ways."""
    found, lines = [[] for _ in KINDS], 0
    for path in sorted(p for p in (tree / room).rglob("*.cpp") if "avx" not in p.name):  # may be for another processor
        s = Source(path, path.relative_to(tree).as_posix())
        lines += s.text.count("\n")
        for i in (i for i in range(4, len(s.words) - 2) if s.runs[i]):
            for list_, finder in zip(found, KINDS):
                ways = [w for w in finder(s, i) if "\n" not in s.line(w[1], w[2])]
                if ways and not FIXED.search(s.text[s.statement(i)[0]:s.begins[i]]):
                    list_.append((s, ways))
    return lines, found


def fault_of(number, s, way):
    kind, first, last, text = way
    before, line = s.line(first), s.text.count("\n", 0, s.begins[first]) + 1
    at = s.begins[first] - s.text.rfind("\n", 0, s.begins[first]) - 1
    after = before[:at] + text.replace("@", str(number)) + before[at + s.ends[last] - s.begins[first]:]
    return dict(number=number, file=s.file, line=line, kind=kind, before=before.strip(), after=after.strip())


def plant(tree, faults):
    """Writes the faults into the tree; returns those whose line is there, with its number."""
    placed = []
    for file in sorted({f["file"] for f in faults}):
        lines = (tree / file).read_text().split("\n") if (tree / file).exists() else []
        for fault in (f for f in faults if f["file"] == file):
            at = [k for k, text in enumerate(lines) if text.strip() == fault["before"]]
            if not at:
                print(f"fault {fault['number']}: {file} has no line `{fault['before']}`", file=sys.stderr)
                continue
            k = min(at, key=lambda k: abs(k + 1 - fault["line"]))
            lines[k] = lines[k].replace(fault["before"], fault["after"])
            placed.append({**fault, "line": k + 1})
        if lines:  # the space hides the line from the test that reads every #include
            (tree / file).write_text(f'# include "{tree}/build/switch.h"\n#line 1\n' + "\n".join(lines))
    shutil.copy(HERE / "switch.h", tree / "build")
    return sorted(placed, key=lambda f: int(f["number"]))


def commands(tree):
    """How each source is compiled, alone: those of a batch as their batch is."""
    out = {}
    for entry in json.loads((tree / "build/release/compile_commands.json").read_text()):
        file, args = pathlib.Path(entry["file"]), [a for a in shlex.split(entry["command"]) if a != "-c"]
        del args[args.index("-o"):args.index("-o") + 2]
        args.remove(entry["file"])
        batch = re.findall(r'#include "(.*\.cpp)"', file.read_text()) if "unity_" in file.name else [entry["file"]]
        for source in batch:
            out.setdefault(pathlib.Path(source), (entry["directory"], args))
    return out


def refused(tree, how, file, faults):
    """The numbers of the faults planted in a file that do not compile: all, where no error names the line of one."""
    directory, args = how.get(tree / file, (tree, ["true" if file.endswith(".h") else "false"]))
    args = [*args, "-fsyntax-only", "-Wno-error", "-Werror=vla", "-fmax-errors=0", str(tree / file)]
    done = subprocess.run(args, cwd=directory, capture_output=True, text=True)
    found = [re.findall(rf"{re.escape(file)}:(\d+):\d+: {what}", done.stderr) for what in ("error:", " *required from")]
    bad = [[f["number"] for f in faults if str(f["line"]) in at] for at in found] + [[f["number"] for f in faults]]
    return next(filter(None, bad), []) if done.returncode else []


def check(tree, how, faults):
    """Plants the faults for the time of a check. Returns those that have a place, and which numbers do not compile."""
    files = sorted({f["file"] for f in faults if (tree / f["file"]).exists()})
    originals = {file: (tree / file).read_text() for file in files}
    placed = plant(tree, faults)
    of = {file: [f for f in placed if f["file"] == file] for file in files}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        bad = set().union(*pool.map(lambda file: refused(tree, how, file, of[file]), files))
    for file, text in originals.items():
        (tree / file).write_text(text)
    for fault in (f for f in placed if f["number"] in bad):
        print("does not compile: fault {number}, {kind}, {file}:{line}".format(**fault), file=sys.stderr)
    return placed, bad


def draw(tree, how, seed, count, used):
    lines, places = zip(*(candidates(tree, room) for room in ROOMS))
    # One for each room, and the others in proportion to the lines.
    steps, others = list(itertools.accumulate(lines)), max(0, count - len(ROOMS))
    by_lines = [bisect.bisect(steps, (n + 0.5) / others * steps[-1]) for n in range(others)]
    rooms = sorted([*range(min(count, len(ROOMS))), *by_lines])
    dice, faults = random.Random(seed), [None] * count
    while None in faults:
        fresh = set()
        for n in (n for n in range(count) if faults[n] is None):
            kind = n % len(KINDS)  # the kinds take turns
            while faults[n] is None:
                while not places[rooms[n]][kind]:
                    kind = (kind + 1) % len(KINDS)
                of_kind = places[rooms[n]][kind]
                s, ways = of_kind.pop(dice.randrange(len(of_kind)))
                fault = fault_of(n + 1, s, dice.choice(ways))
                faults[n] = None if (s.file, fault["line"]) in used else fault
            used.add((s.file, fault["line"]))
            fresh.add(s.file)
        _, bad = check(tree, how, [f for f in faults if f["file"] in fresh])
        faults = [None if f["number"] in bad else f for f in faults]
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tree", type=lambda text: pathlib.Path(text).resolve(), required=True)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--apply", type=pathlib.Path)
    parser.add_argument("--only", type=lambda text: [int(n) for n in text.split(",")], help="faults of the table: 3,17")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    given = parser.parse_args()
    how = commands(given.tree)
    if given.apply:
        rows = [re.split("\t|:(?=\\d+\t)", line) for line in given.apply.read_text().splitlines()[1:]]
        keys = ["number", "room", "file", "line", "kind", "before", "after"]
        faults = [{**dict(zip(keys, row)), "number": int(row[0]), "line": int(row[3])} for row in rows]
        faults = [f for f in faults if not given.only or f["number"] in given.only]
        placed, bad = check(given.tree, how, faults)
    else:
        hand = [{**f, "number": number, "line": 1, "after": f["after"].replace("@", str(number))}
                for number, f in enumerate(json.loads((HERE / "by_hand.json").read_text()), given.count + 1)]
        placed, bad = check(given.tree, how, hand)
        placed = draw(given.tree, how, given.seed, given.count, {(f["file"], f["line"]) for f in placed}) + placed
    faults = plant(given.tree, [f for f in placed if f["number"] not in bad])
    row = "{number}\t{0}\t{file}:{line}\t{kind}\t{before}\t{after}\n"
    rows = [row.format(f["file"].split("/")[0], **f) for f in faults]
    given.out.write_text("number\troom\tplace\tkind\tbefore\tafter\n" + "".join(rows))


if __name__ == "__main__":
    main()
