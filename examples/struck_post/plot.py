#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws a run of struck_post: plot.py HISTORY.csv PICTURE.png"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

PANELS = (("moment_N_m", 1e-3, "moment [kN m]"), ("open_sections", 1, "open sections"),
          ("absorbed_J", 1e-3, "absorbed [kJ]"), ("tip_m", 1, "tip [m]"))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[1], newline="") as file:
        rows = list(csv.DictReader(file))
    time = [float(row["time_s"]) for row in rows]
    figure, axes = plt.subplots(len(PANELS), 1, sharex=True, figsize=(7, 7))
    for axis, (name, scale, label) in zip(axes, PANELS):
        axis.step(time, [scale * float(row[name]) for row in rows], where="pre")
        axis.set_ylabel(label)
        axis.grid(alpha=0.3)
    axes[0].set_title("A clamped post struck three times: one body but where it flows")
    axes[-1].set_xlabel("time [s]")
    figure.tight_layout()
    figure.savefig(sys.argv[2], dpi=100)


if __name__ == "__main__":
    main()
