#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks the include graph of the headers against its intended order: include_graph.py REPOSITORY

Each folder of include/ductile may include what stands before it in ALLOWED and nothing else; adapters may
include the core, the core never an adapter; and no header includes itself by a detour.

A virtual function whose body is in an .ipp is declared DUCTILE_INLINE: one that is declared without is the key
function of its class, and every program that sees the body compiles the table and all that it calls, used or not.

Who names Eigen includes it, or a header that does: where headers are compiled alone Eigen is there already.
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


def keys(text):
    """Virtual functions that are declared in a header without a body and not inline."""
    text = re.sub(r"//[^\n]*", "", text)
    templates = [(m.start(), m.end()) for m in re.finditer(r"^template <.*?^};", text, re.M | re.S)]
    for found in re.finditer(r"[^;{}]+;", text):
        words = found.group().split()
        said = " ".join(words)
        virtual = words[-1] in ("override;", "final;") or "virtual" in words or re.search(r"(^|[^>])~\w+\(\);$", said)
        inside = any(a <= found.start() < b for a, b in templates)
        if virtual and not inside and "DUCTILE_INLINE" not in words and "= " not in said:
            yield said


def main():
    root = Path(sys.argv[1])
    graph = {}
    lengths = []
    names_eigen, includes_eigen = set(), set()
    errors = []
    for folder in ("include", *(f"adapters/{name}/include" for name in ADAPTERS)):
        base = root / folder
        for path in sorted([*base.rglob("*.hpp"), *base.rglob("*.ipp")]):
            # the bodies in x.ipp are a part of x.hpp
            name = str(path.relative_to(base).with_suffix(".hpp"))
            errors += [f"{name}: {said} has to be DUCTILE_INLINE" for said in keys(path.read_text())
                       if path.suffix == ".hpp"]
            if "Eigen::" in path.read_text():
                names_eigen.add(name)
            if re.search(r"^#include <Eigen/", path.read_text(), re.M):
                includes_eigen.add(name)
            lengths.append((str(path.relative_to(base)), len(path.read_text().splitlines())))
            includes = re.findall(r'^#include "(ductile/[^"]+)"', path.read_text(), re.M)
            includes = [i.removesuffix(".ipp") + ".hpp" if i.endswith(".ipp") else i for i in includes]
            graph.setdefault(name, []).extend(i for i in includes if i != name)
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
    def reached(header, seen):
        if header not in seen:
            seen.add(header)
            for include in graph.get(header, ()):
                reached(include, seen)
        return seen

    errors += [f"{header}: names Eigen, and nothing that it includes brings it in"
               for header in sorted(names_eigen) if not reached(header, set()) & includes_eigen]
    rooms = sorted({room(h) for h in graph} - set(ALLOWED) - set(ADAPTERS) - {"ductile"})
    errors += [f"include/ductile/{r}: no place in the order" for r in rooms]
    errors += [f"{header}: {length} lines, more than 400" for header, length in lengths if length > 400]
    print("\n".join(errors) if errors else f"{len(graph)} headers in order")
    sys.exit(bool(errors))


if __name__ == "__main__":
    main()
