#!/usr/bin/env python3
"""What decides difficulty, of two sets of scenes side by side.

    odis analyze generated/*/scene.xml -o generated.json
    odis analyze shared/*/scene.xml -o shared.json        # with the same options
    bench/difficulty.py generated.json shared.json        # Markdown

Compares quantiles over scenes of the causes' shares of the variance, of its size and of the rays a sample takes; lists
medians of the first set's kinds (SEED-KIND, as `odis scenes generate` names folders), and says which scenes of the
second set lie outside of what 90 % of the first have. --method picks one of those that were analysed.
"""

import argparse
import json
import statistics
import sys

SHARES = {  # what `odis analyze` calls them, and what the table does
    "pixel and lens": "pixel and lens",
    "first vertex: which light": "first light",
    "first vertex: point on the light": "first point",
    "first vertex: direction": "first direction",
    "later vertices: which light": "later light",
    "later vertices: point on the light": "later point",
    "later vertices: direction": "later direction",
    "roulette": "roulette",
    "all next-event estimation": "all NEE",
    "all directions": "all directions",
    "everything after the first direction": "after first direction",
}
MAIN = ["first direction", "later direction", "all NEE", "after first direction"]
OUTER = (0.05, 0.95)


def read(path, method):
    """A row a scene: its name, shares in per cent, relMSE and rays."""
    rows = []
    with open(path, encoding="utf-8") as file:
        scenes = json.load(file)["scenes"]
    for scene in scenes:
        found = [m for m in scene["methods"] if m["name"] == method]
        if not found:
            sys.exit(f"{path}: {scene['scene']} has no method \"{method}\"; --method expects one that was analysed")
        shares = {share["cause"]: 100 * share["share"] for share in found[0]["shares"]}
        values = {short: shares[cause] for cause, short in SHARES.items()}
        values.update({"relMSE": found[0]["variance"], "rays": found[0]["raysPerSample"]})
        rows.append((scene["scene"], values))
    if len(rows) < 2:
        sys.exit(f"{path}: expected two scenes or more")
    return rows


def quantile(rows, column, q):
    """Linear between the ordered values, the least at 0 and the largest at 1."""
    values = sorted(values[column] for _, values in rows)
    at = q * (len(values) - 1)
    low = min(int(at), len(values) - 2)
    return values[low] + (at - low) * (values[low + 1] - values[low])


def shown(column, value):
    return f"{value:.3g}" if column == "relMSE" else f"{value:.1f}" if column == "rays" else f"{value:.0f}"


def line(cells):
    print("| " + " | ".join(cells) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("generated")
    parser.add_argument("shared")
    parser.add_argument("--method", default="path")
    options = parser.parse_args()
    generated, shared = read(options.generated, options.method), read(options.shared, options.method)
    columns = list(SHARES.values()) + ["relMSE", "rays"]

    sets = (("generated", generated), ("shared", shared))
    line([f"{options.method}: % of the variance"] + [f"{name} {q} %" for name, _ in sets for q in (10, 50, 90)])
    line(["---"] * 7)
    for column in columns:
        line([column] + [shown(column, quantile(rows, column, q)) for _, rows in sets for q in (0.1, 0.5, 0.9)])

    kinds = {}
    for name, values in generated:
        kinds.setdefault(name.rpartition("-")[2], []).append(values)
    print()
    line(["median of a kind", "scenes"] + MAIN + ["relMSE", "rays"])
    line(["---"] * (len(MAIN) + 4))
    for kind, rows in sorted(kinds.items()):
        medians = [shown(c, statistics.median(r[c] for r in rows)) for c in MAIN + ["relMSE", "rays"]]
        line([kind, str(len(rows))] + medians)

    print()
    line(["outside of 5 to 95 % of the generated", "from", "to", "below", "above"])
    line(["---"] * 5)
    for column in columns:
        low, high = (quantile(generated, column, q) for q in OUTER)
        values = [(name, row[column]) for name, row in shared]
        below = ", ".join(f"{name} ({shown(column, v)})" for name, v in values if v < low)
        above = ", ".join(f"{name} ({shown(column, v)})" for name, v in values if v > high)
        line([column, shown(column, low), shown(column, high), below or "none", above or "none"])


if __name__ == "__main__":
    main()
