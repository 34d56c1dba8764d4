#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks the figures of the READMEs against the stored files they are from: readme_figures.py REPOSITORY [--write]

A comment names a file and one of the rules of stored_tables.py, perhaps with an argument:

    <!-- from bench/results/amd-epyc/summary.md: section "The same at 0.1 %" -->

The table or fenced text that follows has to be what the rule makes of the file; --write puts that in its place. In a
paragraph that follows, each of the figures that the rule gives has to stand.
"""

import re
import sys
from pathlib import Path

import stored_tables

COMMENT = re.compile(r'<!-- from (\S+): (\w+)(?: "([^"]*)")? -->\n')
ANY_COMMENT = re.compile(r"^<!-- from ", re.M)


def check(root, readme, write):
    """What is wrong in a README, and how many blocks it has that are checked."""
    text, wrong = readme.read_text(), []
    comments = list(COMMENT.finditer(text))
    if len(comments) != len(ANY_COMMENT.findall(text)):
        wrong.append(f"{readme}: a comment that begins with 'from' is not of the form FILE: RULE \"ARGUMENT\"")
    for comment in reversed(comments):  # so that what is written moves no place that is still to come
        file, rule, argument = comment.groups()
        expected = getattr(stored_tables, rule)(root / file, *filter(None, [argument]))
        block = stored_tables.BLOCK.match(text, comment.end())
        if isinstance(expected, list):
            missing = [str(figure) for figure in expected if not re.search(rf"\b{figure}\b", block.group())]
            wrong += [f"{readme}: {file}, {rule} says {figure}, not so\n{block.group()}" for figure in missing]
        elif block.group() != expected and write:
            text = text[:block.start()] + expected + text[block.end():]
        elif block.group() != expected:
            wrong.append(f"{readme}: {file}, {rule} gives another table (--write puts it in)\n{expected}")
    if write:
        readme.write_text(text)
    return wrong, len(comments)


def main():
    root, write = Path(sys.argv[1]), "--write" in sys.argv
    readmes = [path for path in sorted(root.rglob("README.md")) if "build" not in path.relative_to(root).parts]
    found = [check(root, readme, write) for readme in readmes]
    wrong, shown = [line for lines, _ in found for line in lines], sum(count for _, count in found)
    print("\n".join([*wrong, f"{shown} tables and paragraphs from stored files, {len(wrong)} errors"]))
    return 1 if wrong or not shown else 0


if __name__ == "__main__":
    sys.exit(main())
