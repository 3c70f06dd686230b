"""A flight that one can hold, step and ask."""

from __future__ import annotations

import html
import os
from numbers import Real
from typing import TYPE_CHECKING, Any, Mapping, Optional, Sequence

import _understory

if TYPE_CHECKING:
    import numpy as np


def settings_of(set: Optional[Mapping[str, Any]], **more: Any) -> list[str]:
    """Keys and values as `--set` takes them: numbers, words, truth values, lists of them."""

    def text(key: str, value: Any) -> str:
        if hasattr(value, "tolist"):  # of numpy
            value = value.tolist()
        if isinstance(value, bool):
            return "true" if value else "false"
        if isinstance(value, (Real, str)):
            return str(value)
        if isinstance(value, (list, tuple)):
            return "[" + ", ".join(text(key, one) for one in value) + "]"
        raise TypeError(f"{key}: must be a number, a word, a truth value or a list of them, got {type(value).__name__}")

    settings = [f"{key}={text(key, value)}" for key, value in dict(set or {}).items()]
    return settings + [f"{key}={text(key, value)}" for key, value in more.items() if value is not None]


def load_scenario(
    scenario: str | os.PathLike,
    seed: Optional[int] = None,
    set: Optional[Mapping[str, Any]] = None,
    with_files: Sequence[str | os.PathLike] = (),
    rig: Optional[str] = None,
) -> _understory.Scenario:
    """Read a scenario: a file, or a name of the library ("forest", "woods", "clear", ...).

    set: keys and values over the file's, as `--set` has them: {"forest.length_m": 30}. Raises InputError in one line
    that names file, line and key.
    """
    return _understory.load_scenario(
        os.fspath(scenario), settings_of(set, rig=rig, seed=seed), [os.fspath(file) for file in with_files]
    )


class Flight:
    """One flight of a scenario. It equals `understory fly` with the same scenario, seed and settings, bit for bit.

    scenario: a file, a name of the library, or a Scenario.
    seed, set, rig: over the scenario's own.
    detector, state_source, planner: a name that the scenario could give (ours, or one of a plug-in's), or an object of
        your own: a detector has detect(frame), a state source on(sample), state() and state_at(t_ns), a planner
        plan(request).
    by_hand: you fly, and the planner makes no plans: call command() or control(). Before the first call elevons and
        thrust are 0; on the catapult nothing has an effect (in_flight).
    images: render images even where no detector looks at them.
    record: keep what result, trajectory, digest and report() need; without it a step is cheaper.

    A flight belongs to the thread that makes it. Flights may be open side by side. Arrays of images share memory with
    the flight's frame, keep it alive, and cannot be written to; all other arrays are copies.
    """

    def __init__(
        self,
        scenario: str | os.PathLike | _understory.Scenario,
        seed: Optional[int] = None,
        set: Optional[Mapping[str, Any]] = None,
        rig: Optional[str] = None,
        detector: Any = None,
        state_source: Any = None,
        planner: Any = None,
        by_hand: bool = False,
        images: bool = False,
        record: bool = True,
        renderer: str = "osmesa",
    ) -> None:
        named = dict(set or {})
        objects: dict[str, Any] = {}
        for kind, key, given, methods in (
            ("detector", "perception.detector", detector, ("detect",)),
            ("state_source", "estimation.source", state_source, ("on", "state", "state_at")),
            ("planner", "autopilot.method", planner, ("plan",)),
        ):
            objects[kind] = None
            if isinstance(given, str):
                named[key] = given
                continue
            lacking = [] if given is None else [method for method in methods if not hasattr(given, method)]
            if isinstance(given, type):
                raise TypeError(f"{kind}: must be an object, got the class {given.__name__}: call it first")
            if lacking:
                raise TypeError(f"{kind}: must be a name or an object with {lacking[0]}(), got {type(given).__name__}")
            objects[kind] = given
        if isinstance(scenario, _understory.Scenario):
            if named or rig is not None:
                raise ValueError("a Scenario is complete: give set, rig and names of parts to load_scenario()")
            loaded = scenario if seed is None else scenario.with_seed(seed)
        else:
            loaded = load_scenario(scenario, seed, named, rig=rig)
        self._by_hand, self._record = by_hand, record
        self._has_objects = any(given is not None for given in objects.values())
        self._core = _understory.Flight(
            loaded,
            objects["detector"],
            objects["state_source"],
            objects["planner"],
            by_hand,
            images,
            record,
            renderer,
        )

    # What it does.

    def step(self, until: str = "camera") -> bool:
        """Fly on until the next step of "physics" (1/1200 s), of "control" (the IMU's rate), the next frame that the
        autopilot has looked at ("camera"), or the "end". False once the flight has ended."""
        return self._core.advance(until)

    def run(self) -> dict[str, Any]:
        """Fly to the end. Returns result."""
        self._core.advance("end")
        return self.result

    def control(self, left_elevon_rad: float, right_elevon_rad: float, thrust_n: float) -> None:
        """From the next control step on, hold these controls. Elevons: trailing edge up is positive. Values beyond the
        airframe's limits are held at the limits. Needs by_hand."""
        self._core.tell(left_elevon_rad, right_elevon_rad, thrust_n)

    def command(self, bank_rad: float, climb_mps: float) -> None:
        """From the next control step on, let the path follower fly this bank (right wing down positive) and climb.
        Needs by_hand."""
        self._core.command(bank_rad, climb_mps)

    # What it knows, at the time of truth.

    @property
    def scenario(self) -> _understory.Scenario:
        """The scenario that is flown."""
        return self._core.scenario

    @property
    def rig(self) -> _understory.StereoRig:
        """The stereo rig."""
        return self._core.rig

    @property
    def t_s(self) -> float:
        """Simulated time, s."""
        return 1e-9 * self._core.t_ns

    @property
    def in_flight(self) -> bool:
        """Whether the aircraft has left the catapult and takes controls."""
        return self._core.in_flight

    @property
    def outcome(self) -> Optional[str]:
        """goal, collision, ground, out_of_bounds or time; None while it flies."""
        return self._core.outcome

    @property
    def truth(self) -> _understory.Truth:
        """The true state: T_world_body (4x4), position_world_m, velocity_world_mps, angular_rate_body_radps,
        specific_force_body_mps2, wind_world_mps, left_elevon_rad, right_elevon_rad, thrust_n."""
        return self._core.truth

    @property
    def estimate(self) -> _understory.State:
        """The state that the autopilot believes: T_world_body (4x4), position_world_m, velocity_body_mps, altitude_m,
        covariance and more. Its world frame drifts slowly against the true one."""
        return self._core.state

    @property
    def controls(self) -> _understory.Controls:
        """Controls in force."""
        return self._core.controls

    @property
    def plan(self) -> _understory.Plan:
        """The plan in force: t_ns, origin, clearance_m, and points, rows of t_s, x, y, z, speed, heading, climb angle,
        bank, commanded bank, commanded climb (m, m/s, rad)."""
        return self._core.plan

    @property
    def obstacles(self) -> list[_understory.Obstacle]:
        """What stands in the way, truly."""
        return self._core.obstacles

    @property
    def left(self) -> np.ndarray:
        """Left image of the newest frame, uint8, (rows, columns); (0, 0) before the first, or without images."""
        return self._core.frame.left

    @property
    def right(self) -> np.ndarray:
        """Right image of the newest frame, as left."""
        return self._core.frame.right

    @property
    def frame_t_s(self) -> float:
        """Moment of the newest frame, s."""
        return 1e-9 * self._core.frame.t_ns

    @property
    def depth(self) -> np.ndarray:
        """True depth in the left image with the aircraft where it is now, float32, metres along the optical axis. The
        newest frame is at least one latency (8 ms, 9 cm of flight) older. Needs a detector that looks, or images=True."""
        return self._core.depth

    @property
    def objects(self) -> np.ndarray:
        """Numbers of the objects in the left image with the aircraft where it is now, uint16 (docs/record.md)."""
        return self._core.objects

    @property
    def hits(self) -> np.ndarray:
        """Detections in the newest frame, records of hit_dtype: position_camera (m; x right, y down, z ahead, left
        camera), column_px and row_px (top left corner of the block), disparity_px, score, edge_sum, near_m, far_m."""
        return self._core.hits

    @property
    def map(self) -> np.ndarray:
        """Points that the map remembers, records of point_dtype: position_world (m, the estimate's frame), t_ns, score,
        distance_flown_m, sightings."""
        return self._core.map

    @property
    def imu(self) -> Any:
        """The newest IMU sample that has reached the autopilot, or None before the first: t_ns,
        angular_rate_body_radps, specific_force_body_mps2."""
        return self._core.imu

    @property
    def pitot(self) -> Any:
        """The newest airspeed along body x: t_ns, airspeed_mps; None before the first."""
        return self._core.pitot

    @property
    def barometer(self) -> Any:
        """The newest height above the launch's ground: t_ns, altitude_m; None before the first."""
        return self._core.barometer

    @property
    def magnetometer(self) -> Any:
        """The newest field in body axes: t_ns, field_body_ut; None before the first."""
        return self._core.magnetometer

    @property
    def gps(self) -> Any:
        """The newest fix: t_ns (of the measurement), position_world_m, velocity_world_mps; None without GPS."""
        return self._core.gps

    # What it leaves.

    @property
    def result(self) -> dict[str, Any]:
        """All single values of result.json, once the flight has ended; lists are left out. Needs record=True."""
        return self._core.result

    @property
    def digest(self) -> str:
        """Hash of the flight's data: equal digests mean equal flights, bit for bit. As result, it
        needs the flight's end and record=True; so do report() and save_run()."""
        return self._core.result["digest"]

    @property
    def trajectory(self) -> np.ndarray:
        """Rows of t_s, position (3), quaternion w x y z, velocity (3), clearance_m: the truth, 200 a second."""
        return self._core.trajectory

    def chase_view(self, width_px: int = 640, height_px: int = 480) -> np.ndarray:
        """A picture from behind the aircraft, uint8, (rows, columns, 3), red first. Needs images."""
        return self._core.chase_view(width_px, height_px)[:, :, ::-1].copy()

    def report(self, file: Optional[str | os.PathLike] = None) -> str:
        """The flight's page: one HTML text that needs nothing else. With `file`, it is also written there."""
        page = self._core.page()
        if file is not None:
            with open(file, "w", encoding="utf-8") as stream:
                stream.write(page)
        return page

    def save_run(self, folder: str | os.PathLike) -> None:
        """Write the run folder that `understory fly --out` writes. The folder must be new or empty. A flight by hand
        has no run folder; use save()."""
        if self._by_hand:
            raise RuntimeError("a flight by hand has no run folder: save() writes a scenario that flies it again")
        self._require_named_parts()
        self._core.save_run(os.fspath(folder))

    def save(self, file: str | os.PathLike) -> None:
        """Write a scenario that flies this flight again: `understory fly FILE`. For a flight by hand, a second file
        beside it holds the controls: mine.yaml gets mine.actions.csv."""
        self._require_named_parts()
        save_scenario(self._core, file)

    def _require_named_parts(self) -> None:
        if self._has_objects:
            raise RuntimeError("no file can name an object: give parts by name (a plug-in) to save this flight")

    def _repr_html_(self) -> str:
        if self.outcome is None or not self._record:
            return f"<p>{self.scenario.name}, seed {self.scenario.seed}, {self.t_s:.2f} s flown</p>"
        page = html.escape(self.report(), quote=True)
        return f'<iframe srcdoc="{page}" width="100%" height="700" style="border:0"></iframe>'

    def __repr__(self) -> str:
        state = self.outcome or f"{self.t_s:.3f} s flown"
        return f"<understory.Flight {self.scenario.name}, seed {self.scenario.seed}: {state}>"


def save_scenario(core: _understory.Flight, file: str | os.PathLike) -> None:
    """Write the scenario of a flight, and the controls that were flown by hand beside it."""
    path = os.path.abspath(os.fspath(file))
    scenario = core.scenario
    scenario.require_files()
    try:
        actions = core.flown_actions()
    except RuntimeError:  # the planner flew
        actions = None
    if actions is not None:
        beside = os.path.splitext(path)[0] + ".actions.csv"
        with open(beside, "w", encoding="ascii") as stream:
            stream.write(actions)
        scenario = scenario.with_actions(os.path.basename(beside))
    with open(path, "w", encoding="utf-8") as stream:
        stream.write(scenario.text())
