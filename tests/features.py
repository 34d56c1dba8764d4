#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Table of what every engine showed in a test, as markdown: features.py CSV... > features.md

features.py --check features.md CSV... compares a stored table with what the test shows now: verdicts as they are,
figures to a factor of ten, as they depend on the machine; columns and features that one of them alone has are told.
A stored column of which no CSV is given is left out: not every machine has every engine.

Rows are features, columns are engine, precision and solver. A feature that a column did not show stays empty. Two
tables are made so, told apart by the columns of their CSV:

features.md       of the contract: engine,precision,solver,feature,verdict,error, written to DUCTILE_FEATURES
default_world.md  of the reference problems in a default World: expected,got,parts beside these, written to
                  DUCTILE_DEFAULT_WORLD
"""

import csv
import re
import sys



class Contract:
    """What each solver showed of each feature."""

    title = "What each solver showed"
    source = "the contract suite's own run"
    legend = {
        "exact": "the answer in discrete time to round-off (1e-9 in double, 2e-4 in float)",
        "right": "within the tolerance that the test derives; the figure is the largest error",
        "reported": "not solved in some run, and every such run said `unreliable`",
        "refused": "not built, with a message by name",
        "wrong": "off and silent: the test fails",
    }
    file = "features.md"
    figure = re.compile(r"right(?: \((.*)\))?$")

    @staticmethod
    def order(features: list[str]) -> list[str]:
        return sorted(features)

    @staticmethod
    def cell(row: dict[str, str]) -> str:
        verdict, error = row["verdict"], row["error"]
        if verdict == "right" and float(error) > 0:
            return f"right ({float(error):.0e})"
        return f"**{verdict}**" if verdict == "wrong" else verdict

    @classmethod
    def alike(cls, stored: str, shown: str) -> bool:
        left, right = cls.figure.match(stored), cls.figure.match(shown)
        if left is None or right is None:
            return False
        if left[1] is None or right[1] is None:
            return left[1] == right[1]
        return 0.1 <= float(left[1]) / float(right[1]) <= 10


class DefaultWorld:
    """What a default World at frames of 1/60 s made of each quantity."""

    title = "The reference problems in a default World at 1/60 s"
    source = "the run of `adapters/reference_frames_test.cpp`"
    legend = {
        "figures": "what came out, its error, and the parts of a frame, those that were put back among them; in brackets "
        "behind a quantity what should",
        "nothing else": "right within 1 %, and nothing was said",
        "alarm": "right within 1 %, and yet the World did not believe its run, or a joint said that it was unreliable or "
        "coarse",
        "said": "off by more than 1 %, and that was said",
        "part": "off by more than 1 % and silent, but a small part of the answer: the energy that is misplaced is within 1 % "
        "of all plastic work, which is what the tolerance says",
        "wrong": "off by more than 1 % and silent: the test fails, but where it names the reason",
    }
    file = "default_world.md"
    figure = re.compile(r"(\S+), (\S+) %, (\S+)(?: (.*))?$")

    @staticmethod
    def order(features: list[str]) -> list[str]:
        return features

    @staticmethod
    def cell(row: dict[str, str]) -> str:
        verdict, error = row["verdict"], 100 * float(row["error"])
        said = "" if verdict == "right" else f" **{verdict}**" if verdict == "wrong" else f" {verdict}"
        exact = error < 1e-3  # digits that the machine decides
        got = float(row["expected"] if exact else row["got"])
        return f"{got:.5g}, {0 if exact else error:.1g} %, {float(row['parts']):.3g}{said}"

    @classmethod
    def alike(cls, stored: str, shown: str) -> bool:
        left, right = cls.figure.match(stored), cls.figure.match(shown)
        if left is None or right is None:
            return False
        # where something was said, how much is left of an error near 1 % is the machine's
        verdicts = {"said" if of[4] == "alarm" else of[4] for of in (left, right)}
        if len(verdicts) > 1:
            return False
        errors, parts = (sorted(float(of[i]) for of in (left, right)) for i in (2, 3))
        nothing = 0.1  # of an error [%]: it may come and go
        return errors[1] <= max(nothing, 10 * errors[0]) and parts[1] <= 2 * parts[0] + 1


Kind = type[Contract] | type[DefaultWorld]


def rows_of(paths: list[str]) -> list[dict[str, str]]:
    rows = []
    for path in paths:
        with open(path, newline="", encoding="utf-8") as file:
            rows += csv.DictReader(file)
    return rows


def kind_of(rows: list[dict[str, str]]) -> Kind:
    return DefaultWorld if rows and "parts" in rows[0] else Contract


def table(rows: list[dict[str, str]]) -> str:
    kind = kind_of(rows)
    shown: dict[tuple[str, str, str], dict[str, str]] = {}
    names: dict[str, str] = {}
    for row in rows:
        column = (row["engine"], row["precision"], row["solver"])
        shown.setdefault(column, {})[row["feature"]] = kind.cell(row)
        names[row["feature"]] = f" ({float(row['expected']):.9g})" if "expected" in row else ""
    columns = sorted(shown)
    lines = [f"# {kind.title}", ""]
    lines += [f"Generated by `tests/features.py` from {kind.source}, and compared with it by ctest; do not edit.", ""]
    lines += ["| feature | " + " | ".join(f"{e} {p} {s}" for e, p, s in columns) + " |"]
    lines += ["|---" * (len(columns) + 1) + "|"]
    for feature in kind.order(list(names)):
        cells = (shown[column].get(feature, "") for column in columns)
        lines.append(f"| {feature}{names[feature]} | " + " | ".join(cells) + " |")
    lines += [""] + [f"- *{name}*: {meaning}" for name, meaning in kind.legend.items()]
    return "\n".join(lines)


def columns_of(table_text: str) -> dict[str, dict[str, str]]:
    """The cells of a table by column, then by feature; empty ones left out."""
    rows = [
        [cell.strip() for cell in line.strip().strip("|").split("|")]
        for line in table_text.splitlines()
        if line.startswith("|") and not line.startswith("|---")
    ]
    names = rows[0][1:]
    return {
        name: {row[0]: row[i + 1] for row in rows[1:] if row[i + 1]} for i, name in enumerate(names)
    }


def differences(stored: str, rows: list[dict[str, str]]) -> list[str]:
    kind = kind_of(rows)
    was, now = columns_of(stored), columns_of(table(rows))
    told = []
    for column, shown in now.items():
        before = was.get(column)
        if before is None:
            told.append(f"{column}: not in the stored table")
            continue
        for feature in sorted(before.keys() | shown.keys()):
            old, new = before.get(feature, "nothing"), shown.get(feature, "nothing")
            if old != new and not kind.alike(old, new):
                told.append(f"{column}, {feature}: stored {old}, shown {new}")
    return told


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    if sys.argv[1] == "--check":
        if len(sys.argv) < 4:
            sys.exit("features.py --check: no CSV was given: run the test first")
        new_rows = rows_of(sys.argv[3:])
        with open(sys.argv[2], encoding="utf-8") as stored_table:
            found = differences(stored_table.read(), new_rows)
        if found:
            made = kind_of(new_rows).file
            sys.exit("\n".join([*found, f"made anew by features.py CSV... > {made}: say why it changed"]))
        print("what is shown is as stored")
    else:
        print(table(rows_of(sys.argv[1:])))
