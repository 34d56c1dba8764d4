# SPDX-License-Identifier: MIT
"""The tables and figures of the READMEs, each made of one stored file; readme_figures.py compares them.

A rule takes the path of its file and returns a table in Markdown, a fenced text, or a list of figures. With another
measurement a table changes by itself; with other columns or names its rule has to.
"""

import csv
import gzip
import re

BLOCK = re.compile(r"```\w*\n(?:.*\n)*?```|.+(?:\n.+)*")
OURS = ("plastic-", "elastic-plastic")
NAMES = {"plastic-hinge": "hinge", "plastic-joint": "six axes"}
# our joint and the engine's own for the same task
TASKS = {"bullet": {"plastic-hinge": "hinge-motor", "plastic-joint": "spring2"},
         "ode": {"plastic-hinge": "hinge-motor", "plastic-joint": "fixed"}}


def text_of(path):
    return (gzip.open(path, "rt") if path.suffix == ".gz" else open(path)).read()


def rows_of(path):
    return list(csv.DictReader(text_of(path).splitlines()))


def each(rows, *columns):
    """What stands in the columns, each once and in the order of the file."""
    return list(dict.fromkeys(tuple(row[column] for column in columns) for row in rows))


def table(head, rows):
    lines = ["| " + " | ".join(map(str, row)) + " |" for row in [head, *rows]]
    return "\n".join([lines[0], "|---" * len(head) + "|", *lines[1:]])


def is_ours(row):
    return row["method"].startswith(OURS)


def whole(path):
    return "```text\n" + "\n".join(line.rstrip() for line in text_of(path).splitlines()) + "\n```"


def section(path, heading):
    return BLOCK.search(text_of(path).split(f"## {heading}\n")[1].lstrip()).group()


def charpy_frames(path):
    """The Charpy test in frames, in double: absorbed by our joints and lost by the hammer."""
    found = {(row["engine"], row["method"], row["step ms"]): row for row in rows_of(path)
             if is_ours(row) and row["scalar"] == "double" and row["published J"] == "90 to 150"}
    cases = list(dict.fromkeys((engine, method) for engine, method, _ in found))
    head = ["engine", "joint", "expected [J]"] + [f"1/{n} s" for n in (240, 120, 60, 30)]
    steps = list(dict.fromkeys(step for _, _, step in found))

    def cell(row):
        said = "" if row["believed"] == "yes" else ", not believed"
        return f"{row['plastic work J']} / {row['hammer loss J']}{said}"

    return table(head, [[engine, f"`{method}`", found[engine, method, steps[0]]["expected J"],
                         *[cell(found[engine, method, step]) for step in steps]] for engine, method in cases])


def scene_costs(path):
    """Of each scene, in each engine, the mean frame, the dearest in so many solves, how late a clock of real time would be
    at most [ms], and its largest replay [MB]."""
    rows = rows_of(path)
    found = {(row["scene"], row["engine"]): row for row in rows}
    scenes, engines = ([key for (key,) in each(rows, column)] for column in ("scene", "engine"))

    def size(scene, kind):
        return f"{max(float(found[scene, engine][f'largest_{kind}_B']) for engine in engines) / 1e6:.2f}"

    def time(row):
        most = f"{float(row['dearest_ms']):.1f} in {row['dearest_solves']}"
        return f"{float(row['mean_ms']):.2f}; {most}; {float(row['late_ms']):.0f}"

    return table(["scene", *[f"{engine} [ms]" for engine in engines], "page [MB]", "glTF [MB]"],
                 [[scene, *[time(found[scene, engine]) for engine in engines], size(scene, "html"),
                   size(scene, "glb")] for scene in scenes])


def misses(path):
    """Of the Charpy test's runs with our joints: how many are off by more than 1 %, and how many there are."""
    ours = [row for row in rows_of(path) if is_ours(row)]
    return [sum(row["right"] == "no" for row in ours), len(ours)]


def cost_ratios(rows):
    """Time of our joint over that of the engine's own: by column, set-up and number of joints."""
    time = {(row["engine"], row["precision"], row["joint"], row["islands"] == "1", row["count"]):
            float(row["ns_per_joint_step"]) for row in rows}
    return {(f"{NAMES[joint]}, {engine} {precision}", f"{'chain' if chain else 'flowing pairs'}, {count}"):
            took / time[engine, precision, TASKS[engine][joint], chain, count]
            for (engine, precision, joint, chain, count), took in time.items() if joint in NAMES}


def joint_cost(path):
    ratios = cost_ratios(rows_of(path))
    joints, set_ups = (list(dict.fromkeys(key[i] for key in ratios)) for i in (0, 1))
    joints.sort(key=lambda joint: joint.split(", ")[0])
    return table(["", *joints], [[set_up, *[f"{ratios[joint, set_up]:.2f}" for joint in joints]]
                                 for set_up in set_ups])


def dearest(path):
    """Least and most of what a joint costs beside the engine's own, where ours are dearest."""
    ratios = cost_ratios(rows_of(path))
    wanted = (("six axes, bullet double", "pairs"), ("hinge, ode double", ""), ("six axes, ode double", ""))
    ranges = [[ratio for (joint, set_up), ratio in ratios.items() if joint == name and where in set_up]
              for name, where in wanted]
    return [f"{end(of):.1f}" for of in ranges for end in (min, max)]


def instructions(path):
    """Ours / the engine's own = ratio, of the last state that is stored."""
    rows = rows_of(path)
    last = "after" if any(row["state"] == "after" for row in rows) else "before"
    rows = [row for row in rows if row["state"] == last and row["own"]]
    found = {(row["engine"], row["precision"], row["library"], row["joint"], row["set_up"]): row for row in rows}

    def cell(row):
        return f"{float(row['ours']):.0f} / {float(row['own']):.0f} = {float(row['ratio']):.2f}" if row else "-"

    set_ups = ["pairs-flowing", "pairs-at-rest", "chain-at-rest"]
    return table(["joint", "engine", *[set_up.replace("-", " ") for set_up in set_ups]],
                 [[f"`{joint}`", f"{engine} {precision}, {library}",
                   *[cell(found.get((engine, precision, library, joint, set_up))) for set_up in set_ups]]
                  for engine, precision, library, joint in each(rows, "engine", "precision", "library", "joint")])


def small_islands(path):
    """Of Bullet in double: ours / the engine's own = ratio, beside the aim."""
    found = {(row["joint"], row["set_up"]): row for row in rows_of(path)
             if row["state"] == "after" and row["engine"] == "bullet" and row["precision"] == "double"}
    hinge, six = "plastic-hinge", "plastic-joint"
    aims = {"hinge of a pair, flowing": (hinge, "pairs-flowing", 0.35),
            "hinge of a pair at rest": (hinge, "pairs-at-rest", 0.65),
            "hinge to the ground, flowing": (hinge, "ground-flowing", 0.33),
            "six axes of a pair at rest": (six, "pairs-at-rest", 0.55),
            "six axes of a pair, flowing": (six, "pairs-flowing", 1.2),
            "lamp-post on its foot, six axes that hold": (six, "post-standing", 0.45),
            "chain of five hinges that hold": (hinge, "fives-standing", 0.6),
            "chain of five hinges, flowing": (hinge, "fives-flowing", 0.6),
            "hinge of a pair on a floor that sticks": (hinge, "floor-sticking", 2),
            "hinge of a pair on a floor that slides": (hinge, "floor-sliding", 3)}

    def cells(row, aim):
        return row["own_joint"], f"{float(row['ours']):.0f}", f"{float(row['own']):.0f}", row["ratio"], aim

    return table(["joint", "own joint", "ours", "own", "ours / own", "aim"],
                 [[name, *cells(found[joint, set_up], aim)] for name, (joint, set_up, aim) in aims.items()])


def scaling(path):
    """Of 100,000 joints: microseconds of the world's step per joint, and kilobytes of a joint."""
    rows = [row for row in rows_of(path) if row["joints"] == "100000"]
    found = {(row["engine"], row["precision"], row["method"], row["yielding"]): row for row in rows}
    builds = each(rows, "engine", "precision")

    def cells(*key):
        time = [f"{float(row['ns_per_joint_step']) / 1000:.1f}" if row else "-"
                for row in (found[*key, "0"], found.get((*key, "1")))]
        return *time, f"{float(found[*key, '0']['bytes_heap']) / 1000:.1f}"

    return table(["joint", *[f"{' '.join(build)}: {what}" for build in builds
                             for what in ("none yields [µs]", "all yield [µs]", "[kB]")]],
                 [[f"`{method}`", *[cell for build in builds for cell in cells(*build, method)]]
                  for (method,) in each(rows, "method")])


def structures(path):
    """A step of each scene: median and worst of ours elastic, medians of ours rigid and of fixed joints [ms]."""
    rows = {(row["engine"], row["solver"], row["scene"], row["joints"], row["method"]): row for row in rows_of(path)}

    def cell(key, column):
        return f"{float(rows[key][column]) / 1000:.3g}" if key in rows else "-"

    def line(scene, joints):
        cells = []
        for engine, solver in (("bullet", "si"), ("ode", "direct")):
            of = {method: (engine, solver, scene, joints, method) for method in ("elastic", "rigid", "fixed")}
            cells += [f"{cell(of['elastic'], 'median_us')}, {cell(of['elastic'], 'worst_us')}",
                      cell(of["rigid"], "median_us"), cell(of["fixed"], "median_us")]
        return [scene, joints, *cells]

    return table(["scene", "joints", *[f"{engine}: {what}" for engine in ("Bullet", "ODE")
                                       for what in ("elastic, worst", "rigid", "own fixed")]],
                 [line(scene, joints) for scene, joints in each(rows.values(), "scene", "joints")])


def members(path):
    """Posts that nothing strikes, the bar that is struck, the truck: cost beside Bullet alone, and what they absorb."""
    def line(row):
        counted = row["instruction_ratio"]
        return [row["scene"] + (f", {row['part']}" if row["part"] else ""), row["method"], row["posts"],
                f"{float(row['median_us']):.4g}", f"{float(row['ratio']):.3g}",
                f"{float(counted):.3f}" if counted else "-", row["most_open"], f"{float(row['absorbed_joule']):.7g}"]

    return table(["scene", "method", "posts", "step [µs]", "/ plain", "instructions / plain", "most open", "absorbed [J]"],
                 [line(row) for row in rows_of(path)])


def detail(path):
    """The choices that keep their tolerance, and their cost beside the cheapest model that does."""
    chosen = [row for row in rows_of(path) if row["chosen"] == "1"]

    def line(name, rows):
        within = [sum(float(row["cost_ratio"]) <= most for row in rows) for most in (1.2, 1.5)]
        return [name, len(rows), sum(row["meets"] == "1" for row in rows), *within]

    builds = each(chosen, "engine", "precision")
    return table(["engine", "choices", "keep the tolerance", "cost at most 1.2 of the cheapest", "at most 1.5"],
                 [line(" ".join(build), [row for row in chosen if (row["engine"], row["precision"]) == build])
                  for build in builds] + [line("all", chosen)])
