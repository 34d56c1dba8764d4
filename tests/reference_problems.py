#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks that the reference problems which sources name are stated: reference_problems.py REPOSITORY

Every Pxx or Pxxa in a source must be a section "## Pxx: ..." of tests/reference/README.md, with a case "(a)"
where a letter follows; every section must be named by some source and name at least one file, and every file
it names must exist.
"""

import re
import sys
from pathlib import Path

FOLDERS = ("include", "adapters", "tests", "bench", "examples")
SUFFIXES = {".hpp", ".cpp", ".ipp", ".py", ".sh", ".md", ".txt"}
README = Path("tests/reference/README.md")


def sources(root):
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            where = path.relative_to(root)
            if path.suffix in SUFFIXES and where != README and not {"results", "out"} & set(where.parts):
                yield where, path.read_text()


def main():
    root = Path(sys.argv[1])
    stated = dict(re.findall(r"^## P(\d\d): .*\n((?:(?!## ).*\n)*)", (root / README).read_text(), re.M))
    errors, named = [], set()
    for where, text in sources(root):
        for line, words in enumerate(text.splitlines(), 1):
            if "REFERENCE" + " P" in words:
                errors.append(f"{where}:{line}: REFERENCE is not in the repository; say tests/reference")
            for problem, case in re.findall(r"\bP(\d\d)([a-z]?)\b", words):
                named.add(problem)
                if problem not in stated:
                    errors.append(f"{where}:{line}: {README} does not state P{problem}")
                elif case and f"({case})" not in stated[problem]:
                    errors.append(f"{where}:{line}: P{problem} in {README} has no case ({case})")
    for problem, text in stated.items():
        files = re.findall(r"`([\w/.]+/[\w.]+\.\w+)`", text)
        if problem not in named:
            errors.append(f"{README}: no source names P{problem}")
        if not files:
            errors.append(f"{README}: P{problem} names no file that checks it")
        errors += [f"{README}: P{problem} names {file}, which does not exist" for file in files
                   if not (root / file).is_file()]
    print("\n".join(errors) if errors else f"{len(stated)} reference problems stated and named")
    sys.exit(bool(errors))


if __name__ == "__main__":
    main()
