# SPDX-License-Identifier: MIT
"""What the bench's scripts share: options and tables, progress with time left, and on what a result was
measured."""

import argparse
import csv
import datetime
import gzip
import json
import os
import re
import subprocess
import sys
import time
from pathlib import Path


def run_options(description):
    """Options of a script that runs programs; makes the folder for what they find."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--bin", required=True, help="folder of the programs")
    parser.add_argument("--build", required=True, help="CMake's build folder, for the machine's description")
    parser.add_argument("--out", required=True)
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    return options


def results_folder(usage):
    """The one argument of a script that draws stored results."""
    if len(sys.argv) != 2:
        sys.exit(usage)
    return Path(sys.argv[1])


def write_rows(rows, columns, path, others="raise"):
    """A table as CSV; `others`: what becomes of entries that are no column, "raise" or "ignore"."""
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, columns, extrasaction=others, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def stored_rows(folder, table):
    """The rows of a stored table, also of one that was packed with gzip; none where it is not there."""
    path = Path(folder) / table
    packed = path.with_name(table + ".gz")
    if path.exists():
        file = open(path, newline="")
    elif packed.exists():
        file = gzip.open(packed, "rt", newline="")
    else:
        return []
    with file:
        return list(csv.DictReader(file))


class Progress:
    """Share of the work done and time left, on one line of the terminal; lines now and then elsewhere."""

    def __init__(self, name, total):
        self.name, self.total, self.done = name, max(total, 1e-9), 0.0
        self.start = self.shown = time.monotonic()
        self.terminal = sys.stderr.isatty()

    def advance(self, amount, label=""):
        self.done += amount
        now = time.monotonic()
        if now - self.shown < (0.2 if self.terminal else 15):
            return
        self.shown = now
        left = (now - self.start) * (self.total / max(self.done, 1e-9) - 1)
        text = f"{self.name}: {100 * self.done / self.total:3.0f} %, {clock(left)} left  {label}"
        print(f"\r{text:<78}" if self.terminal else text, end="" if self.terminal else "\n",
              file=sys.stderr, flush=True)

    def finish(self):
        took = clock(time.monotonic() - self.start)
        text = f"{self.name}: done in {took}"
        print(f"\r{text:<78}" if self.terminal else text, file=sys.stderr, flush=True)


def clock(seconds):
    return f"{int(seconds) // 60}:{int(seconds) % 60:02d}"


def output(*command):
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def processor():
    with open("/proc/cpuinfo") as file:
        match = re.search(r"model name\s*:\s*(.*)", file.read())
    return match.group(1).strip() if match else "unknown"


def cached(build, *names):
    """Entries of a CMake cache."""
    with open(os.path.join(build, "CMakeCache.txt")) as file:
        text = file.read()
    found = (re.search(rf"^{name}:\w+=(.*)$", text, re.M) for name in names)
    return [match.group(1).strip() if match else "" for match in found]


def write_meta(folder, build, **more):
    """meta.json: processor and how busy it was in the last 1, 5, 15 minutes, compiler, flags, engines, date."""
    compiler, flags, release = cached(build, "CMAKE_CXX_COMPILER", "CMAKE_CXX_FLAGS",
                                      "CMAKE_CXX_FLAGS_RELEASE")
    meta = {
        "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
        "processor": processor(),
        "cores": os.cpu_count(),
        "load_average": [round(load, 1) for load in os.getloadavg()],
        "compiler": output(compiler, "--version").splitlines()[0] if compiler else "unknown",
        "flags": " ".join(filter(None, [flags, release, "-ffp-contract=off"])),
        "bullet": output("pkg-config", "--modversion", "bullet"),
        "ode": output("pkg-config", "--modversion", "ode"),
        "commit": output("git", "rev-parse", "--short", "HEAD"),
    } | more
    with open(os.path.join(folder, "meta.json"), "w") as file:
        json.dump(meta, file, indent=2)
        file.write("\n")
    return meta
