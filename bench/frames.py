#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What a user gets for a frame: frames.py --bin FOLDER --build FOLDER --out FOLDER [--quick]

Runs the frames program of every engine build that has it and writes into --out

  frames.csv     the rows of frames.cpp, packed with gzip; --quick: ours alone, peers as they are stored there
  frames.md      cells that are right, ours and the peers', and what that costs
  frames.png, frames-tolerance.png

A peer is right at the smallest number of equal parts a frame at which, and at the next two doublings of which, it
is: a number that nobody knows beforehand. Ours are given the frame and the tolerance.
"""

import gzip
import os
import statistics
import subprocess
import sys
from collections import defaultdict

from common import Progress, run_options, stored_rows, write_meta, write_rows

RUNNERS = ("frames-bullet-double", "frames-bullet-float", "frames-ode-double")
BUILDS = (("bullet", "double"), ("bullet", "float"), ("ode", "double"))
COLUMNS = ("scene", "engine", "precision", "y_name", "y", "frame_s", "method", "solver", "tolerance", "parts",
           "error_rel", "energy_error_rel", "believed", "left_rel", "energy_gain_rel", "solves", "rejected",
           "worst_frame", "cpu_s")
TOLERANCES = ("0.1", "0.01", "0.001")
USUAL = "0.01"
PEERS = ("hinge-motor", "explicit-clamp")
TARGETS = (0.05, 0.01)
GAIN = 1e-4  # of the scene's energy: beyond what rounding of float gives
DEAR = 1.5


def number(row, column):
    return float(row[column])


def run_all(folder, quick):
    plan = []
    for runner in RUNNERS:
        path = os.path.join(folder, runner)
        plan += [[path, "--method", "ours", "--tolerance", tolerance] for tolerance in TOLERANCES]
        if not quick and runner == RUNNERS[0]:
            plan += [[path, "--method", peer] for peer in PEERS]
    progress = Progress("frames", len(plan))
    rows = []
    for command in plan:
        run = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
        rows += [dict(zip(COLUMNS, line.split(","))) for line in run.stdout.splitlines()]
        progress.advance(1, " ".join(command[1:]))
    progress.finish()
    return rows


def of_build(rows, build):
    return [row for row in rows if (row["engine"], row["precision"]) == build]


def cells(rows, build):
    """Cell -> its row of ours, and the series of each peer and solver, coarsest first."""
    ours, peers = {}, defaultdict(lambda: defaultdict(list))
    for row in of_build(rows, build):
        cell = (row["scene"], row["y"], row["frame_s"])
        if row["method"] == "ours":
            if row["tolerance"] == USUAL:
                ours[cell] = row
        else:
            peers[cell][row["method"], row["solver"]].append(row)
    return ours, peers


def right(row, target):
    return number(row, "error_rel") <= target


def first_right(series, target):
    """The row from which on a series is right, three times on end; None."""
    series = sorted(series, key=lambda row: int(row["parts"]))
    for i in range(len(series) - 2):
        if all(right(row, target) for row in series[i:i + 3]):
            return series[i]
    return None


def cheapest(peers, target, column):
    found = [row for series in peers.values() if (row := first_right(series, target))]
    return min(found, key=lambda row: number(row, column), default=None)


def plain(peers, method, target):
    """Whether a peer is right with the frame as its step, by any solver."""
    return any(right(row, target) for (name, _), series in peers.items() if name == method
               for row in series if row["parts"] == "1")


def table(head, lines):
    return ["| " + " | ".join(map(str, line)) + " |" for line in (head, ["---"] * len(head), *lines)]


def right_table(ours, peers):
    by_scene = defaultdict(list)
    for cell in ours:
        by_scene[cell[0]].append(cell)
    by_scene["all"] = list(ours)
    lines = []
    for scene, group in by_scene.items():
        count = lambda what: sum(map(bool, map(what, group)))
        mine = lambda cell: right(ours[cell], 0.05)
        theirs = lambda cell: any(plain(peers[cell], peer, 0.05) for peer in PEERS)
        said = lambda cell: ours[cell]["believed"] == "0"
        lines.append([scene, len(group), count(mine), count(lambda c: right(ours[c], 0.01)),
                      *[count(lambda c: plain(peers[c], peer, target)) for peer in PEERS for target in TARGETS],
                      count(lambda c: mine(c) and not theirs(c)), count(lambda c: theirs(c) and not mine(c)),
                      count(lambda c: mine(c) and theirs(c)), count(lambda c: not mine(c) and not theirs(c)),
                      count(lambda c: not mine(c) and not said(c)), count(lambda c: mine(c) and said(c)),
                      count(lambda c: number(ours[c], "energy_gain_rel") > GAIN)])
    return table(["scene", "cells", "ours, 5 %", "1 %", "motor, 5 %", "1 %", "clamp, 5 %", "1 %", "ours only",
                  "a peer only", "both", "neither", "ours wrong, unsaid", "false alarms", "energy gained"], lines)


def ratios(ours, peers, target, column):
    """Cell -> ours over the cheapest peer, where both are right."""
    result = {}
    for cell, row in ours.items():
        peer = cheapest(peers[cell], target, column)
        if peer and right(row, target):
            result[cell] = number(row, column) / number(peer, column)
    return result


def cost_table(ours, peers):
    lines = []
    scenes = list(dict.fromkeys(cell[0] for cell in ours))
    of = {(target, column): ratios(ours, peers, target, column) for target in TARGETS
          for column in ("solves", "cpu_s")}
    for scene in [*scenes, "all"]:
        line = [scene]
        for target in TARGETS:
            found = [cheapest(peers[cell], target, "solves") for cell in ours if scene in (cell[0], "all")]
            parts = [int(row["parts"]) for row in found if row]
            line.append(f"{statistics.median(parts):g}, {max(parts)}" if parts else "-")
            for column in ("solves", "cpu_s"):
                values = [v for cell, v in of[target, column].items() if scene in (cell[0], "all")]
                dear = sum(v > DEAR for v in values)
                line.append(f"{statistics.median(values):.2f}, {dear} of {len(values)}" if values else "-")
        lines.append(line)
    head = ["scene"]
    for target in TARGETS:
        head += [f"peer's parts at {100 * target:g} %", "ours / peer: solves", "time"]
    return table(head, lines)


def doubled(series, tolerance):
    """Error, solves and time of a peer whose parts are doubled until the answer changes by no more than the
    tolerance, all runs paid for; errors taken to be on one side. None: it never ends."""
    series = sorted(series, key=lambda row: int(row["parts"]))
    for i in range(1, len(series)):
        if abs(number(series[i], "error_rel") - number(series[i - 1], "error_rel")) <= tolerance:
            paid = series[:i + 1]
            return (number(series[i], "error_rel"), sum(number(row, "solves") for row in paid),
                    sum(number(row, "cpu_s") for row in paid))
    return None


def doubled_table(ours, peers, tolerance):
    """Peers that choose their parts by doubling, each by whichever solver is nearer."""
    lines = []
    for peer in PEERS:
        found, over = {}, {"solves": [], "cpu_s": []}
        for cell in ours:
            ends = [end for (name, _), series in peers[cell].items() if name == peer
                    if (end := doubled(series, tolerance))]
            if ends:
                found[cell] = min(ends)
        for cell, (error, solves, time) in found.items():
            if error <= 0.05:
                over["solves"].append(number(ours[cell], "solves") / solves)
                over["cpu_s"].append(number(ours[cell], "cpu_s") / time)
        lines.append([peer, sum(any(name == peer for name, _ in peers[cell]) for cell in ours), len(found),
                      *[sum(error <= target for error, *_ in found.values()) for target in TARGETS],
                      sum(error > 0.05 for error, *_ in found.values()),
                      *[f"{statistics.median(values):.2f}, {sum(v > DEAR for v in values)} of {len(values)}"
                        for values in over.values()]])
    return table(["peer", "cells", "ends", "within 5 %", "1 %", "wrong, unsaid", "ours / peer: solves", "time"],
                 lines)


def dear_cells(ours, peers):
    lines = []
    for target in TARGETS:
        for column, name in (("solves", "solves"), ("cpu_s", "time")):
            found = ratios(ours, peers, target, column)
            named = defaultdict(list)
            for (scene, y, frame), value in found.items():
                if value > DEAR:
                    named[scene].append(f"{float(y):g} at 1/{1 / float(frame):.0f} s: {value:.1f}")
            lines += [f"{name} at {100 * target:g} %: " + ("; ".join(
                f"{scene} ({', '.join(items)})" for scene, items in named.items()) or "none") + ".", ""]
    return lines


def tolerance_table(rows):
    lines = []
    for build in BUILDS:
        for tolerance in TOLERANCES:
            group = [row for row in of_build(rows, build)
                     if row["method"] == "ours" and row["tolerance"] == tolerance]
            if not group:
                continue
            allowed = max(0.05, float(tolerance))
            moving = [row for row in group if row["scene"] != "still-cantilever"]
            errors = sorted(number(row, "error_rel") for row in moving)
            lines.append([" ".join(build), f"{100 * float(tolerance):g} %", len(group),
                          *[sum(right(row, target) for row in group) for target in TARGETS],
                          f"{100 * statistics.mean(errors):.2g} %", f"{100 * errors[-1]:.2g} %",
                          sum(int(row["solves"]) for row in group),
                          sum(not right(row, allowed) and row["believed"] == "1" for row in group),
                          sum(right(row, allowed) and row["believed"] == "0" for row in group),
                          sum(number(row, "energy_gain_rel") > GAIN for row in group)])
    return table(["engine", "tolerance", "cells", "within 5 %", "1 %", "mean error", "largest", "solves",
                  "wrong, unsaid", "false alarms", "energy gained"], lines)


def report(rows, meta):
    ours, peers = cells(rows, BUILDS[0])
    return "\n".join([
        "# What a frame gives", "",
        f"{meta['processor']}, {meta['compiler']}, `{meta['flags']}`, Bullet {meta['bullet']}, {meta['date']}.", "",
        "## Cells that are right", "", *right_table(ours, peers), "",
        "## Cost beside the cheapest peer that is right", "", *cost_table(ours, peers), "",
        "## Peers that double their parts until 1 % is kept", "", *doubled_table(ours, peers, float(USUAL)), "",
        "## Cells dearer than 1.5", "", *dear_cells(ours, peers),
        "## Tolerance", "", *tolerance_table(rows), ""])


def draw(folder, rows):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    ours, peers = cells(rows, BUILDS[0])
    scenes = list(dict.fromkeys(cell[0] for cell in ours))
    rank = lambda error: 0 if error <= 0.01 else 1 if error <= 0.05 else 2
    colours = matplotlib.colors.ListedColormap(["#2a9d4a", "#b8dba0", "#d7263d"])
    kinds = ["ours", *PEERS]
    figure, axes = plt.subplots(len(kinds), len(scenes), figsize=(1.6 * len(scenes), 4.6), squeeze=False)
    for i, kind in enumerate(kinds):
        for j, scene in enumerate(scenes):
            group = [cell for cell in ours if cell[0] == scene]
            ys = sorted({float(cell[1]) for cell in group})
            frames = sorted({float(cell[2]) for cell in group})
            grid = [[float("nan")] * len(frames) for _ in ys]
            for cell in group:
                errors = ([number(ours[cell], "error_rel")] if kind == "ours" else
                          [number(row, "error_rel") for (name, _), series in peers[cell].items() if name == kind
                           for row in series if row["parts"] == "1"])
                if errors:
                    grid[ys.index(float(cell[1]))][frames.index(float(cell[2]))] = rank(min(errors))
            axis = axes[i][j]
            axis.imshow(grid, cmap=colours, vmin=0, vmax=2, origin="lower", aspect="auto")
            axis.set_xticks(range(len(frames)), [f"1/{1 / f:.0f}" for f in frames], fontsize=6)
            axis.set_yticks(range(len(ys)), [f"{y:.3g}" for y in ys], fontsize=6)
            if i == 0:
                axis.set_title(scene, fontsize=7)
            if j == 0:
                axis.set_ylabel(kind if kind == "ours" else f"{kind},\na step a frame", fontsize=8)
    figure.suptitle("Bullet, given a frame [s]: within 1 % (dark), 5 % (light), wrong (red)", fontsize=9)
    figure.tight_layout()
    figure.savefig(os.path.join(folder, "frames.png"), dpi=110)
    plt.close(figure)

    figure, axis = plt.subplots(figsize=(6, 4))
    for scene in scenes:
        points = []
        for tolerance in TOLERANCES:
            group = [row for row in of_build(rows, BUILDS[0]) if row["scene"] == scene
                     and row["method"] == "ours" and row["tolerance"] == tolerance]
            error = statistics.mean(number(row, "error_rel") for row in group)
            points.append((sum(int(row["solves"]) for row in group) / len(group), 100 * max(error, 1e-6)))
        axis.plot(*zip(*points), marker="o", markersize=4, label=scene)
    axis.set(xscale="log", yscale="log", xlabel="solves of a run, mean", ylabel="mean error [%]",
             title="Tolerance 10, 1, 0.1 %, left to right")
    axis.grid(alpha=0.3)
    axis.legend(fontsize=6)
    figure.tight_layout()
    figure.savefig(os.path.join(folder, "frames-tolerance.png"), dpi=110)
    plt.close(figure)


def write(folder, rows, meta):
    path = os.path.join(folder, "frames.csv")
    write_rows(rows, COLUMNS, path)
    with open(path, "rb") as plain_file, open(path + ".gz", "wb") as packed:
        packed.write(gzip.compress(plain_file.read(), mtime=0))
    os.remove(path)
    text = report(rows, meta)
    with open(os.path.join(folder, "frames.md"), "w") as file:
        file.write(text)
    print(text)
    draw(folder, stored_rows(folder, "frames.csv"))


def main():
    options = run_options(__doc__.splitlines()[0])
    rows = run_all(options.bin, options.quick)
    if options.quick and os.path.exists(os.path.join(options.out, "frames.csv.gz")):
        rows += [row for row in stored_rows(options.out, "frames.csv") if row["method"] in PEERS]
    write(options.out, rows, write_meta(options.out, options.build, quick=options.quick))
    return 0


if __name__ == "__main__":
    sys.exit(main())
