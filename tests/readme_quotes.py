#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks that the code shown in the README is code of the examples, which are built and run:
readme_quotes.py REPOSITORY

Every ```cpp block must stand, line by line and but for its indentation, in one file of examples/.
"""

import re
import sys
import textwrap
from pathlib import Path


def lines_of(text):
    return [line.strip() for line in text.strip().splitlines()]


def stands_in(block, text):
    wanted, lines = lines_of(block), lines_of(text)
    return any(lines[i:i + len(wanted)] == wanted for i in range(len(lines) - len(wanted) + 1))


def main():
    root = Path(sys.argv[1])
    examples = [path.read_text() for path in sorted(root.glob("examples/*/*.cpp"))]
    blocks = re.findall(r"^```cpp\n(.*?)^```", (root / "README.md").read_text(), re.M | re.S)
    missing = [block for block in blocks if not any(stands_in(block, text) for text in examples)]
    for block in missing:
        print("not in any example:\n" + textwrap.indent(block, "    "), file=sys.stderr)
    print(f"{len(blocks) - len(missing)} of {len(blocks)} blocks are code of the examples")
    return 1 if missing or not blocks else 0


if __name__ == "__main__":
    sys.exit(main())
