#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks that what the READMEs show is of the examples, which are built and run: readme_quotes.py REPOSITORY

Every ```cpp block of README.md and examples/README.md must stand, line by line and but for its indentation, in one
file of examples/, and the lines of every ```text block of examples/README.md, in their order, in the output that a source's opening
comment expects or that is stored in a table.
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


def printed(block, text):
    lines = iter([line.removeprefix("//").strip() for line in text.splitlines()])
    return all(wanted in lines for wanted in lines_of(block))  # one after the other


def main():
    root = Path(sys.argv[1])
    examples = [path.read_text() for path in sorted(root.glob("examples/*/*.cpp"))]
    blocks = [block for readme in ("README.md", "examples/README.md")
              for block in re.findall(r"^```cpp\n(.*?)^```", (root / readme).read_text(), re.M | re.S)]
    missing = [block for block in blocks if not any(stands_in(block, text) for text in examples)]
    expected = examples + [path.read_text() for path in sorted(root.glob("examples/*/results/table.txt"))]
    outputs = re.findall(r"^```text\n(.*?)^```", (root / "examples/README.md").read_text(), re.M | re.S)
    missing += [block for block in outputs if not any(printed(block, text) for text in expected)]
    for block in missing:
        print("not in any example:\n" + textwrap.indent(block, "    "), file=sys.stderr)
    shown = len(blocks) + len(outputs)
    print(f"{shown - len(missing)} of {shown} blocks are of the examples")
    return 1 if missing or not blocks or not outputs else 0


if __name__ == "__main__":
    sys.exit(main())
