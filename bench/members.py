#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What members cost and whether they are right: members.py --bin FOLDER --build FOLDER --out FOLDER

Runs the members program, whose table goes to the terminal, and stores it as members.csv in --out, with the
instructions of a step of posts that nothing strikes, counted in callgrind as the difference of 10 and 30 steps.

    --quick    fewer posts and steps
"""

import csv
import os
import re
import shutil
import subprocess
import sys
import tempfile

from common import Progress, run_options, write_rows

STEPS = (10, 30)
COUNTED = ("plain", "in-time", "ledger", "frames")


def instructions(program, scene, method, posts):
    """Of a step and post."""
    counts = []
    for steps in STEPS:
        run = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, "--count", scene,
                              method, str(posts), str(steps)], capture_output=True, text=True)
        match = re.search(r"Collected : (\d+)", run.stderr)
        if run.returncode != 0 or not match:
            sys.exit(f"{program} {scene} {method}: {run.stderr}")
        counts.append(int(match.group(1)))
    return (counts[1] - counts[0]) / (STEPS[1] - STEPS[0]) / posts


def main():
    options = run_options(__doc__.splitlines()[0])
    program = os.path.join(options.bin, "members-bullet-double")
    with tempfile.TemporaryDirectory() as scratch:
        path = os.path.join(scratch, "members.csv")
        subprocess.run([program, "--csv", path, *(["--quick"] if options.quick else [])], check=True)
        with open(path, newline="") as file:
            rows = list(csv.DictReader(file))
    columns = [*rows[0], "instructions", "instruction_ratio"]
    if shutil.which("valgrind"):
        posts = 100 if options.quick else 1000
        progress = Progress("members", 2 * len(COUNTED))
        for scene in ("standing", "clamped"):
            counts = {}
            for method in COUNTED:
                counts[method] = instructions(program, scene, method, posts)
                progress.advance(1, f"{scene} {method}")
            for row in rows:
                if row["scene"] != scene or row["method"] not in counts:
                    continue
                row["instructions"] = f"{counts[row['method']]:.1f}"
                row["instruction_ratio"] = f"{counts[row['method']] / counts['plain']:.4f}"
        progress.finish()
    write_rows(rows, columns, os.path.join(options.out, "members.csv"))


if __name__ == "__main__":
    main()
