#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Compares two stored results: compare.py bench/results/A bench/results/B

Every accuracy column must be the same to the last digit. Costs are compared as ratios to the median row of
their own run, so that a machine that is faster as a whole does not count. Exit status 1 where an error
differs; the spread of the costs is printed.
"""

import csv
import statistics
import sys
from pathlib import Path

KEY = ("scene", "engine", "solver", "precision", "method", "dt_s", "iterations", "quantity")


def read(folder):
    with open(Path(folder) / "pareto.csv", newline="") as file:
        return {tuple(row[c] for c in KEY): row for row in csv.DictReader(file)}


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    a, b = read(sys.argv[1]), read(sys.argv[2])
    only = set(a) ^ set(b)
    differ = [key for key in a.keys() & b.keys() if a[key]["error_rel"] != b[key]["error_rel"]]
    for key in sorted(differ)[:20]:
        print(",".join(key), a[key]["error_rel"], b[key]["error_rel"])
    print(f"{len(a)} and {len(b)} rows, {len(only)} in one only, {len(differ)} with another error")
    ratios = [float(a[key]["cpu_s_per_sim_s"]) / float(b[key]["cpu_s_per_sim_s"])
              for key in a.keys() & b.keys()]
    if ratios:
        middle = statistics.median(ratios)
        within = sum(abs(r / middle - 1) <= 0.15 for r in ratios) / len(ratios)
        print(f"costs: median ratio {middle:.3f}, {100 * within:.1f} % of rows within 15 % of it")
    return 1 if only or differ else 0


if __name__ == "__main__":
    sys.exit(main())
