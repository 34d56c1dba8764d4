#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws a charpy run from its history: plot.py HISTORY.csv FOLDER

Three pictures in FOLDER: energy.png (what the hammer lost and what the joint took), rotation.png (hinge
angle) and speed.png (hammer speed), over the time after the strike.
"""

import csv
import sys
from collections import defaultdict
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

WINDOW_MS = (0.0, 8.0)
OURS = ("plastic-hinge", "elastic-plastic", "elastic-plastic-2")


def read(path):
    """Runs by (engine, precision, solver, method); each a dict of columns."""
    runs = defaultdict(lambda: defaultdict(list))
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            key = (row["engine"], row["precision"], row["solver"], row["method"])
            for name in ("time_after_strike_s", "hammer_loss_J", "plastic_work_J",
                         "nose_speed_m_per_s", "rotation_rad"):
                text = row[name]
                runs[key][name].append(float("nan") if text == "null" else float(text))
    return runs


def window(run):
    """Indices of the samples inside the time window."""
    lo, hi = (ms / 1e3 for ms in WINDOW_MS)
    return [i for i, t in enumerate(run["time_after_strike_s"]) if lo <= t <= hi]


def draw(runs, panels, title, unit, path):
    engines = sorted({key[0] for key in runs})
    figure, axes = plt.subplots(len(panels), len(engines), squeeze=False, sharex=True, sharey="row",
                                figsize=(5.2 * len(engines), 0.6 + 3.2 * len(panels)))
    methods = list(dict.fromkeys(key[3] for key in runs))
    colour = {method: f"C{i}" for i, method in enumerate(methods)}
    for column, engine in enumerate(engines):
        for row, (label, value, limits) in enumerate(panels):
            axis = axes[row][column]
            for key, run in runs.items():
                if key[0] != engine:
                    continue
                inside = window(run)
                if not inside:
                    continue
                ours = key[3] in OURS
                axis.plot([1e3 * run["time_after_strike_s"][i] for i in inside],
                          [value(run, i) for i in inside],
                          label=f"{key[3]} ({key[2]}, {key[1]})", color=colour[key[3]],
                          linewidth=2.2 if ours else 1.0, zorder=3 if ours else 2,
                          linestyle="-" if key[2] in ("mlcp", "direct") else ":")
            axis.set_ylim(*limits)
            axis.grid(alpha=0.3)
            if column == 0:
                axis.set_ylabel(f"{label} [{unit}]")
            if row == 0:
                axis.set_title(engine)
        axes[-1][column].set_xlabel("time after the strike [ms]")
        axes[0][column].legend(fontsize=6.5)
    figure.suptitle(title)
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    plt.close(figure)
    print(path)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    runs = read(sys.argv[1])
    folder = Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    column = lambda name: lambda run, i: run[name][i]
    draw(runs, [("lost by the hammer", column("hammer_loss_J"), (-10, 320)),
                ("taken by the joint", column("plastic_work_J"), (-60, 160))],
         "Charpy: energy", "J", folder / "energy.png")
    draw(runs, [("hinge angle", lambda run, i: abs(run["rotation_rad"][i]), (0, 3.2))],
         "Charpy: bend of the specimen", "rad", folder / "rotation.png")
    draw(runs, [("nose speed", column("nose_speed_m_per_s"), (-1, 6))],
         "Charpy: hammer speed", "m/s", folder / "speed.png")


if __name__ == "__main__":
    main()
