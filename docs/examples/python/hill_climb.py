"""Our judge, and an optimiser by hand: steps at random from the best so far, shorter where they do not help.
It climbs the first goal alone and heeds no bounds; a parameter with values gets one of them at random.

Run: python3 hill_climb.py TUNING.yaml [TRIALS]
"""

import random
import sys

import understory

chance = random.Random(1)
with understory.Tuning(sys.argv[1]) as tuning:
    goal = tuning.maximize[0]
    best, best_figures = tuning.scenario, tuning.measure(tuning.scenario)
    step = 0.3  # of each range
    for trial in range(int(sys.argv[2]) if len(sys.argv) > 2 else 60):
        values = {}
        for parameter in tuning.parameters:
            if "values" in parameter:
                values[parameter["key"]] = chance.choice(parameter["values"])
                continue
            low, high = parameter["from"], parameter["to"]
            value = best[parameter["key"]] + step * (high - low) * chance.gauss(0, 1)
            values[parameter["key"]] = min(high, max(low, round(value) if parameter["whole"] else value))
        figures = tuning.measure(values)
        if figures and figures[goal] > best_figures[goal]:
            best, best_figures, step = values, figures, 1.2 * step
        else:
            step = max(0.01, 0.9 * step)
    print(f"{goal} {best_figures[goal]:.4g}, {tuning.measure(best, 'validation')[goal]:.4g} on validation data: {best}")
