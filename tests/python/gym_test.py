"""The environments keep Gymnasium's contract: what its check_env asks for, asked here without it."""

import copy
import pickle
import unittest

import numpy as np

from tests.python.support import SHORT, InFolder, native
from understory.gym import OBSERVATIONS, FlightEnv

CHEAP = {"scenario": "forest", "set": SHORT, "observe": ("imu", "gravity", "map"), "detector": "true_depth"}
ALL = {"scenario": "forest", "set": SHORT, "observe": OBSERVATIONS, "render_mode": "rgb_array"}


def same(one, other):
    return one.keys() == other.keys() and all(np.array_equal(one[name], other[name]) for name in one)


def shares(one, other):
    return any(np.shares_memory(a, b) for a in one.values() for b in other.values())


class Contract(InFolder):
    def test_spaces_hold_what_is_returned_and_no_array_is_shared(self):
        env = FlightEnv(**ALL)
        env.action_space.seed(1)
        env.observation_space.seed(1)
        self.assertTrue(env.observation_space.contains(env.observation_space.sample()))
        before, info = env.reset(seed=1003)
        self.assertTrue(env.observation_space.contains(before))
        self.assertEqual(info["flight_seed"], 1003)
        for _ in range(60):
            action = env.action_space.sample()
            self.assertTrue(env.action_space.contains(action))
            observation, reward, terminated, truncated, info = env.step(0.1 * action)
            self.assertTrue(env.observation_space.contains(observation))
            self.assertFalse(shares(before, observation))
            self.assertIs(type(reward), float)
            self.assertIs(type(terminated), bool)
            self.assertIs(type(truncated), bool)
            before = observation
        self.assertEqual(env.render().shape, (480, 640, 3))
        env.close()
        env.close()

    def test_a_seed_decides_an_episode(self):
        def episode(env, seed):
            observation, _ = env.reset(seed=seed)
            seen, total = [observation], 0.0
            for step in range(40):
                observation, reward, *_ = env.step(np.array([0.3 * np.sin(step), 0.1], np.float32))
                seen.append(observation)
                total += reward
            return seen, total

        env, other = FlightEnv(**CHEAP), FlightEnv(**CHEAP)
        one, again, elsewhere, different = episode(env, 5), episode(env, 5), episode(other, 5), episode(other, 6)
        for a, b, c in zip(one[0], again[0], elsewhere[0]):
            self.assertTrue(same(a, b) and same(a, c))
        self.assertEqual(one[1], again[1])
        self.assertFalse(all(same(a, b) for a, b in zip(one[0], different[0])))

    def test_looking_changes_nothing(self):
        def digest(**more):
            env = FlightEnv(**{**CHEAP, **more})
            env.reset(seed=1003)
            while True:
                _, _, terminated, truncated, info = env.step([0.0, 0.0])
                if "render_mode" in more:
                    env.render()
                if terminated or truncated:
                    return info["digest"]

        self.assertEqual(digest(), digest(render_mode="rgb_array", observe=("images", "depth", "map")))

    def test_a_seed_decides_the_episodes_after_it(self):
        def seeds(env):
            return [env.reset(seed=7)[1]["flight_seed"]] + [env.reset()[1]["flight_seed"] for _ in range(3)]

        self.assertEqual(seeds(FlightEnv(**CHEAP)), seeds(FlightEnv(**CHEAP)))

    def test_endings_are_terminated_or_truncated_and_rewarded(self):
        def ended(settings, action):
            env = FlightEnv(scenario="clear", observe=("gravity",), set={"forest.length_m": 20, **settings})
            env.reset(seed=1000)
            total = 0.0
            while True:
                _, reward, terminated, truncated, info = env.step(action)
                total += reward
                if terminated or truncated:
                    return info["outcome"], terminated, truncated, round(total, 1)

        self.assertEqual(ended({}, [0, 0]), ("goal", True, False, 2.0))
        self.assertEqual(ended({"time_limit_s": 1.5}, [0, 0])[:3], ("time", False, True))
        outcome, terminated, truncated, total = ended({}, [1, -1])
        self.assertIn(outcome, ("ground", "out_of_bounds"))
        self.assertEqual((terminated, truncated), (True, False))
        self.assertLess(total, 0)

    def test_an_episode_flies_again_natively(self):
        for more in ({}, {"observe": ("images", "imu")}, {"observe": ("map",), "act": "control", "step": "control"}):
            env = FlightEnv(**{**CHEAP, **more})
            env.reset(seed=1003)
            while True:
                action = np.full(env.action_space.shape, 0.02)
                _, _, terminated, truncated, info = env.step(action)
                if terminated or truncated:
                    break
            file = self.folder / "episode.yaml"
            env.save(file)
            status = 0 if info["outcome"] == "goal" else 1
            self.assertEqual(native(file, status=status), info["digest"], more)

    def test_two_environments_in_one_process(self):
        train, test = FlightEnv(**CHEAP), FlightEnv(**CHEAP)
        train.reset(seed=1), test.reset(seed=2)
        for _ in range(10):
            train.step([0, 0]), test.step([0, 0])

    def test_a_copy_is_an_environment_of_its_own(self):
        env = FlightEnv(**CHEAP)
        expected = [env.reset(seed=5)[0]] + [env.step([0.2, 0.1])[0] for _ in range(10)]
        for copied in copy.copy(env), copy.deepcopy(env), pickle.loads(pickle.dumps(env)):
            with self.assertRaisesRegex(Exception, "reset"):
                copied.step([0, 0])
            again = [copied.reset(seed=5)[0]] + [copied.step([0.2, 0.1])[0] for _ in range(10)]
            self.assertTrue(all(same(a, b) for a, b in zip(expected, again)))
        env.step([0, 0])

    def test_gymnasiums_own_check(self):
        try:
            import gymnasium
            from gymnasium.utils.env_checker import check_env
        except ImportError:
            self.skipTest("gymnasium is not installed: its own check_env was not run")
        import understory

        gymnasium.register_envs(understory)
        check_env(gymnasium.make("understory/Forest-v0").unwrapped)


if __name__ == "__main__":
    unittest.main()
