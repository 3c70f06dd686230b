"""A learned baseline: a linear policy on the obstacle memory, improved by the cross-entropy method in minutes.

    python3 learn.py train policy.npy                 trains on seeds 1000 to 1199
    python3 learn.py test policy.npy 5001 5100        compares it with straight on and with random actions
"""

import multiprocessing
import sys

import numpy as np

from understory.gym import FlightEnv

LATERAL_M = np.linspace(-3.5, 3.5, 9)
AHEAD_M = ((1.0, 5.0), (4.0, 9.0), (8.0, 14.0))
FEATURES = len(LATERAL_M) * len(AHEAD_M) + 5
ROUNDS, CANDIDATES, KEPT, EPISODES = 16, 24, 6, 8


def features(observation):
    """How full the memory is in bins of the way ahead, and where the aircraft is; all of the order of 1."""
    points = observation["map"]
    down = observation["gravity"]  # bins lie level, whatever the bank
    bank_rad = np.arctan2(down[1], -down[2])
    left_m = points[:, 1] * np.cos(bank_rad) + points[:, 2] * np.sin(bank_rad)
    bins = []
    for near_m, far_m in AHEAD_M:
        weight = ((points[:, 0] > near_m) & (points[:, 0] < far_m)).astype(float)
        near = np.exp(-((left_m[:, None] - LATERAL_M) ** 2) / 0.5)
        bins.append((near * weight[:, None]).max(axis=0))
    offset_m, heading_rad = observation["course"]
    rest = [1.0, 0.1 * offset_m, heading_rad, bank_rad, 0.5 * (observation["altitude"][0] - 4.5)]
    return np.concatenate(bins + [rest])


def action(weights, observation):
    """Bank is linear in the features and odd: what holds on the left holds mirrored on the right."""
    seen = features(observation)
    bank = weights[: FEATURES - 1] @ seen[:-1]
    climb = -1.0 * seen[-1]
    return np.clip(np.array([bank, climb]), -1, 1)


def mirrored(half):
    """Weights of all features from those of one side."""
    bins = half[: 4 * len(AHEAD_M)].reshape(len(AHEAD_M), 4)
    full = np.concatenate([np.hstack([bins, np.zeros((len(AHEAD_M), 1)), -bins[:, ::-1]]).ravel(), [0.0]])
    return np.concatenate([full, half[4 * len(AHEAD_M) :], [0.0]])


HALF = 4 * len(AHEAD_M) + 3


def episode(env, policy, seed):
    observation, _ = env.reset(seed=int(seed))
    total = 0.0
    while True:
        observation, reward, terminated, truncated, info = env.step(policy(observation))
        total += reward
        if terminated or truncated:
            return total, info["outcome"]


_env = None


def _begin():
    global _env
    _env = FlightEnv("forest", observe=("altitude", "gravity", "course", "map"), detector="true_depth", record=False)


def _score(job):
    half, seeds = job
    weights = mirrored(half)
    return float(np.mean([episode(_env, lambda observation: action(weights, observation), seed)[0] for seed in seeds]))


def train(file):
    random = np.random.default_rng(1)
    mean, spread = np.zeros(HALF), np.full(HALF, 0.6)
    mean[-3:] = [0.4, 0.8, -0.2]  # back to the course
    with multiprocessing.get_context("spawn").Pool(2, _begin) as pool:
        for number in range(ROUNDS):
            seeds = random.choice(np.arange(1000, 1200), EPISODES, replace=False)
            halves = mean + spread * random.standard_normal((CANDIDATES, HALF))
            scores = np.array(pool.map(_score, [(half, seeds) for half in halves], chunksize=1))
            best = halves[np.argsort(-scores)[:KEPT]]
            mean, spread = best.mean(axis=0), best.std(axis=0) + 0.3 * 0.85**number
            print(f"round {number + 1} of {ROUNDS}: mean reward {scores.mean():.2f}, best {scores.max():.2f}", flush=True)
            np.save(file, mean)


def interval(successes, count):
    """Wilson's 95 % interval of a share."""
    share, z = successes / count, 1.96
    middle, reach = share + z * z / (2 * count), z * np.sqrt(share * (1 - share) / count + z * z / (4 * count**2))
    return (middle - reach) / (1 + z * z / count), (middle + reach) / (1 + z * z / count)


def test(file, first, last):
    _begin()
    weights, random = mirrored(np.load(file)), np.random.default_rng(2)
    for name, policy in (
        ("learned", lambda observation: action(weights, observation)),
        ("straight on", lambda observation: np.clip([0.0, -0.5 * (observation["altitude"][0] - 4.5)], -1, 1)),
        ("random", lambda observation: random.uniform(-1, 1, 2)),
    ):
        outcomes = [episode(_env, policy, seed)[1] for seed in range(first, last + 1)]
        goals = outcomes.count("goal")
        low, high = interval(goals, len(outcomes))
        print(f"{name:12s} {goals} of {len(outcomes)} at the goal ({low:.2f} to {high:.2f})", flush=True)


if __name__ == "__main__":
    if sys.argv[1:2] == ["train"] and len(sys.argv) == 3:
        train(sys.argv[2])
    elif sys.argv[1:2] == ["test"] and len(sys.argv) == 5:
        test(sys.argv[2], int(sys.argv[3]), int(sys.argv[4]))
    else:
        sys.exit(__doc__)
