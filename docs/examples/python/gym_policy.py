"""A policy written by hand, through the Gymnasium API: of some banks, the one that leaves most room."""

import sys

import numpy as np

from understory.gym import MAXIMUM_BANK_RAD, FlightEnv

OBSERVE = ("altitude", "gravity", "course", "map")
BANKS_RAD = np.linspace(-1.0, 1.0, 21)
SPEED_MPS, LAG_S, HALF_WING_M, ENOUGH_M = 11.5, 0.2, 0.45, 0.8


def policy(observation):
    """Bank and climb, -1 to 1, from the points of the memory (body axes: x forward, y left, z up)."""
    offset_m, heading_rad = observation["course"]
    home_rad = np.clip(1.0 * heading_rad + 0.06 * offset_m, -0.6, 0.6)  # right wing down turns to the right
    down = observation["gravity"]
    roll = np.arctan2(down[1], -down[2])
    points = observation["map"]
    points = points[(points[:, 0] > 0.5) & (points[:, 0] < 15)]
    left_m = points[:, 1] * np.cos(roll) + points[:, 2] * np.sin(roll)  # level, whatever the bank
    t_s = np.maximum(points[:, 0] / SPEED_MPS - LAG_S, 0)
    costs = []
    for bank_rad in BANKS_RAD:
        way_m = -0.5 * 9.81 * np.tan(bank_rad) * t_s**2
        room_m = np.min(np.abs(left_m - way_m), initial=5.0) - HALF_WING_M
        costs.append(3 * max(0, ENOUGH_M - room_m) + (bank_rad - home_rad) ** 2)
    bank = BANKS_RAD[np.argmin(costs)] / MAXIMUM_BANK_RAD
    climb = 0.7 * (4.5 - observation["altitude"][0])
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
    for seed in range(1000, 1000 + (int(sys.argv[1]) if len(sys.argv) > 1 else 10)):
        total, info = fly(env, policy, seed)
        print(f"seed {seed}: {info['outcome']}, {info['progress_m']:.0f} m, reward {total:.2f}")
    env.save("last_episode.yaml")
    print("understory fly last_episode.yaml --report flies the last one again: digest", info["digest"])
