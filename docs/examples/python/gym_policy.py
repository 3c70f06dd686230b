"""A policy written by hand, through the Gymnasium API: bank away from what the obstacle memory holds ahead."""

import sys

import numpy as np

from understory.gym import FlightEnv

OBSERVE = ("altitude", "map", "course")


def policy(observation):
    """Bank and climb, -1 to 1, from the points of the memory (body axes: x forward, y left)."""
    offset_m, heading_rad = observation["course"]
    bank = 0.8 * heading_rad + 0.04 * offset_m  # back to the course; right wing down turns to the right
    points = observation["map"]
    ahead = points[(points[:, 0] > 1) & (points[:, 0] < 12) & (np.abs(points[:, 1]) < 1.8)]
    if len(ahead) > 0:
        nearest = ahead[np.argmin(ahead[:, 0])]
        bank = 1.0 if nearest[1] > 0 else -1.0
    climb = 0.5 * (4.5 - observation["altitude"][0])
    return np.clip(np.array([bank, climb], np.float32), -1, 1)


def fly(env, policy, seed):
    observation, _ = env.reset(seed=seed)
    total = 0.0
    while True:
        observation, reward, terminated, truncated, info = env.step(policy(observation))
        total += reward
        if terminated or truncated:
            return total, info


if __name__ == "__main__":
    env = FlightEnv("forest", observe=OBSERVE, detector="true_depth")
    for seed in range(1000, 1000 + int(sys.argv[1]) if len(sys.argv) > 1 else 1010):
        total, info = fly(env, policy, seed)
        print(f"seed {seed}: {info['outcome']}, {info['progress_m']:.0f} m, reward {total:.2f}")
    env.save("last_episode.yaml")
    print("understory fly last_episode.yaml --report flies the last one again: digest", info["digest"])
