#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Compares two stored results: compare.py bench/results/A bench/results/B

Every accuracy column of pareto.csv, frames.csv and detail.csv must be the same to the last digit. Costs are
compared as ratios to the median row of their own scene, engine and precision, and as the ratios ours / other
of the summary: a machine that is faster as a whole does not count. Exit status 1 where an error differs; the
spread of the costs is printed.
"""

import statistics
import sys
from collections import defaultdict

from common import stored_rows
from pareto import TARGETS, cheapest

# table -> columns that name a row, columns that must repeat; all cost columns but these vary
TABLES = {
    "pareto.csv": (("scene", "engine", "solver", "precision", "method", "dt_s", "iterations", "quantity"),
                   ("error_rel",)),
    "frames.csv": (("scene", "engine", "precision", "y", "frame_s", "method", "solver", "tolerance", "parts"),
                   ("error_rel", "energy_error_rel", "believed", "solves")),
    "detail.csv": (("scene", "engine", "precision", "tolerance", "detail", "chosen", "joints"),
                   ("dt_s", "error_rel", "meets", "row_steps", "count_ratio", "unreliable_steps")),
}
COST = "cpu_s_per_sim_s"


def read(folder, table, key):
    return {tuple(row[c] for c in key): row for row in stored_rows(folder, table)} or None


def compare(table, key, columns, first, second):
    """True where both runs have the same rows with the same accuracy."""
    a, b = read(first, table, key), read(second, table, key)
    if a is None and b is None:
        return True
    if a is None or b is None:
        print(f"{table}: in one only")
        return False
    common = a.keys() & b.keys()
    only = set(a) ^ set(b)
    differ = [k for k in common if any(a[k][c] != b[k][c] for c in columns)]
    for k in sorted(differ)[:20]:
        print(",".join(k), *(f"{c} {a[k][c]} {b[k][c]}" for c in columns if a[k][c] != b[k][c]))
    print(f"{table}: {len(a)} and {len(b)} rows, {len(only)} in one only, {len(differ)} that differ")
    ratios = defaultdict(list)  # of the rows that ran after one another
    for k in common:
        if COST in a[k] and 0 < float(b[k][COST]) < float("inf"):
            side_by_side = tuple(a[k][c] for c in ("scene", "engine", "precision"))
            ratios[side_by_side].append(float(a[k][COST]) / float(b[k][COST]))
    if ratios:
        spread = [r / statistics.median(group) for group in ratios.values() for r in group]
        within = sum(abs(r - 1) <= 0.15 for r in spread) / len(spread)
        print(f"{table}: costs: {100 * within:.1f} % of rows within 15 % of the median of their scene")
    return not only and not differ


def compare_summaries(first, second):
    """Prints how far the ratios of cost, ours / other, of two runs differ."""
    def ratios(folder):
        summary, result = stored_rows(folder, "summary.csv"), {}
        scenes = {line["scene"]: line["quantity"] for line in reversed(summary)}  # the first quantity
        parts = {"": [line for line in summary if line["quantity"] == scenes[line["scene"]]],
                 "energy ": [line for line in summary if line["quantity"] == "absorbed_energy"]}
        for part, lines in parts.items():
            for target in TARGETS:
                column = f"cost_{target:g}"
                for scene, (ours, other) in cheapest(lines, column).items():
                    if ours and other:
                        result[scene, part + column] = float(ours[column]) / float(other[column])
        return result
    a, b = ratios(first), ratios(second)
    differ = {k: a[k] / b[k] for k in a.keys() & b.keys()}
    far = {k: d for k, d in differ.items() if abs(d - 1) > 0.15}
    for k, d in sorted(far.items(), key=lambda entry: -abs(entry[1] - 1)):
        print(" ".join(k), f"ours / other {a[k]:.3g} and {b[k]:.3g}")
    print(f"summary.csv: {len(differ) - len(far)} of {len(differ)} ratios within 15 %")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    same = [compare(table, *columns, *sys.argv[1:]) for table, columns in TABLES.items()]
    compare_summaries(*sys.argv[1:])
    return 0 if all(same) else 1


if __name__ == "__main__":
    sys.exit(main())
