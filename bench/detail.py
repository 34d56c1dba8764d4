#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The detail chosen by tolerance: detail.py --bin FOLDER --build FOLDER --out FOLDER [--quick]

Runs the detail program of every engine build, scene by scene, and writes into --out

  detail.csv   scene,engine,precision,tolerance,detail,chosen,joints,dt_s,error_rel,cpu_s_per_sim_s,meets,
               cost_ratio,row_steps,count_ratio,unreliable_steps
  detail.md    per scene and tolerance what was chosen, its error, its cost beside the cheapest model
               that keeps the tolerance, and the reason in the core's words; misses first

A cost ratio of 1 is the cheapest model that keeps the tolerance; up to 1.2 is what is wanted.
"""

import os
import subprocess
import sys

from common import Progress, run_options, write_meta, write_rows

RUNNERS = ("detail-bullet-double", "detail-bullet-float", "detail-ode-double")
COLUMNS = ("scene", "engine", "precision", "tolerance", "detail", "chosen", "joints", "dt_s", "error_rel",
           "cpu_s_per_sim_s", "meets", "cost_ratio", "row_steps", "count_ratio", "unreliable_steps")
WANTED = 1.2


def run_all(folder, quick):
    """Rows of every runner, the reasons by scene and tolerance, and what did not run to its end."""
    options = ["--quick"] if quick else []
    plan, reasons = [], {}
    for runner in RUNNERS:
        path = os.path.join(folder, runner)
        if not os.path.exists(path):
            print(f"detail: no {runner}", file=sys.stderr)
            continue
        listed = subprocess.run([path, "--reasons"], capture_output=True, text=True, check=True)
        for line in listed.stdout.splitlines():
            scene, tolerance, reason = line.split(",", 2)
            reasons[scene, tolerance] = reason.strip()
            if (path, scene) not in plan:
                plan.append((path, scene))
    progress = Progress("detail", len(plan))
    rows, failed = [], []
    for path, scene in plan:
        run = subprocess.run([path, *options, "--scene", scene], capture_output=True, text=True)
        rows += [dict(zip(COLUMNS, line.split(","))) for line in run.stdout.splitlines()]
        if run.returncode != 0:
            failed.append(f"{os.path.basename(path)} --scene {scene}: exit {run.returncode}")
        progress.advance(1, f"{os.path.basename(path)} {scene}")
    progress.finish()
    return rows, reasons, failed


def percent(text):
    return f"{100 * float(text):.2g} %"


def line_of(row, rows):
    """A row of the table: what was chosen, and the cheapest other model that keeps the tolerance."""
    same = [r for r in rows if all(r[c] == row[c] for c in COLUMNS[:4]) and r["meets"] == "1"]
    best = min(same, key=lambda r: float(r["cpu_s_per_sim_s"]), default=None)
    cheapest = f"{best['detail']}, {best['joints']}, {float(best['dt_s']):.2g} s" if best else "none"
    said = " (said to be unreliable)" if row["unreliable_steps"] != "0" else ""
    return (f"| {row['scene']} | {row['engine']} {row['precision']} | {percent(row['tolerance'])} | "
            f"{row['detail']}, {row['joints']}, {float(row['dt_s']):.2g} s | {percent(row['error_rel'])}{said} | "
            f"{'yes' if row['meets'] == '1' else '**no**'} | {float(row['cost_ratio']):.2f} | "
            f"{float(row['count_ratio']):.2f} | {cheapest} |")


def report(rows, reasons, failed, meta):
    chosen = [row for row in rows if row["chosen"] == "1"]
    missed = [row for row in chosen if row["meets"] != "1"]
    dear = [row for row in chosen if row["meets"] == "1" and float(row["cost_ratio"]) > WANTED]
    head = ["| scene | engine | tolerance | chosen: detail, joints, step | error | kept | cost | counted | "
            "cheapest that keeps it |", "|---|---|---|---|---|---|---|---|---|"]
    lines = ["# Detail chosen by tolerance", "",
             f"{meta['processor']}, {meta['compiler']}, `{meta['flags']}`, Bullet {meta['bullet']}, "
             f"ODE {meta['ode']}, {meta['date']}, {'quick' if meta['quick'] else 'full'} run.", "",
             "Error against the closed form of the elastic-plastic joint, or the most detailed model at a fine "
             "step. Cost: CPU time over that of the cheapest model that keeps the tolerance at its step and at "
             "every finer one; counted: the same for steps × six rows per joint, which repeats exactly. Where "
             "there is a contact, the worst of several starts within a step.", "",
             f"Kept: {len(chosen) - len(missed)} of {len(chosen)}. Cost at most {WANTED} of the cheapest: "
             f"{len(chosen) - len(missed) - len(dear)} of {len(chosen)}.", ""]
    for title, some in (("Tolerance not kept", missed), (f"Kept, at more than {WANTED} of the cost", dear)):
        lines += [f"## {title}: {len(some)}", ""]
        lines += head + [line_of(row, rows) for row in some] + [""] if some else ["None.", ""]
    lines += ["## All choices", ""] + head + [line_of(row, rows) for row in chosen]
    lines += ["", "## Reasons", ""]
    lines += [f"- {scene}, {percent(tolerance)}: {reason}" for (scene, tolerance), reason in reasons.items()]
    if failed:
        lines += ["", "## Did not run to the end", ""] + [f"- {text}" for text in failed]
    return "\n".join(lines) + "\n"


def main():
    options = run_options(__doc__.splitlines()[0])
    rows, reasons, failed = run_all(options.bin, options.quick)
    write_rows(rows, COLUMNS, os.path.join(options.out, "detail.csv"))
    text = report(rows, reasons, failed, write_meta(options.out, options.build, quick=options.quick))
    with open(os.path.join(options.out, "detail.md"), "w") as file:
        file.write(text)
    print(text)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
