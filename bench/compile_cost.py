#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What compiling with ductile costs: compile_cost.py [--tree CHECKOUT] [--before CHECKOUT] [--out CSV]

Compiles a few sources, one at a time and as a user would by hand, and prints user CPU time and peak memory of
the compiler, medians of --repeats. Only the compile step: nothing is linked.

    --tree CHECKOUT      what is compiled; default this one
    --label NAME         what its rows are called; default after
    --before CHECKOUT    another checkout, beside it: each source is compiled in both in turn, so that a machine
                         that is busy for a while disturbs both alike; its rows are called before
    --repeats N          default 3
    --only REGEX         of the names of the sources
    --cxx COMPILER       default g++; ccache is switched off
    --out CSV            rows are appended; those of the same label and name there are replaced

A source that does not compile is named and left out; the exit status is then 1.

    Eigen, btBulletDynamicsCommon.h, ode.h     yardsticks that are not ours: Eigen/Core with Eigen/Geometry, the
                                               engines' headers; the same in every checkout
    ductile.hpp, bullet.hpp, ode.hpp           the front doors, included and nothing used
    program-bullet, program-ode                examples/existing_world: 60 lines that use a joint and a World
    program-bullet-compiled, ...-ode-compiled  the same with -DDUCTILE_COMPILED, as against the compiled library;
                                               only where the checkout has one
    charpy-bullet, charpy-ode                  examples/charpy/runner.cpp, the largest source of the examples, with
                                               the release preset's flags

Bullet is the one in double. s is user CPU time with all that the compiler starts (wait4); MB are 10^6 bytes of the
largest of its processes. Times are those of a machine: compare them within one run, or with the yardsticks.

Columns: label,name,user_s,user_s_min,rss_mb,repeats,commit,processor,compiler,flags.
"""

import argparse
import csv
import os
import re
import shlex
import statistics
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from common import Progress, output, processor, write_rows

COLUMNS = ("label", "name", "user_s", "user_s_min", "rss_mb", "repeats", "commit", "processor", "compiler", "flags")
ENGINES = {"bullet": "bullet-float64", "ode": "ode"}  # adapter's folder -> pkg-config's name
COMPILED = "-DDUCTILE_COMPILED"


@dataclass(frozen=True)
class Source:
    name: str
    text: str = ""    # of a source made here, or
    path: str = ""    # one of the checkout
    engine: str = ""  # adapter's folder; empty: the core alone
    flags: str = "-O2"

    def there(self, tree):
        """Whether the checkout and this machine have what it takes."""
        if self.engine and not output("pkg-config", "--modversion", ENGINES[self.engine]):
            return False
        if COMPILED in self.flags and not (tree / "adapters/compiled").is_dir():
            return False
        return not self.path or (tree / self.path).is_file()

    def command(self, tree, compiler, scratch):
        path = tree / self.path if self.path else scratch / "included.cpp"
        if not self.path:
            path.write_text(self.text)
        packages = ["eigen3"] + ([ENGINES[self.engine]] if self.engine else [])
        adapters = [f"-I{tree}/adapters/{self.engine}/include"] if self.engine else []
        return [compiler, "-std=c++20", *self.flags.split(), f"-I{tree}/include", *adapters,
                *output("pkg-config", "--cflags", *packages).split(), "-c", str(path), "-o", os.devnull]


def including(*headers):
    return "".join(f"#include <{header}>\n" for header in headers)


SOURCES = [
    Source("Eigen", text=including("Eigen/Core", "Eigen/Geometry")),
    Source("btBulletDynamicsCommon.h", text=including("btBulletDynamicsCommon.h"), engine="bullet"),
    Source("ode.h", text=including("ode/ode.h"), engine="ode"),
    Source("ductile.hpp", text=including("ductile/ductile.hpp")),
    Source("bullet.hpp", text=including("ductile/bullet/bullet.hpp"), engine="bullet"),
    Source("ode.hpp", text=including("ductile/ode/ode.hpp"), engine="ode"),
    *(Source(f"program-{engine}{kind}", path=f"examples/existing_world/{engine}.cpp", engine=engine, flags=flags)
      for engine in ENGINES for kind, flags in (("", "-O2"), ("-compiled", f"-O2 {COMPILED}"))),
    Source("charpy-bullet", path="examples/charpy/runner.cpp", engine="bullet", flags="-O3 -DNDEBUG"),
    Source("charpy-ode", path="examples/charpy/runner.cpp", engine="ode", flags="-O3 -DNDEBUG -DCHARPY_ODE"),
]


def options_of():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tree", type=Path, default=Path(__file__).resolve().parent.parent, metavar="CHECKOUT")
    parser.add_argument("--label", default="after")
    parser.add_argument("--before", type=Path, metavar="CHECKOUT")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--only", default="", metavar="REGEX")
    parser.add_argument("--cxx", default="g++")
    parser.add_argument("--out", type=Path, metavar="CSV")
    options = parser.parse_args()
    if options.repeats < 1:
        parser.error(f"--repeats = {options.repeats}: must be at least 1")
    if options.before and options.label == "before":
        parser.error("--label = before: is that of --before")
    return options


def compile_once(command):
    """User CPU time [s] and peak memory [10^6 bytes] of a command and of all that it starts; None where it failed."""
    environment = os.environ | {"CCACHE_DISABLE": "1"}
    process = os.posix_spawnp(command[0], command, environment)
    _, status, usage = os.wait4(process, 0)
    if status != 0:
        print("failed: " + shlex.join(command), file=sys.stderr)
        return None
    return usage.ru_utime, usage.ru_maxrss * 1024 / 1e6


def measure(trees, options):
    """Rows, and whether any source failed; `trees`: label -> checkout, compiled in turn."""
    jobs = [source for source in SOURCES if re.search(options.only, source.name)]
    jobs = [(source, {label: tree for label, tree in trees.items() if source.there(tree)}) for source in jobs]
    compiler = output(options.cxx, "--version").splitlines()[0]
    commits = {label: output("git", "-C", tree, "describe", "--always", "--dirty", "--exclude=*")
               for label, tree in trees.items()}
    progress = Progress("compile_cost", options.repeats * sum(len(where) for _, where in jobs))
    rows = []
    with tempfile.TemporaryDirectory() as scratch:
        for source, where in jobs:
            found = {label: [] for label in where}
            for _ in range(options.repeats):
                for label, tree in where.items():
                    found[label].append(compile_once(source.command(tree, options.cxx, Path(scratch))))
                    progress.advance(1, f"{source.name}, {label}")
            for label, runs in found.items():
                if None in runs:
                    continue
                times, memory = zip(*runs)
                rows.append({"label": label, "name": source.name, "user_s": f"{statistics.median(times):.2f}",
                             "user_s_min": f"{min(times):.2f}", "rss_mb": f"{statistics.median(memory):.0f}",
                             "repeats": options.repeats, "commit": commits[label], "processor": processor(),
                             "compiler": compiler, "flags": source.flags})
    progress.finish()
    return rows, len(rows) < sum(len(where) for _, where in jobs)


def show(rows, labels):
    """Prints a line per source, the checkouts side by side; with two the ratio of the last to the first."""
    by_name = {}
    for row in rows:
        by_name.setdefault(row["name"], {})[row["label"]] = row
    heads = [f"{label + ' s':>9} {'least':>7} {'MB':>6}" for label in labels]
    ratios = [f"{'s ratio':>8} {'MB ratio':>9}"] if len(labels) == 2 else []
    print(f"{'source':<26} {'flags':<30}", *heads, *ratios)
    for name, of in by_name.items():
        cells = [f"{of[label]['user_s']:>9} {of[label]['user_s_min']:>7} {of[label]['rss_mb']:>6}"
                 if label in of else f"{'-':>9} {'-':>7} {'-':>6}" for label in labels]
        if len(labels) == 2:
            first, last = (of.get(label) for label in labels)
            both = first and last
            time, memory = (f"{float(last[c]) / float(first[c]):.2f}" if both else "-" for c in ("user_s", "rss_mb"))
            cells.append(f"{time:>8} {memory:>9}")
        print(f"{name:<26} {next(iter(of.values()))['flags']:<30}", *cells)


def append(rows, path):
    """Adds rows to a table; those of the same label and name that it has are replaced."""
    path.parent.mkdir(parents=True, exist_ok=True)
    stored = []
    if path.exists():
        with open(path, newline="") as file:
            stored = list(csv.DictReader(file))
    new = {(row["label"], row["name"]) for row in rows}
    write_rows([row for row in stored if (row["label"], row["name"]) not in new] + rows, COLUMNS, path)


def main():
    options = options_of()
    trees = {"before": options.before.resolve()} if options.before else {}
    trees[options.label] = options.tree.resolve()
    rows, failed = measure(trees, options)
    if not rows:
        sys.exit(f"--only = {options.only}: no source of this name could be compiled here")
    print(f"{rows[0]['compiler']}, {rows[0]['processor']}, median and least of {options.repeats}; "
          + ", ".join(dict.fromkeys(f"{row['label']} {row['commit']}" for row in rows)))
    show(rows, list(trees))
    if options.out:
        append(rows, options.out)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
