#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Instructions of a joint per step: instructions.py (--bin FOLDER --build FOLDER | --tree CHECKOUT) --out FOLDER

Runs the instructions program of every engine build in callgrind, prints a table and writes its rows into
instructions.csv in --out. Rows of other states stay there.

    --bin FOLDER       the programs that CMake built, with the compiler and flags of --build
    --tree CHECKOUT    a checkout of this project instead, today's or an earlier one: the bench of here is
                       compiled against the headers of that, header-only
    --state NAME       what the rows are called; default after
    --beside NAME      the state whose rows stand beside them in the last column; default before
    --only REGEX       of "engine precision joint set-up"
    --joints N         in a field; default 100
    --cxx, --flags     with --tree: compiler, default g++, and flags, default those of the release preset
    --quick            changes nothing: counts need no repeats

bodies is what the bodies alone take per joint; ours and own are what a joint takes beyond that, ours and the
engine's own for the same task; ratio is ours / own. Each is the difference of two runs of 100 and 200 steps,
on a floor of 20 and 60, so that making the field and coming to rest cancel, by joints and steps. Counts repeat to the last digit on
one machine; another compiler, other flags, another C library or a processor for which that has other functions
give others, by some per cent.

own is the engine's hinge with motor, Bullet's six springs or ODE's fixed joint; there is none for six axes in
ODE that flow. Springs and fixed joints do not flow: beside them flowing joints do more. plastic-hinge-ledger
is plastic-hinge in a World that keeps the ledger, beside a motor in the engine's own world, which keeps none.

Columns: state,commit,processor,compiler,flags,engine,precision,library,joint,own_joint,set_up,joints,bodies,ours,
own,ratio. library is header-only or compiled.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from common import Progress, cached, output, processor, stored_rows, write_rows

HERE = Path(__file__).resolve().parent
COLUMNS = ("state", "commit", "processor", "compiler", "flags", "engine", "precision", "library", "joint",
           "own_joint", "set_up", "joints", "bodies", "ours", "own", "ratio")
KEY = ("engine", "precision", "library", "joint", "set_up")
RELEASE = "-O3 -DNDEBUG -ffp-contract=off"
# program's suffix -> pkg-config's name, the adapter's folder, definitions
BUILDS = {
    "bullet-double": ("bullet-float64", "bullet", ()),
    "bullet-float": ("bullet", "bullet", ()),
    "ode-double": ("ode", "ode", ("-DBENCH_ODE",)),
}


def options_of():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--bin", type=Path, help="folder of the programs")
    source.add_argument("--tree", type=Path, help="checkout to compile against instead")
    parser.add_argument("--build", help="with --bin: CMake's build folder")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--state", default="after")
    parser.add_argument("--beside", default="before", metavar="STATE")
    parser.add_argument("--only", default="", metavar="REGEX")
    parser.add_argument("--joints", type=int, default=100)
    parser.add_argument("--cxx", default="g++")
    parser.add_argument("--flags", default=RELEASE)
    parser.add_argument("--quick", action="store_true", help="changes nothing")
    options = parser.parse_args()
    if options.bin and not options.build:
        parser.error("--bin needs --build")
    if not shutil.which("valgrind"):
        parser.error("valgrind is not installed")
    options.out.mkdir(parents=True, exist_ok=True)
    return options


def compile_against(tree, suffix, options, scratch):
    """The program of one engine build against the headers of a checkout; none where the engine is missing."""
    package, adapter, definitions = BUILDS[suffix]
    if not output("pkg-config", "--modversion", package):
        return None
    program = scratch / f"instructions-{suffix}"
    includes = [HERE, tree / "include", tree / "adapters" / adapter / "include"]
    subprocess.run([options.cxx, "-std=c++20", *options.flags.split(), *definitions,
                    *(f"-I{folder}" for folder in includes),
                    *output("pkg-config", "--cflags", package, "eigen3").split(),
                    HERE / "instructions.cpp", "-o", program,
                    *output("pkg-config", "--libs", package).split()], check=True)
    return program


def programs(options, scratch):
    """The programs that can be run, and what their rows have in common."""
    if options.tree:
        found = [compile_against(options.tree.resolve(), suffix, options, scratch) for suffix in BUILDS]
        compiler, flags, commit_of = options.cxx, options.flags, options.tree
    else:
        found = [options.bin / f"instructions-{suffix}" for suffix in BUILDS]
        compiler, common_flags, release = cached(options.build, "CMAKE_CXX_COMPILER", "CMAKE_CXX_FLAGS",
                                                 "CMAKE_CXX_FLAGS_RELEASE")
        flags = " ".join(filter(None, [common_flags, release, "-ffp-contract=off"]))
        commit_of = HERE
    commit = output("git", "-C", commit_of, "describe", "--always", "--dirty", "--exclude=*")
    common = {"state": options.state, "commit": commit, "processor": processor(),
              "compiler": output(compiler, "--version").splitlines()[0], "flags": flags}
    return [program for program in found if program and program.exists()], common


def instructions(program, joint, set_up, joints):
    """Instructions per joint and step, those of the bodies included."""
    counts, between = [], (20, 60) if set_up.startswith("floor") else (100, 200)
    for steps in between:
        run = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, joint,
                              set_up, str(joints), str(steps)], capture_output=True, text=True)
        match = re.search(r"Collected : (\d+)", run.stderr)
        if run.returncode != 0 or not match:
            sys.exit(f"{program} {joint} {set_up}: {run.stderr}")
        counts.append(int(match.group(1)))
    return (counts[1] - counts[0]) / (between[1] - between[0]) / joints


def own_joint(engine, joint, set_up):
    """The engine's own joint for the same task; empty where there is none."""
    if joint != "plastic-joint":
        return "hinge-motor"
    if engine == "bullet":
        return "spring2"
    return "" if set_up.endswith("flowing") else "fixed"


def measure(program, common, options):
    first, *listed = output(program, "--list").splitlines()
    engine, precision, library = first.split(",")
    wanted = [tuple(line.split()) for line in listed if re.search(options.only, f"{engine} {precision} {line}")]
    runs = set(wanted)
    runs |= {("bodies-only", set_up) for _, set_up in wanted}
    runs |= {(own_joint(engine, *which), which[1]) for which in wanted if own_joint(engine, *which)}
    progress = Progress(f"instructions {engine} {precision}", len(runs))
    counts = {}
    for which in sorted(runs):
        counts[which] = instructions(program, *which, options.joints)
        progress.advance(1, " ".join(which))
    progress.finish()
    rows = []
    for joint, set_up in wanted:
        bodies = counts["bodies-only", set_up]
        ours = counts[joint, set_up] - bodies
        row = common | {"engine": engine, "precision": precision, "library": library, "joint": joint,
                        "set_up": set_up, "joints": options.joints, "bodies": f"{bodies:.1f}",
                        "ours": f"{ours:.1f}"}
        if own_joint(engine, joint, set_up):
            own = counts[own_joint(engine, joint, set_up), set_up] - bodies
            row |= {"own_joint": own_joint(engine, joint, set_up), "own": f"{own:.1f}", "ratio": f"{ours / own:.3f}"}
        rows.append(row)
    return rows


def show(rows, beside, state):
    """Prints the table. `beside`: rows of the other state, by key."""
    print(f"{'engine':<14} {'library':<11} {'joint':<20} {'own joint':<11} {'set-up':<14} {'bodies':>8} {'ours':>8} "
          f"{'own':>8} {'ratio':>6} {'/ ' + state:>9}")
    for row in rows:
        other = beside.get(tuple(row[column] for column in KEY))
        change = f"{float(row['ours']) / float(other['ours']):.3f}" if other else "-"
        print(f"{row['engine'] + ' ' + row['precision']:<14} {row['library']:<11} {row['joint']:<20} "
              f"{row.get('own_joint') or '-':<11} {row['set_up']:<14} {row['bodies']:>8} {row['ours']:>8} "
              f"{row.get('own') or '-':>8} {row.get('ratio') or '-':>6} {change:>9}")


def main():
    options = options_of()
    with tempfile.TemporaryDirectory() as scratch:
        found, common = programs(options, Path(scratch))
        if not found:
            sys.exit("no program to run: none was built, or no engine is installed")
        rows = [row for program in found for row in measure(program, common, options)]
    stored = stored_rows(options.out, "instructions.csv")
    beside = {tuple(row[column] for column in KEY): row for row in stored if row["state"] == options.beside}
    print(f"{common['state']} {common['commit']}, {common['compiler']}, {common['flags']}; instructions per joint "
          f"and step, {options.joints} joints")
    show(rows, beside, options.beside)
    new = {(row["state"], *(row[column] for column in KEY)) for row in rows}
    kept = [row for row in stored if (row["state"], *(row[column] for column in KEY)) not in new]
    write_rows(kept + rows, COLUMNS, os.path.join(options.out, "instructions.csv"))


if __name__ == "__main__":
    main()
