"""Flights as environments, after the API of Gymnasium 1.x. Gymnasium itself is not needed.

    from understory.gym import FlightEnv
    env = FlightEnv("forest", observe=("imu", "airspeed", "altitude", "gravity", "map"))
    observation, info = env.reset(seed=1000)
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())

Where Gymnasium is installed: `gymnasium.make("understory/Forest-v0")` after `import gymnasium, understory.gym`.
"""

from __future__ import annotations

import copy
import functools
import os
from typing import Any, Callable, Mapping, Optional, Sequence

import numpy as np

import _understory

from .flight import load_scenario, save_scenario
from .parts import load_plugin
from .spaces import Box, Dict, checked_action

try:
    import gymnasium

    _Base: Any = gymnasium.Env
except ImportError:
    gymnasium = None
    _Base = object

__all__ = ["FlightEnv"]

OBSERVATIONS = ("images", "imu", "airspeed", "altitude", "gravity", "course", "hits", "map", "depth")
MAXIMUM_BANK_RAD = 1.2
MAXIMUM_CLIMB_MPS = 3.0
MOST_HITS = 256
MOST_POINTS = 32
FAR_M = 100.0
CELL_M = 0.4


class FlightEnv(_Base):
    """One flight an episode: from the catapult's end to the goal, or to whatever ends it before.

    scenario: a file, or a name of the library. set: keys over its own.
    detector, state_source: names of parts, objects are not accepted. Where nothing is observed that needs a detector,
        there is none; else it is the scenario's own. The planner makes no plans.
    plugins: files of parts that names may mean.
    observe: any of
        images    uint8 (2, rows, columns): the newest pair, left and right;
        imu       float32 (n, 6): angular rate (rad/s) and specific force (m/s^2) in body axes, the newest n samples,
                  oldest first; n is the IMU's rate over the rate of steps, rounded up, so that a sample may be seen
                  in two steps;
        airspeed  float32 (1,): m/s, as the pitot tube measures it;
        altitude  float32 (1,): m above the ground, as the estimator believes;
        gravity   float32 (3,): its direction in body axes, as the estimator believes;
        course    float32 (2,): offset to the left of the course, m, and heading, rad, as the estimator believes;
        hits      float32 (256, 3): detections in the newest pair, m, left camera's axes (x right, y down, z ahead); rows without one are 0;
        map       float32 (32, 3): the obstacle memory, one point for each cell of 0.4 m of the ground, the nearest
                  first, m, body axes; rows without one are (100, 0, 0);
        depth     float32 (rows, columns): true depth, m, at most 100.
    act: "command": bank and climb for the path follower, 1 is 1.2 rad (right wing down) and 3 m/s;
        "control": left and right elevon and thrust, -1 to 1 over the airframe's range.
    step: "camera": a step lasts until the next frame reaches the autopilot (1/120 s, longer where a frame is lost);
        "control": one control step (1/200 s).
    record: keep what the digest needs, which info has at the end; without it a step is cheaper.

    Reward of a step: (progress along the course in m) / (distance of the goal in m), + 1 at the goal, - 1 where the
    aircraft hits an obstacle or the ground, or leaves the course's sides or its altitude band (outcome out_of_bounds).
    These end an episode as terminated; the scenario's time limit ends it as truncated.

    reset() flies from the catapult, with surfaces neutral and no thrust, until the second frame after the aircraft takes
    controls (0.03 s). An action takes effect at the next control step. An observation holds only what has reached the
    autopilot, so images are one latency old.
    """

    def __new__(cls, *arguments: Any, **named: Any) -> FlightEnv:
        env = super().__new__(cls)
        env._made_with = copy.deepcopy((arguments, named))
        return env

    def __reduce__(self) -> Any:
        """Copied and pickled as Gymnasium's environments: made anew with the same arguments, not reset."""
        arguments, named = self._made_with
        return functools.partial(type(self), *arguments, **named), ()

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 120}

    def __init__(
        self,
        scenario: str | os.PathLike = "forest",
        set: Optional[Mapping[str, Any]] = None,
        observe: Sequence[str] = ("images", "imu", "airspeed", "altitude", "gravity"),
        act: str = "command",
        step: str = "camera",
        detector: Optional[str] = None,
        state_source: Optional[str] = None,
        render_mode: Optional[str] = None,
        record: bool = True,
        render_size: tuple[int, int] = (640, 480),
        plugins: Sequence[str | os.PathLike] = (),
    ) -> None:
        unknown = [name for name in observe if name not in OBSERVATIONS]
        if unknown:
            raise ValueError(f"observe: must be any of {', '.join(OBSERVATIONS)}, got {unknown[0]!r}")
        if act not in ("command", "control"):
            raise ValueError(f"act: must be 'command' or 'control', got {act!r}")
        if step not in ("camera", "control"):
            raise ValueError(f"step: must be 'camera' or 'control', got {step!r}")
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise ValueError(f"render_mode: must be 'rgb_array' or None, got {render_mode!r}")
        if len(render_size) != 2 or not all(isinstance(side, int) and 1 <= side <= 8192 for side in render_size):
            raise ValueError(f"render_size: must be two whole numbers from 1 to 8192, got {render_size!r}")
        for plugin in plugins:
            load_plugin(plugin)
        settings = {"autopilot.method": "straight", **dict(set or {})}
        if detector is None and not {"hits", "map"} & {*observe}:
            detector = "none"
        if detector is not None:
            settings["perception.detector"] = detector
        if state_source is not None:
            settings["estimation.source"] = state_source
        self._scenario = load_scenario(scenario, set=settings)
        self._observe = tuple(observe)
        self._act = act
        self._by_camera = step == "camera"
        self._record = record
        self._images = bool({"images", "depth"} & {*observe}) or render_mode is not None
        self._render_size = render_size
        self.render_mode = render_mode
        rates = (self._scenario.imu_rate_hz, self._scenario.camera_rate_hz)
        self._imu_rows = min(16, -(-rates[0] // rates[1])) if self._by_camera else 1
        self.metadata = {**self.metadata, "render_fps": rates[1] if self._by_camera else rates[0]}
        self.action_space = Box(-1.0, 1.0, (2 if act == "command" else 3,), np.float32)
        self.observation_space = Dict({name: self._space_of(name) for name in self._observe})
        elevons = (self._scenario.elevon_min_rad, self._scenario.elevon_max_rad)
        self._elevon_middle_rad, self._elevon_reach_rad = 0.5 * (elevons[0] + elevons[1]), 0.5 * (elevons[1] - elevons[0])
        self._max_thrust_n = self._scenario.max_thrust_n
        self._goal_m = self._scenario.goal_x_m
        self._core: Optional[_understory.Flight] = None
        self._ended = True
        self._progress_m = 0.0
        if gymnasium is None:
            self._np_random: Optional[np.random.Generator] = None

    def _space_of(self, name: str) -> Any:
        if name in ("images", "depth"):
            rig = self._scenario.rig
            size = (rig.height_px, rig.width_px)
            return Box(0, 255, (2, *size), np.uint8) if name == "images" else Box(0.0, FAR_M, size, np.float32)
        if name == "gravity":
            return Box(-1.0001, 1.0001, (3,), np.float32)
        shapes: dict[str, tuple[int, ...]] = {
            "imu": (self._imu_rows, 6),
            "airspeed": (1,),
            "altitude": (1,),
            "course": (2,),
            "hits": (MOST_HITS, 3),
            "map": (MOST_POINTS, 3),
        }
        return Box(-np.inf, np.inf, shapes[name], np.float32)

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[Mapping[str, Any]] = None
    ) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
        """Begin an episode. seed: also the flight's seed, so that the episode flies the course of `understory fly
        --seed`; without it the flight's seed is drawn. options={"flight_seed": n} sets this flight's seed and leaves the random
        generator as it is."""
        if gymnasium is not None:
            super().reset(seed=seed)
        elif seed is not None or self._np_random is None:
            self._np_random = np.random.default_rng(seed)
        asked = dict(options or {})
        flight_seed = asked.pop("flight_seed", seed)
        if asked:
            raise ValueError(f"options: may have flight_seed, got {sorted(asked)[0]!r}")
        if flight_seed is None:
            flight_seed = int(self.np_random.integers(1 << 32))
        self._core = None  # the flight before is let go first
        self._core = _understory.Flight(
            self._scenario.with_seed(int(flight_seed)), None, None, None, True, self._images, self._record, "osmesa"
        )
        flies = True
        self._core.draw_images(False)  # nobody looks from the catapult
        while flies and not self._core.in_flight:
            flies = self._core.advance_control()
        self._core.draw_images(True)
        frames = self._core.frames
        while flies and self._core.frames < frames + 2:  # the first of these was exposed on the catapult
            flies = self._core.advance_camera()
        self._ended = not flies
        self._progress_m = self._core.progress_m
        return self._observation(), {"flight_seed": int(flight_seed), "t_s": 1e-9 * self._core.t_ns}

    if gymnasium is None:

        @property
        def np_random(self) -> np.random.Generator:
            """The generator that flights' seeds are drawn from."""
            if self._np_random is None:
                self._np_random = np.random.default_rng()
            return self._np_random

        @property
        def unwrapped(self) -> FlightEnv:
            return self

        def __enter__(self) -> FlightEnv:
            return self

        def __exit__(self, *_: Any) -> None:
            self.close()

    def step(self, action: Any) -> tuple[dict[str, np.ndarray], float, bool, bool, dict[str, Any]]:
        """Fly one step with an action. Returns observation, reward, terminated, truncated, info."""
        core = self._core
        if core is None or self._ended:
            raise RuntimeError("step() before reset(): the episode has ended or none has begun")
        values = checked_action(action, self.action_space.shape)
        if self._act == "command":
            bank, climb = values.tolist()
            core.command(bank * MAXIMUM_BANK_RAD, climb * MAXIMUM_CLIMB_MPS)
        else:
            left, right, thrust = values.tolist()
            middle, reach = self._elevon_middle_rad, self._elevon_reach_rad
            core.tell(middle + left * reach, middle + right * reach, 0.5 * (thrust + 1) * self._max_thrust_n)
        flies = core.advance_camera() if self._by_camera else core.advance_control()
        progress_m = core.progress_m
        reward = (progress_m - self._progress_m) / self._goal_m
        self._progress_m = progress_m
        if flies:
            return self._observation(), reward, False, False, {}
        self._ended = True
        outcome = core.outcome
        truncated = outcome == "time"
        if not truncated:
            reward += 1.0 if outcome == "goal" else -1.0
        info = {"outcome": outcome, "progress_m": progress_m, "flight_seed": core.scenario.seed}
        if self._record:
            info["digest"] = core.result["digest"]
        return self._observation(), reward, not truncated, truncated, info

    def _observation(self) -> dict[str, np.ndarray]:
        core = self._core
        assert core is not None
        imu, air, gravity = core.observation(self._imu_rows)
        of: dict[str, Callable[[], np.ndarray]] = {
            "imu": lambda: imu,
            "airspeed": lambda: air[:1],
            "altitude": lambda: air[1:2],
            "course": lambda: air[2:],
            "gravity": lambda: gravity,
            "images": lambda: self._images_of(core),
            "hits": lambda: _padded(core.hits["position_camera"], MOST_HITS, (0.0, 0.0, 0.0)),
            "map": lambda: _map_of(core),
            "depth": lambda: _depth_of(core),
        }
        return {name: of[name]() for name in self._observe}  # only what is asked is worked out

    def _images_of(self, core: _understory.Flight) -> np.ndarray:
        frame = core.frame
        if frame.left.size == 0:  # none has come yet
            return np.zeros(self.observation_space["images"].shape, np.uint8)
        return np.stack((frame.left, frame.right))

    def render(self) -> Optional[np.ndarray]:
        """A picture from behind the aircraft, uint8 (rows, columns, 3); None without render_mode."""
        if self.render_mode is None:
            return None
        if self._core is None:
            raise RuntimeError("render() before reset(): there is nothing to draw")
        return np.ascontiguousarray(self._core.chase_view(*self._render_size)[:, :, ::-1])

    def save(self, file: str | os.PathLike) -> None:
        """Write the episode that has ended as a scenario, and its controls beside it: `understory fly FILE` flies it again,
        with the same digest. Before its end, the replay goes on with the last controls."""
        if self._core is None:
            raise RuntimeError("save() before reset(): there is no episode")
        save_scenario(self._core, file)

    def close(self) -> None:
        """Let the flight go. May be called twice."""
        self._core = None
        self._ended = True


def _padded(rows: np.ndarray, count: int, filler: tuple[float, float, float]) -> np.ndarray:
    array = np.empty((count, 3), np.float32)
    array[:] = filler
    array[: min(count, len(rows))] = rows[:count]
    return array


def _depth_of(core: _understory.Flight) -> np.ndarray:
    depth = core.depth
    return np.where(np.isfinite(depth), np.clip(depth, 0, FAR_M), FAR_M).astype(np.float32)


def _map_of(core: _understory.Flight) -> np.ndarray:
    """Points of the memory, one a cell, nearest first, body axes: a trunk that was seen often is a few points."""
    points = core.map["position_world"]
    if len(points) == 0:
        return _padded(points, MOST_POINTS, (FAR_M, 0.0, 0.0))
    cells = np.floor(points[:, :2] / CELL_M).astype(np.int64)
    points = points[np.unique(cells[:, 0] * 1_000_003 + cells[:, 1], return_index=True)[1]]
    pose = core.state.T_world_body
    body = (points - pose[:3, 3]) @ pose[:3, :3]
    order = np.argsort(np.einsum("ij,ij->i", body, body), kind="stable")[:MOST_POINTS]
    return _padded(body[order], MOST_POINTS, (FAR_M, 0.0, 0.0))


if gymnasium is not None:
    for _name, _scenario in (("Forest", "forest"), ("Woods", "woods"), ("Clear", "clear")):
        gymnasium.register(
            id=f"understory/{_name}-v0",
            entry_point="understory.gym:FlightEnv",
            kwargs={"scenario": _scenario},
        )
