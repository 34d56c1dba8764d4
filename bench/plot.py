#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws stored results: plot.py bench/results/NAME

From pareto.csv one picture per scene, pareto-SCENE.png: error over cost, both logarithmic, with the Pareto
front drawn and our points filled and large. From detail.csv, where it is there, detail.png: per scene the models
at each tolerance, the chosen one large. From scaling.csv scaling.png, from frames.csv frames.png and
frames-tolerance.png. Nothing is run.
"""

from collections import defaultdict

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from common import results_folder, stored_rows  # noqa: E402
from frames import draw as draw_frames  # noqa: E402
from pareto import ALL_METHODS, front, is_ours, joint_of, number, primary  # noqa: E402

BEST, WORST = 1e-9, 10.0  # errors beyond are drawn at the rim
OUR_COLOURS = {"plastic-hinge": "crimson", "elastic-plastic": "darkorange", "plastic-joint": "navy"}
MARKERS = {("bullet", "double"): "o", ("bullet", "float"): "^", ("ode", "double"): "s"}
STEPS = {"-frames": "D"}  # whatever the engine


def shown(row):
    error = number(row, "error_rel")
    return min(max(error, BEST), WORST) if error == error else WORST


def draw_scene(scene, quantity, rows, path):
    figure, axis = plt.subplots(figsize=(10, 5.6))
    colours = plt.get_cmap("Set2").colors
    colour = {method: colours[i % len(colours)] for i, method in enumerate(ALL_METHODS)} | OUR_COLOURS
    groups = defaultdict(list)
    for row in rows:
        groups[row["method"], row["engine"], row["precision"]].append(row)
    named = set()
    order = sorted(groups.items(), key=lambda item: (is_ours(item[0][0]), item[0]))
    for (method, engine, precision), points in order:
        ours = is_ours(method)
        marker = next((m for suffix, m in STEPS.items() if method.endswith(suffix)),
                      MARKERS.get((engine, precision), "x"))
        axis.plot([number(r, "cpu_s_per_sim_s") for r in points], [shown(r) for r in points],
                  linestyle="", marker=marker,
                  markersize=6.5 if ours else 4, alpha=0.8,
                  color=colour[joint_of(method)], fillstyle="full",
                  markeredgecolor="white", markeredgewidth=0.5, zorder=4 if ours else 2,
                  label=None if method in named else method)
        named.add(method)
    best = front(rows)
    axis.step([number(r, "cpu_s_per_sim_s") for r in best], [shown(r) for r in best], where="post",
              color="black", linewidth=1.2, zorder=3, label="Pareto front")
    for target in (0.05, 0.01, 0.001):
        axis.axhline(target, color="grey", linewidth=0.6, linestyle=":", zorder=1)
        axis.text(1.0, target, f" {100 * target:g} %", transform=axis.get_yaxis_transform(), fontsize=8,
                  va="center", color="grey")
    lowest = min(map(shown, rows))
    axis.set(xscale="log", yscale="log", ylim=(lowest / 3, 3 * WORST),
             xlabel="CPU seconds per simulated second", ylabel=f"relative error of {quantity}",
             title=f"{scene}: accuracy against cost\n"
                   "circle Bullet double, triangle Bullet float, square ODE, diamond frames with a tolerance; "
                   "large: ours; rims: exact, or worse than 1000 %")
    axis.title.set_fontsize(9)
    axis.grid(alpha=0.25, which="major")
    axis.legend(fontsize=7.5, loc="upper left", bbox_to_anchor=(1.07, 1))
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    plt.close(figure)
    print(path)


def draw_detail(rows, path):
    """Error over cost of every model at the step that keeps a tolerance; a colour per tolerance."""
    scenes = list(dict.fromkeys(r["scene"] for r in rows))
    figure, axes = plt.subplots(3, (len(scenes) + 2) // 3, squeeze=False, figsize=(11, 9))
    for axis in axes.flat[len(scenes):]:
        axis.set_axis_off()
    tolerances = sorted({float(r["tolerance"]) for r in rows}, reverse=True)
    for axis, scene in zip(axes.flat, scenes):
        for tolerance, colour in zip(tolerances, ("crimson", "darkorange", "navy")):
            axis.axhline(tolerance, color=colour, linewidth=0.8, linestyle=":")
            for engine, precision in MARKERS:
                some = [r for r in rows if (r["scene"], r["engine"], r["precision"]) ==
                        (scene, engine, precision) and float(r["tolerance"]) == tolerance]
                for is_chosen, size, alpha in (("0", 3, 0.45), ("1", 9, 0.9)):
                    points = [r for r in some if r["chosen"] == is_chosen]
                    axis.plot([number(r, "cpu_s_per_sim_s") for r in points], [shown(r) for r in points],
                              linestyle="", marker=MARKERS[engine, precision], markersize=size, alpha=alpha,
                              color=colour, markeredgecolor="white", markeredgewidth=0.4)
        axis.set(xscale="log", yscale="log", title=scene)
        axis.title.set_fontsize(9)
        axis.tick_params(which="both", labelsize=6)
        axis.grid(alpha=0.25, which="major")
    for axis in axes[-1]:
        axis.set_xlabel("CPU seconds per simulated second", fontsize=8)
    for axis in axes[:, 0]:
        axis.set_ylabel("relative error", fontsize=8)
    figure.suptitle("Models at the longest step that keeps 10 % (red), 3 % (orange), 1 % (blue); large: chosen by "
                    "the core\ncircle Bullet double, triangle Bullet float, square ODE; beyond their line: "
                    "models that never keep it", fontsize=9)
    figure.tight_layout()
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
    rows = stored_rows(folder, "pareto.csv")
    for scene, quantity in primary(rows).items():
        chosen = [r for r in rows if r["scene"] == scene and r["quantity"] == quantity]
        draw_scene(scene, quantity, chosen, folder / f"pareto-{scene}.png")
    if detail := stored_rows(folder, "detail.csv"):
        draw_detail(detail, folder / "detail.png")
    if scaling := stored_rows(folder, "scaling.csv"):
        draw_scaling(scaling, folder / "scaling.png")
    if cells := stored_rows(folder, "frames.csv"):
        draw_frames(folder, cells)


if __name__ == "__main__":
    main()
