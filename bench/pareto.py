#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Accuracy against cost: pareto.py --bin FOLDER --build FOLDER --out FOLDER [--quick]

Runs the pareto program of every engine build, joins their rows, counts instructions of the rows on the
Pareto fronts with callgrind where it is there, and writes into --out

  pareto.csv    scene,engine,solver,precision,method,dt_s,iterations,quantity,error_rel,
                cpu_s_per_sim_s,instructions
                instructions: of all steps of the run, for the rows on the front; empty elsewhere
  summary.csv   per scene and method: cost to reach 5, 1 and 0.1 %, best error at 1/60 s
  summary.md    the same to read, with where ours fall short

A method reaches a target at the coarsest step from which on every finer one of the same engine, solver,
precision and iterations stays within it; the finest alone is not enough. This keeps out errors that
happen to change sign. The cost is that of its cheapest such series.
"""

import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor

from common import Progress, run_options, write_meta, write_rows

RUNNERS = ("pareto-bullet-double", "pareto-bullet-float", "pareto-ode-double")
RAW = ("scene", "engine", "solver", "precision", "method", "dt_s", "tolerance", "iterations", "quantity",
       "error_rel", "cpu_s_per_sim_s", "yardstick_s", "steps", "unreliable_steps")
COLUMNS = ("scene", "engine", "solver", "precision", "method", "dt_s", "iterations", "quantity",
           "error_rel", "cpu_s_per_sim_s", "instructions")
# the names of bench/methods/names.hpp
OURS = ("plastic-hinge", "elastic-plastic", "plastic-joint")
ALL_METHODS = ("zero-limits", "spring", "spring2", "spring2-unlimited", "hinge-motor", "seed-account",
               "explicit-clamp") + OURS
TARGETS = (0.05, 0.01, 0.001)
GAME_STEP = 1 / 60


def joint_of(method):
    """The joint of a method, in frames or in steps."""
    return method.removesuffix("-frames")


def is_ours(method):
    return joint_of(method) in OURS


def run_job(path, options, scene, weights, progress):
    """The rows of a scene on an engine build, and its exit status."""
    process = subprocess.Popen([path, *options, "--scene", scene], stdout=subprocess.PIPE, text=True)
    rows, timed = [], 0
    for line in process.stdout:
        if line.startswith("."):
            passes = int(line[1:])
            progress.advance(weights[timed % len(weights)] / passes, f"{os.path.basename(path)} {scene}")
            timed += 1
            continue
        row = dict(zip(RAW, line.strip().split(",")))
        row["runner"] = path
        rows.append(row)
    return rows, process.wait()


def run_all(folder, quick):
    """Rows of every runner, and what did not run to its end. Scenes side by side, one a core, the longest
    first: cost is CPU time, and every scene has the same neighbours throughout."""
    options = ["--quick"] if quick else []
    plan = []  # (runner, scene, weight of its rows)
    for runner in RUNNERS:
        path = os.path.join(folder, runner)
        if not os.path.exists(path):
            print(f"pareto: no {runner}", file=sys.stderr)
            continue
        listed = subprocess.run([path, *options, "--list"], capture_output=True, text=True, check=True)
        weights = defaultdict(list)
        for line in listed.stdout.splitlines():
            fields = line.split(",")
            weights[fields[0]].append(30 + int(fields[-1]))
        plan += [(path, scene, rows) for scene, rows in weights.items()]
    progress = Progress("pareto", sum(sum(rows) for _, _, rows in plan))
    rows, failed = [], []
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        jobs = {}
        for path, scene, weights in sorted(plan, key=lambda job: -sum(job[2])):
            jobs[path, scene] = pool.submit(run_job, path, options, scene, weights, progress)
        for path, scene, _ in plan:
            found, status = jobs[path, scene].result()
            rows += found
            if status != 0:
                failed.append(f"{os.path.basename(path)} --scene {scene}: exit {status}")
    progress.finish()
    return rows, failed


def number(row, column):
    return float(row[column])


def at_usual_pace(rows):
    """Costs as they would be at the machine's median pace: by what the same steps of the engine's own took
    just before and after each run."""
    usual = {runner: statistics.median(number(r, "yardstick_s") for r in rows if r["runner"] == runner)
             for runner in {row["runner"] for row in rows}}
    for row in rows:
        pace = number(row, "yardstick_s") / usual[row["runner"]]
        row["cpu_s_per_sim_s"] = f"{number(row, 'cpu_s_per_sim_s') / pace:.6e}"


def primary(rows):
    """The first quantity of every scene, the one that pictures and summary show."""
    result = {}
    for row in rows:
        result.setdefault(row["scene"], row["quantity"])
    return result


def front(rows):
    """Rows for which none is both cheaper and better."""
    result, best = [], float("inf")
    for row in sorted(rows, key=lambda r: (number(r, "cpu_s_per_sim_s"), number(r, "error_rel"))):
        if number(row, "error_rel") < best:
            best = number(row, "error_rel")
            result.append(row)
    return result


def count_instructions(rows):
    """Fills the column instructions; callgrind collects inside the stepping function only."""
    progress = Progress("callgrind", sum(int(row["steps"]) for row in rows))
    for row in rows:
        spec = ",".join((row["solver"], row["method"], row["dt_s"], row["tolerance"], row["iterations"]))
        with tempfile.TemporaryDirectory() as scratch:
            run = subprocess.run(
                ["valgrind", "--tool=callgrind", "--toggle-collect=*bench_steps*",
                 f"--callgrind-out-file={scratch}/out", row["runner"], "--scene", row["scene"],
                 "--row", spec], capture_output=True, text=True)
        match = re.search(r"Collected : (\d+)", run.stderr)
        if match and run.returncode == 0:
            row["instructions"] = match.group(1)
        progress.advance(int(row["steps"]), row["scene"])
    progress.finish()


def reaches(series, target):
    """The row at which a series, coarsest step first, reaches a target and keeps it; None."""
    good = None
    for index in range(len(series) - 1, -1, -1):
        if not number(series[index], "error_rel") <= target:
            break
        good = index
    return series[good] if good is not None and good < len(series) - 1 else None


def summarise(rows, quantity_of):
    """One dict per scene and method."""
    chosen = [row for row in rows if row["quantity"] == quantity_of[row["scene"]]]
    series, energy = defaultdict(list), defaultdict(list)
    for row in chosen:
        frame = row["dt_s"] if number(row, "tolerance") > 0 else None  # then the tolerance is what is refined
        key = (*(row[c] for c in ("engine", "solver", "precision", "iterations")), frame)
        series[row["scene"], row["method"]].append((key, row))
    for row in rows:
        if row["quantity"] == "absorbed_energy" and abs(number(row, "dt_s") - GAME_STEP) < 1e-8:
            energy[row["scene"], row["method"]].append(number(row, "error_rel"))
    result = []
    for (scene, method), entries in series.items():
        by_key = defaultdict(list)
        for key, row in entries:
            by_key[key].append(row)
        line = {"scene": scene, "method": method, "quantity": quantity_of[scene]}
        for target in TARGETS:
            found = [reaches(sorted(s, key=lambda r: (-number(r, "tolerance"), -number(r, "dt_s"))), target)
                     for s in by_key.values()]
            best = min(filter(None, found), key=lambda r: number(r, "cpu_s_per_sim_s"), default=None)
            line[f"cost_{target:g}"] = number(best, "cpu_s_per_sim_s") if best else None
            if target == 0.01 and best:
                line["with_0.01"] = (f"{best['engine']} {best['solver']} {best['precision']}, "
                                     f"{number(best, 'dt_s'):.2g} s, {best['iterations']} iterations")
        at_game_step = [number(row, "error_rel") for _, row in entries
                        if abs(number(row, "dt_s") - GAME_STEP) < 1e-8]
        line["error_at_60Hz"] = min(at_game_step, default=None)
        line["energy_error_at_60Hz"] = min(energy[scene, method], default=None)
        result.append(line)
    return result


def cell(value, form):
    return "-" if value is None else form(value)


def cheapest(summary, column):
    """Scene -> the line of ours and of the others that is cheapest in a column of costs; None where no one
    reaches it."""
    result = {}
    for scene in dict.fromkeys(line["scene"] for line in summary):
        reached = [line for line in summary if line["scene"] == scene and line[column] not in (None, "")]
        best = lambda group: min(group, key=lambda line: number(line, column), default=None)
        result[scene] = (best([line for line in reached if is_ours(line["method"])]),
                         best([line for line in reached if not is_ours(line["method"])]))
    return result


def comparison(title, summary, cost, target=0.01):
    """What an error costs with ours and with the cheapest of the others, scene by scene; lines of a table."""
    column = f"cost_{target:g}"
    lines = [f"## {title}", "", "| scene | ours | cost | other | cost | ours / other |",
             "|---|---|---|---|---|---|"]
    for scene, (ours, other) in cheapest(summary, column).items():
        named = lambda line: (f"{line['method']} | {cost(line[column])}" if line
                              else "none reaches it | -")
        ratio = f"{ours[column] / other[column]:.2f}" if ours and other else "-"
        lines.append(f"| {scene} | {named(ours)} | {named(other)} | {ratio} |")
    return [*lines, ""]


def report(summary, of_energy, failed, meta):
    """summary.md as text."""
    scenes = list(dict.fromkeys(line["scene"] for line in summary))
    cost = lambda v: f"{v * 1e3:.3g}"
    error = lambda v: "exact" if v < 1e-9 else f"{100 * v:.2g} %"
    lines = ["# Accuracy against cost", "",
             f"{meta['processor']}, {meta['compiler']}, `{meta['flags']}`, Bullet {meta['bullet']}, "
             f"ODE {meta['ode']}, {meta['date']}, {'quick' if meta['quick'] else 'full'} run.", "",
             "Cost: CPU milliseconds per simulated second, the cheapest engine, solver, precision and "
             "iterations that reach the error and keep it at every finer step. Errors at 1/60 s: the "
             "best of all. -: never, or no account.", ""]
    for scene in scenes:
        of_scene = [line for line in summary if line["scene"] == scene]
        lines += [f"## {scene}: {of_scene[0]['quantity']}", "",
                  "| method | 5 % | 1 % | 0.1 % | error at 1/60 s | of the energy | 1 % with |",
                  "|---|---|---|---|---|---|---|"]
        for line in of_scene:
            name = f"**{line['method']}**" if is_ours(line["method"]) else line["method"]
            costs = " | ".join(cell(line[f"cost_{t:g}"], cost) for t in TARGETS)
            lines.append(f"| {name} | {costs} | {cell(line['error_at_60Hz'], error)} | "
                         f"{cell(line['energy_error_at_60Hz'], error)} | {line.get('with_0.01', '-')} |")
        lines.append("")

    lines += comparison("Ours against the cheapest other method at 1 %", summary, cost)
    lines += comparison("The same at 0.1 %", summary, cost, 0.001)
    lines += comparison("The same at 1 % of the absorbed energy, of methods that keep an account", of_energy, cost)
    present = {joint_of(line["method"]) for line in summary}
    missing = [method for method in ALL_METHODS if method not in present]
    if missing:
        lines += ["Not there yet: " + ", ".join(missing) + "."]
    if failed:
        lines += ["Did not run to the end:", ""] + [f"- {text}" for text in failed]
    return "\n".join(lines) + "\n"


def main():
    options = run_options(__doc__.splitlines()[0])

    rows, failed = run_all(options.bin, options.quick)
    at_usual_pace(rows)
    quantity_of = primary(rows)
    if not options.quick and shutil.which("valgrind"):
        fronts = [row for scene, quantity in quantity_of.items()
                  for row in front([r for r in rows if r["scene"] == scene and r["quantity"] == quantity])]
        count_instructions(fronts)
    write_rows(rows, COLUMNS, os.path.join(options.out, "pareto.csv"), others="ignore")

    summary = summarise(rows, quantity_of)
    of_energy = summarise(rows, {scene: "absorbed_energy" for scene in quantity_of})
    columns = (["scene", "method", "quantity"] + [f"cost_{t:g}" for t in TARGETS] +
               ["with_0.01", "error_at_60Hz", "energy_error_at_60Hz"])
    write_rows(summary + of_energy, columns, os.path.join(options.out, "summary.csv"))
    meta = write_meta(options.out, options.build, quick=options.quick)
    text = report(summary, of_energy, failed, meta)
    with open(os.path.join(options.out, "summary.md"), "w") as file:
        file.write(text)
    print(text)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
