#!/usr/bin/env python3
"""Flies what vision must be able to do (docs/limits.md): one property of the synthetic detector made worse at a time.

requirements.py --seeds 5101..5220 --out FOLDER [--only "latency;one depth"]
    flies each value of each property at two speeds and two densities with the first 20 seeds, then with all the others
    the best value and the two between which the success falls below 95 %, until the success falls between two of these.
    (Flying until an interval excludes 95 % would choose the count by the outcome, and make shares too small.)
    Writes requirements.csv: a row for each property, value, speed and density. With --only, of these properties.
"""

import argparse
import csv
import shutil
import subprocess
from collections import defaultdict
from pathlib import Path

SPEEDS_MPS, PER_TREE_M2 = [9, 12], [49, 16]
ASKED = 0.95
# property: the key, its values from good to bad
PROPERTIES = {
    "reach": ("perception.full_stereo.maximum_depth_m", [15, 12, 10, 8, 7, 6, 5, 4]),
    # Whole disparities of the long rig: the detector rounds to them.
    "one depth": ("perception.synthetic.depths_m", [14.78, 12.03, 10.14, 8.21, 6.9, 5.94, 5.02, 3.95]),
    "rate": ("cameras.rate_hz", [120, 20, 6, 5, 4, 3, 2, 1]),
    "latency": ("cameras.latency_s", [0.008, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4]),
    "missed for good": ("perception.synthetic.missed_obstacles", [0, 0.005, 0.01, 0.02, 0.04, 0.08, 0.16]),
    "missed in a frame": ("perception.synthetic.missed_frames", [0, 0.5, 0.8, 0.9, 0.95, 0.98, 0.99]),
    "blocks missed": ("perception.synthetic.missed_blocks", [0, 0.5, 0.8, 0.9, 0.95, 0.98, 0.99]),
    "false points": ("perception.synthetic.false_points", [0, 0.1, 0.3, 1, 3, 10, 30]),
    "disparity error": ("perception.synthetic.disparity_error_px", [0, 0.25, 0.5, 1, 1.5, 2, 3, 4]),
}


def falling_fit(counts):
    """Shares that only fall, fitted to counts of arrived and flown (isotonic regression)."""
    blocks = []  # arrived, flown, values
    for arrived, flown in counts:
        blocks.append([arrived, flown, 1])
        while len(blocks) > 1 and blocks[-2][0] * blocks[-1][1] < blocks[-1][0] * blocks[-2][1]:
            blocks[-2:] = [[one + other for one, other in zip(*blocks[-2:])]]
    return [arrived / flown for arrived, flown, values in blocks for _ in range(values)]


def flown_as(cell):
    """The best value of every property but one depth is the same detector, which sees everything: it is flown once."""
    of, value, *where = cell
    return cell if of == "one depth" or value != PROPERTIES[of][1][0] else ("reach", PROPERTIES["reach"][1][0], *where)


class Requirements:
    def __init__(self, arguments):
        self.arguments, self.out = arguments, Path(arguments.out)
        self.out.mkdir(parents=True, exist_ok=True)
        self.counts = defaultdict(lambda: [0, 0])  # arrived and flown, by cell: property, value, speed and density

    def fly(self, name, seeds, cells):
        """Flies these cells with these seeds."""
        cells = list(dict.fromkeys(map(flown_as, cells)))
        lines = ["scenario: forest", f"seeds: {seeds[0]}..{seeds[-1]}", "overrides:"]
        for number, (of, value, speed_mps, per_tree_m2) in enumerate(cells):
            value = f"[{value}]" if of == "one depth" else value
            keys = {"perception.detector": "synthetic", "autopilot.flight_model.cruise_speed_mps": speed_mps,
                    "forest.square_metres_per_tree": per_tree_m2, PROPERTIES[of][0]: value}
            lines.append(f"  - {{name: c{number}, set: {{" + ", ".join(f"{k}: {v}" for k, v in keys.items()) + "}}")
        file, folder = self.out / f"{name}.yaml", self.out / name
        file.write_text("\n".join(lines) + "\n")
        done = subprocess.run([self.arguments.program, "campaign", file, "--out", folder,
                               *(["--resume"] if (folder / "campaign.json").exists() else [])])
        if done.returncode not in (0, 1):
            raise SystemExit(f"{file}: could not be flown")
        with open(folder / "flights.csv", newline="") as table:
            for row in csv.DictReader(table):
                if row["status"] != "flown":
                    raise SystemExit(f"{folder}: {row['id']} is {row['status']}; the same command flies it again")
                count = self.counts[cells[int(row["condition"].rsplit("-c", 1)[1])]]
                count[0] += row["outcome"] == "goal"
                count[1] += 1

    def turning(self, of, speed_mps, per_tree_m2, most):
        """The best value and the two between which the fitted success falls below what is asked, unless they have all
        seeds."""
        cells = [(of, value, speed_mps, per_tree_m2) for value in PROPERTIES[of][1]]
        counts = [self.counts[flown_as(cell)] for cell in cells]
        below = next((i for i, share in enumerate(falling_fit(counts)) if share < ASKED), len(cells))
        for i in {0, max(0, below - 1), min(below, len(cells) - 1)}:
            if counts[i][1] < most:
                yield cells[i]

    def write(self, cells):
        with open(self.out / "requirements.csv", "w", newline="") as text:
            writer = csv.writer(text, lineterminator="\n")
            writer.writerow(["property", "value", "speed_mps", "square_metres_per_tree", "arrived", "flown"])
            writer.writerows([*cell, *self.counts[flown_as(cell)]] for cell in cells)


def seed_range(text):
    first, dots, last = text.partition("..")
    if not (dots and first.isdigit() and last.isdigit() and int(last) - int(first) >= 20):
        raise argparse.ArgumentTypeError(f"{text}: expected FIRST..LAST, more than 20 seeds, for example 5101..5220")
    return int(first), int(last)


def properties(text):
    names = text.split(";")
    if unknown := [name for name in names if name not in PROPERTIES]:
        raise argparse.ArgumentTypeError(f"no property {unknown[0]!r}; there are: {'; '.join(PROPERTIES)}")
    return names


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/understory")
    parser.add_argument("--seeds", required=True, type=seed_range)
    parser.add_argument("--out", required=True)
    parser.add_argument("--only", type=properties, help="properties, with ; between them")
    arguments = parser.parse_args()
    if not shutil.which(arguments.program):
        parser.error(f"argument --program: there is no program {arguments.program}; build it first")
    first, last = arguments.seeds
    all_of = Requirements(arguments)
    names = arguments.only or list(PROPERTIES)
    curves = [(of, speed_mps, per_tree_m2) for of in names for speed_mps in SPEEDS_MPS for per_tree_m2 in PER_TREE_M2]
    every = [(of, value, *where) for of, *where in curves for value in PROPERTIES[of][1]]
    cells, seeds, turn = every, range(first, first + 20), 0
    while cells:
        all_of.fly(f"turn-{turn}", seeds, cells)
        all_of.write(every)
        cells = [cell for curve in curves for cell in all_of.turning(*curve, last + 1 - first)]
        seeds, turn = range(first + 20, last + 1), turn + 1


if __name__ == "__main__":
    main()
