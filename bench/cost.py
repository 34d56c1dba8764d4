#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What joints cost: cost.py --bin FOLDER --build FOLDER --out FOLDER [--quick]

Runs the joint_cost, scaling and structures programs of every engine build, whose tables go to the terminal,
and joins their rows into joint_cost.csv, scaling.csv and structures.csv in --out.
"""

import os
import subprocess
import tempfile

from common import Progress, run_options, write_meta

BUILDS = ("bullet-double", "bullet-float", "ode-double")


def main():
    options = run_options(__doc__.splitlines()[0])
    extra = ["--quick"] if options.quick else []
    questions = ("joint_cost", "scaling", "structures")
    progress = Progress("cost", len(questions) * len(BUILDS))
    for question in questions:
        joined = []
        for build in BUILDS:
            program = os.path.join(options.bin, f"{question}-{build}")
            if os.path.exists(program):
                with tempfile.NamedTemporaryFile("r", suffix=".csv") as file:
                    subprocess.run([program, *extra, "--csv", file.name], check=True)
                    lines = file.read().splitlines()
                joined += lines if not joined else lines[1:]
            progress.advance(1, f"{question}-{build}")
        with open(os.path.join(options.out, f"{question}.csv"), "w") as file:
            file.write("\n".join(joined) + "\n")
    progress.finish()
    write_meta(options.out, options.build, quick=options.quick)


if __name__ == "__main__":
    main()
