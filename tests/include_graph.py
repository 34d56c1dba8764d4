#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks the include graph of the headers against its intended order: include_graph.py REPOSITORY

Each folder of include/ductile may include what stands before it in ALLOWED and nothing else; adapters may
include the core, the core never an adapter; and no header includes itself by a detour.
"""

import re
import sys
from pathlib import Path

# folder -> folders it may include, besides itself
ALLOWED = {
    "vocabulary": set(),
    "numeric": {"vocabulary"},
    "material": {"vocabulary"},
    "section": {"vocabulary", "material"},
    "law": {"vocabulary"},
    "surface": {"vocabulary", "numeric"},
    "fracture": {"vocabulary"},
    "joint": {"vocabulary", "numeric", "law", "surface", "fracture"},
    "solve": {"vocabulary", "numeric", "surface"},
    "frame": {"vocabulary"},
    "batch": {"vocabulary", "law", "fracture", "joint"},
    "member": {"vocabulary", "material", "section", "law", "surface", "fracture", "joint", "world"},
    "world": {"vocabulary", "fracture", "joint", "fidelity", "solve", "frame"},
    "fidelity": {"vocabulary", "material", "section", "law", "fracture", "joint"},
    "structure": {"vocabulary", "numeric", "material", "section", "law", "surface", "fracture", "joint", "member",
                  "world"},
}
ADAPTERS = ("bullet", "ode")


def room(header):
    """Folder of a header; material.hpp stands for its folder."""
    parts = Path(header).parts[1:]
    return parts[0].removesuffix(".hpp")


def main():
    root = Path(sys.argv[1])
    graph = {}
    lengths = []
    for folder in ("include", *(f"adapters/{name}/include" for name in ADAPTERS)):
        base = root / folder
        for path in sorted([*base.rglob("*.hpp"), *base.rglob("*.ipp")]):
            # the bodies in x.ipp are a part of x.hpp
            name = str(path.relative_to(base).with_suffix(".hpp"))
            lengths.append((str(path.relative_to(base)), len(path.read_text().splitlines())))
            includes = re.findall(r'^#include "(ductile/[^"]+)"', path.read_text(), re.M)
            includes = [i.removesuffix(".ipp") + ".hpp" if i.endswith(".ipp") else i for i in includes]
            graph.setdefault(name, []).extend(i for i in includes if i != name)
    errors = []
    for header, includes in graph.items():
        where = room(header)
        for include in includes:
            to = room(include)
            if include not in graph:
                errors.append(f"{header} includes {include}, which does not exist")
            elif where == "ductile" or where == to:
                continue
            elif where in ADAPTERS:
                if to in ADAPTERS:
                    errors.append(f"{header} includes another adapter's {include}")
            elif to not in ALLOWED.get(where, set()):
                errors.append(f"{header} includes {include}: {where} may not know {to}")
    state = {}

    def visit(header, path):
        if state.get(header) == "done":
            return
        if state.get(header) == "open":
            errors.append("circle: " + " -> ".join(path[path.index(header):] + [header]))
            return
        state[header] = "open"
        for include in graph.get(header, ()):
            visit(include, path + [header])
        state[header] = "done"

    for header in graph:
        visit(header, [])
    rooms = sorted({room(h) for h in graph} - set(ALLOWED) - set(ADAPTERS) - {"ductile"})
    errors += [f"include/ductile/{r}: no place in the order" for r in rooms]
    errors += [f"{header}: {length} lines, more than 400" for header, length in lengths if length > 400]
    print("\n".join(errors) if errors else f"{len(graph)} headers in order")
    sys.exit(bool(errors))


if __name__ == "__main__":
    main()
