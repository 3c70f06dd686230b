"""Success over density: flies a small campaign, reads its rows, and draws a curve with intervals.

python3 campaign_plot.py results/density density.png        (python3-matplotlib)
"""

import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import understory

SQUARE_METRES_PER_TREE = [50, 25, 16, 10]


def interval(successes, count):
    """Wilson's 95 % interval of a share."""
    share, z = successes / count, 1.96
    middle = share + z * z / (2 * count)
    reach = z * np.sqrt(share * (1 - share) / count + z * z / (4 * count**2))
    return (middle - reach) / (1 + z * z / count), (middle + reach) / (1 + z * z / count)


def main(folder, picture, seeds="1000..1009"):
    if not os.path.exists(os.path.join(folder, "flights.csv")):
        flown = {
            "scenario": "forest",
            "seeds": seeds,
            "grid": {"forest.square_metres_per_tree": SQUARE_METRES_PER_TREE},
        }
        understory.campaign(flown, folder, set={"perception.detector": "true_depth"})
    rows = understory.Campaign(folder).rows
    stems, shares, errors = [], [], []
    for area in SQUARE_METRES_PER_TREE:
        flown = rows[rows["square_metres_per_tree"] == area]
        successes = int(np.sum(flown["outcome"] == "goal"))
        low, high = interval(successes, len(flown))
        stems.append(1e4 / area)
        shares.append(successes / len(flown))
        errors.append((max(0, shares[-1] - low), max(0, high - shares[-1])))
    plt.errorbar(stems, shares, np.transpose(errors), marker="o", capsize=4)
    plt.xlabel("stems per hectare")
    plt.ylabel("share of flights that reach the goal, 95 % interval")
    plt.ylim(0, 1.05)
    plt.savefig(picture, dpi=120)


if __name__ == "__main__":
    main(*sys.argv[1:])
