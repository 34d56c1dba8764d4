#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Where methods fail: stability.py --bin FOLDER --build FOLDER --out FOLDER [--quick]

Runs the stability program of every engine build over its grids and writes into --out

  stability.csv   scene,engine,solver,precision,method,x_name,x,y_name,y,class,error_rel,energy_gain_rel
  stability.md    cells of ours that are wrong without saying so, first; then counts per class and method

A program that dies in a cell goes on with the next one; that cell is not-finished.
"""

import os
import subprocess
import sys
from collections import Counter, defaultdict
from concurrent.futures import ThreadPoolExecutor

from common import Progress, run_options, write_meta, write_rows
from pareto import is_ours

RUNNERS = ("stability-bullet-double", "stability-bullet-float", "stability-ode-double")
RAW = ("scene", "engine", "solver", "precision", "method", "x_name", "x", "y_name", "y", "class",
       "error_rel", "energy_gain_rel", "said", "coarse", "energy_error_rel", "steps")
COLUMNS = RAW[:12]
CLASSES = ("right", "off", "energy-gained", "jitter", "drift", "blown-up", "not-finished", "refused")


def run_job(path, options, job, cells):
    """The rows of a job, and where the program died; goes on after such a cell."""
    rows, failed, died = [], [], []
    while len(rows) < cells:
        process = subprocess.Popen([path, *options, "--job", job, "--from", str(len(rows)), *died],
                                   stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        start = len(rows)
        rows += [dict(zip(RAW, line.strip().split(","))) for line in process.stdout]
        code = process.wait()
        if code == 2:
            sys.exit(f"stability: {path} --job {job}: refused")
        if died and code < 0 and len(rows) == start:
            sys.exit(f"stability: {path} --job {job}: dies without running")
        if len(rows) < cells:
            failed.append(f"{os.path.basename(path)} {' '.join(options)} --job {job} "
                          f"--from {len(rows)}: exit {code}")
            died = ["--died"]
    return rows, failed


def run_all(folder, quick):
    """Jobs side by side, one a core: nothing here is timed."""
    options = ["--quick"] if quick else []
    plan = []
    for runner in RUNNERS:
        path = os.path.join(folder, runner)
        if not os.path.exists(path):
            print(f"stability: no {runner}", file=sys.stderr)
            continue
        listed = subprocess.run([path, *options, "--list"], capture_output=True, text=True, check=True)
        for line in listed.stdout.splitlines():
            grid, solver, method, cells = line.split()
            plan.append((path, f"{grid},{solver},{method}", int(cells)))
    # long chains cost most
    weight = lambda job, cells: cells * (8 if "cantilever" in job else 1)
    progress = Progress("stability", sum(weight(job, cells) for _, job, cells in plan))
    rows, failed = [], []
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        done = pool.map(lambda entry: run_job(entry[0], options, *entry[1:]), plan)
        for (path, job, cells), (found, deaths) in zip(plan, done):
            rows += found
            failed += deaths
            progress.advance(weight(job, cells), f"{os.path.basename(path)} {job}")
    progress.finish()
    return rows, failed


def flag(row, name):
    return row[name] == "1"


def cell_line(row):
    energy = float(row["energy_error_rel"])
    of_energy = f"{100 * energy:.2g} %" if energy >= 0 else "-"
    return (f"| {row['scene']} | {row['engine']} {row['solver']} {row['precision']} | {row['method']} | "
            f"{row['x_name']} {row['x']} | {row['y_name']} {row['y']} | {row['class']} | "
            f"{100 * float(row['error_rel']):.3g} % | {of_energy} | {row['steps']} |")


def report(rows, failed, meta):
    ours = [row for row in rows if is_ours(row["method"])]
    wrong = [row for row in ours if row["class"] not in ("right", "refused", "not-finished")]
    silent = [row for row in wrong if not flag(row, "said")]
    fine = [row for row in silent if not flag(row, "coarse")]
    coarse = [row for row in silent if flag(row, "coarse")]
    broken = [row for row in ours if row["class"] in ("energy-gained", "blown-up")]
    unsaid = sum(not flag(row, "said") for row in broken)
    head = ["| scene | engine | method | x | y | class | error | of the energy | steps |",
            "|---|---|---|---|---|---|---|---|---|"]
    lines = ["# Where methods fail", "",
             f"{meta['processor']}, {meta['compiler']}, `{meta['flags']}`, Bullet {meta['bullet']}, "
             f"ODE {meta['ode']}, {meta['date']}, {'quick' if meta['quick'] else 'full'} run.", "",
             f"## Ours, wrong without saying so: {len(fine)} of {len(ours)} cells", "",
             f"Beside these, {len(coarse)} cells whose step is a twentieth of the motion or more: an engine that "
             "moves with the velocity at the end of a step leaves travel short by v dt/2, 5 % there, with "
             "exact rows too; they are listed last.", ""]
    lines += head + [cell_line(row) for row in fine] if fine else ["None."]
    lines += ["", f"## Ours, with more energy than there was: {len(broken)}, {unsaid} of them silent", ""]
    lines += head + [cell_line(row) for row in broken] if broken else ["None."]
    lines += ["", "## Cells per class", ""]
    for engine in dict.fromkeys((r["engine"], r["solver"], r["precision"]) for r in rows):
        counts = defaultdict(Counter)
        for row in rows:
            if (row["engine"], row["solver"], row["precision"]) == engine:
                counts[row["method"]][row["class"]] += 1
        lines += [f"### {' '.join(engine)}", "", "| method | " + " | ".join(CLASSES) + " |",
                  "|---" * (len(CLASSES) + 1) + "|"]
        for method, count in counts.items():
            name = f"**{method}**" if is_ours(method) else method
            lines.append(f"| {name} | " + " | ".join(str(count[c]) for c in CLASSES) + " |")
        lines.append("")
    alarms = [row for row in ours if row["class"] == "right" and flag(row, "said")]
    lines += [f"Right cells of ours in which some step was said to be unreliable: {len(alarms)}.", "",
              "not-finished: not run, beyond the limit of work (steps × bodies³), the same for every method.", ""]
    if coarse:
        lines += ["## Ours, silent, step of a twentieth of the motion or more", ""]
        lines += head + [cell_line(row) for row in coarse]
    if failed:
        lines += ["", "## Died", ""] + [f"- {text}" for text in failed]
    return "\n".join(lines) + "\n"


def main():
    options = run_options(__doc__.splitlines()[0])
    rows, failed = run_all(options.bin, options.quick)
    write_rows(rows, COLUMNS, os.path.join(options.out, "stability.csv"), others="ignore")
    text = report(rows, failed, write_meta(options.out, options.build, quick=options.quick))
    with open(os.path.join(options.out, "stability.md"), "w") as file:
        file.write(text)
    print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
