#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws where methods fail: plot_stability.py bench/results/NAME

From stability.csv one picture per scene and pair of axes, stability-SCENE-X.png: a heat map per method (row)
and engine, solver and precision (column), the same colours everywhere, with the number of right cells. From
scaling.csv, where it is there, scaling.png. Nothing is run.
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.colors import BoundaryNorm, ListedColormap  # noqa: E402
from matplotlib.patches import Patch  # noqa: E402

from common import results_folder, stored_rows  # noqa: E402
from pareto import ALL_METHODS, is_ours  # noqa: E402

COLOURS = {"right": "#2a9d4a", "refused": "#6baed6", "off": "#f2c14e", "drift": "#f08a4b",
           "jitter": "#c9a0dc", "energy-gained": "#d7263d", "blown-up": "#3b0d11",
           "not-finished": "#d9d9d9"}
CLASSES = list(COLOURS)


def draw(scene, x_name, rows, path):
    columns = list(dict.fromkeys((r["engine"], r["solver"], r["precision"]) for r in rows))
    methods = [m for m in ALL_METHODS if any(r["method"] == m for r in rows)]
    xs = sorted({float(r["x"]) for r in rows})
    ys = sorted({float(r["y"]) for r in rows})
    colours = ListedColormap(list(COLOURS.values()))
    norm = BoundaryNorm([i - 0.5 for i in range(len(CLASSES) + 1)], len(CLASSES))
    figure, axes = plt.subplots(len(methods), len(columns), squeeze=False, sharex=True, sharey=True,
                                figsize=(1.2 + 1.9 * len(columns), 1.1 + 1.35 * len(methods)))
    for i, method in enumerate(methods):
        for j, column in enumerate(columns):
            axis = axes[i][j]
            cells = [r for r in rows if r["method"] == method
                     and (r["engine"], r["solver"], r["precision"]) == column]
            grid = [[float("nan")] * len(xs) for _ in ys]
            for r in cells:
                grid[ys.index(float(r["y"]))][xs.index(float(r["x"]))] = CLASSES.index(r["class"])
            axis.imshow(grid, cmap=colours, norm=norm, origin="lower", aspect="auto",
                        interpolation="nearest")
            right = sum(r["class"] == "right" for r in cells)
            axis.set_title(f"{right} of {len(cells)} right" if cells else "not there", fontsize=7, pad=2)
            every = max(1, len(xs) // 4)
            unit, name = (1e3, "step [ms]") if x_name == "step_s" else (1, x_name)
            axis.set_xticks(range(0, len(xs), every), [f"{unit * x:.3g}" for x in xs[::every]], fontsize=6)
            axis.set_yticks(range(len(ys)), [f"{y:.3g}" for y in ys], fontsize=6)
            if j == 0:
                axis.set_ylabel(method, fontsize=8, fontweight="bold" if is_ours(method) else "normal")
            if i == 0:
                axis.annotate(" ".join(column), (0.5, 1.25), xycoords="axes fraction", ha="center",
                              fontsize=8)
            if i == len(methods) - 1:
                axis.set_xlabel(name, fontsize=7)
    figure.suptitle(f"{scene}: {rows[0]['y_name']} over {x_name}", fontsize=10)
    figure.legend(handles=[Patch(color=COLOURS[c], label=c) for c in CLASSES], ncol=len(CLASSES),
                  fontsize=7, loc="lower center", frameon=False, columnspacing=1, handlelength=1)
    figure.tight_layout(rect=(0, 0.03, 1, 0.98))
    figure.savefig(path, dpi=110)
    plt.close(figure)
    print(path)


def draw_scaling(rows, path):
    builds = list(dict.fromkeys((r["engine"], r["precision"]) for r in rows))
    figure, axes = plt.subplots(1, len(builds), squeeze=False, sharey=True, figsize=(4.2 * len(builds), 4))
    styles = {"0": ":", "0.01": "--", "1": "-"}
    colours = {"bodies-only": "grey", "hinge-motor": "teal", "plastic-hinge": "crimson",
               "plastic-joint": "navy"}
    for axis, build in zip(axes[0], builds):
        series = {}
        for r in rows:
            if (r["engine"], r["precision"]) == build:
                key = (r["method"], r["yielding"], r["split_islands"])
                series.setdefault(key, []).append((int(r["joints"]), float(r["ns_per_joint_step"])))
        for (method, yielding, split), points in series.items():
            axis.plot(*zip(*points), styles[yielding], color=colours[method], linewidth=1.2,
                      marker="o" if split == "1" else "s", markersize=3,
                      label=f"{method}, {100 * float(yielding):g} % yield"
                            + ("" if split == "1" else ", islands not split"))
        axis.set(xscale="log", yscale="log", xlabel="joints, in pairs of bodies", title=" ".join(build))
        axis.grid(alpha=0.3)
        axis.legend(fontsize=5.5)
    axes[0][0].set_ylabel("ns per joint and step, bodies included")
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    plt.close(figure)
    print(path)


def main():
    folder = results_folder(__doc__)
    rows = stored_rows(folder, "stability.csv")
    for scene, x_name in dict.fromkeys((r["scene"], r["x_name"]) for r in rows):
        chosen = [r for r in rows if (r["scene"], r["x_name"]) == (scene, x_name)]
        draw(scene, x_name, chosen, folder / f"stability-{scene}-{x_name.removesuffix('_s')}.png")
    if scaling := stored_rows(folder, "scaling.csv"):
        draw_scaling(scaling, folder / "scaling.png")


if __name__ == "__main__":
    main()
