"""What the compiled module holds. The package `understory` is its public face."""

from typing import Any, Optional, Sequence, Union, overload

import numpy as np

__version__: str

class InputError(ValueError): ...
class MachineError(RuntimeError): ...

class ImuSample:
    """Angular rate and acceleration minus gravity, body axes."""

    t_ns: int
    angular_rate_body_radps: np.ndarray
    specific_force_body_mps2: np.ndarray

class PitotSample:
    t_ns: int
    airspeed_mps: float

class BarometerSample:
    t_ns: int
    altitude_m: float

class MagnetometerSample:
    t_ns: int
    field_body_ut: np.ndarray

class GpsSample:
    """A fix, which arrives late: t_ns is the moment of measurement."""

    t_ns: int
    position_world_m: np.ndarray
    velocity_world_mps: np.ndarray

class ThrustSample:
    """The thrust commanded from t_ns on."""

    t_ns: int
    thrust_n: float

class ResightingSample:
    """An obstacle seen again nearer: how far its place has moved in between."""

    t_ns: int
    earlier_ns: int
    discrepancy_world_m: np.ndarray
    covariance_m2: np.ndarray

Sample = Union[
    ImuSample, PitotSample, BarometerSample, MagnetometerSample, GpsSample, ThrustSample, ResightingSample
]

class State:
    """The aircraft as an estimator believes it to be. Its world frame drifts slowly against the true one."""

    t_ns: int
    T_world_body: np.ndarray
    velocity_body_mps: np.ndarray
    angular_rate_body_radps: np.ndarray
    specific_force_body_mps2: np.ndarray
    gyro_bias_radps: np.ndarray
    wind_world_mps: np.ndarray
    altitude_m: float
    distance_flown_m: float
    @property
    def position_world_m(self) -> np.ndarray: ...
    @property
    def covariance(self) -> np.ndarray: ...
    def __init__(self) -> None: ...
    def copy(self) -> State: ...

class Truth:
    """The true state."""

    t_ns: int
    T_world_body: np.ndarray
    velocity_world_mps: np.ndarray
    angular_rate_body_radps: np.ndarray
    specific_force_body_mps2: np.ndarray
    wind_world_mps: np.ndarray
    left_elevon_rad: float
    right_elevon_rad: float
    thrust_n: float
    @property
    def position_world_m(self) -> np.ndarray: ...

class Controls:
    """Elevons (trailing edge up positive) and thrust."""

    left_elevon_rad: float
    right_elevon_rad: float
    thrust_n: float
    def __init__(self, left_elevon_rad: float = 0, right_elevon_rad: float = 0, thrust_n: float = 0) -> None: ...

class StereoRig:
    """A rectified pair. Pixel (0, 0) is the centre of the top left one; disparity is u_left - u_right."""

    name: str
    width_px: int
    height_px: int
    focal_px: float
    baseline_m: float
    center_left_x_px: float
    center_right_x_px: float
    center_y_px: float
    detection_depth_m: float
    infinity_disparity_px: float
    T_body_camera: np.ndarray
    def disparity_px(self, depth_m: Any) -> Any: ...
    def depth_m(self, disparity_px: Any) -> Any: ...

class StereoFrame:
    """A pair: uint8, (rows, columns); arrays cannot be written to."""

    t_ns: int
    left: np.ndarray
    right: np.ndarray
    def __init__(self, left: np.ndarray, right: np.ndarray, t_ns: int = 0) -> None: ...

class FlightState:
    """Where a plan starts: heights are above the ground, angles those of the velocity through the air."""

    position_world_m: np.ndarray
    wind_world_mps: np.ndarray
    speed_mps: float
    heading_rad: float
    climb_angle_rad: float
    bank_rad: float

class Plan:
    """points: rows of t_s, x, y, z (m), speed_mps, heading, climb angle, bank, commanded bank (rad), commanded climb
    (m/s). origin: straight, solved, kept or fallback. clearance_m: least free distance, +inf where nothing is near."""

    t_ns: int
    clearance_m: float
    origin: str
    points: np.ndarray

class PlanRequest:
    start: FlightState
    t_ns: int
    distance_flown_m: float
    outdated: bool
    points: np.ndarray

class Obstacle:
    name: str
    from_world: np.ndarray
    to_world: np.ndarray
    radius_m: float
    kind: str
    def __init__(
        self, name: str, from_world: Any, to_world: Any, radius_m: float, kind: str = "trunk"
    ) -> None: ...

class Key:
    """A key of a part of one's own: bool, whole number, number or word, by the type of its value."""

    @overload
    def __init__(self, name: str, value: Union[bool, str], meaning: str) -> None: ...
    @overload
    def __init__(self, name: str, value: float, minimum: float, maximum: float, meaning: str) -> None: ...

class Detector:
    def detect(self, frame: StereoFrame) -> np.ndarray: ...

class StateSource:
    def on(self, sample: Sample) -> None: ...
    def state(self) -> State: ...
    def state_at(self, t_ns: int) -> State: ...

class Planner:
    def plan(self, request: PlanRequest) -> Plan: ...
    def concerns(self, position_world: np.ndarray, plan: Plan) -> bool: ...

class PartContext:
    """What a detector or a state source is made from; it makes others only during that call."""

    rig: StereoRig
    config: dict[str, Any]
    seed: int
    obstacles: list[Obstacle]
    def make_detector(self, name: str) -> Detector: ...
    def make_state_source(self, name: str) -> StateSource: ...

class PlanningContext:
    """What a planner is made from, and judges ways with for as long as it lives."""

    config: dict[str, Any]
    seed: int
    minimum_clearance_m: float
    comfortable_clearance_m: float
    def fly(self, request: PlanRequest, commands: Sequence[Sequence[float]]) -> Plan: ...
    def make_planner(self, name: str) -> Planner: ...

class Scenario:
    name: str
    course: str
    seed: int
    detector: str
    planner: str
    goal_x_m: float
    half_width_m: float
    camera_rate_hz: int
    imu_rate_hz: int
    elevon_min_rad: float
    elevon_max_rad: float
    max_thrust_n: float
    rig: StereoRig
    def with_seed(self, seed: int) -> Scenario: ...
    def with_actions(self, file: str) -> Scenario: ...
    def text(self) -> str: ...

class Flight:
    frames: int
    scenario: Scenario
    rig: StereoRig
    t_ns: int
    in_flight: bool
    progress_m: float
    outcome: Optional[str]
    truth: Truth
    state: State
    plan: Plan
    controls: Controls
    obstacles: list[Obstacle]
    hits: np.ndarray
    map: np.ndarray
    frame: StereoFrame
    depth: np.ndarray
    objects: np.ndarray
    imu: Optional[ImuSample]
    pitot: Optional[PitotSample]
    barometer: Optional[BarometerSample]
    magnetometer: Optional[MagnetometerSample]
    gps: Optional[GpsSample]
    result: dict[str, Any]
    trajectory: np.ndarray
    def __init__(
        self,
        scenario: Scenario,
        detector: Any,
        state_source: Any,
        planner: Any,
        by_hand: bool,
        images: bool,
        record: bool,
        renderer: str,
    ) -> None: ...
    def advance(self, until: str) -> bool: ...
    def advance_control(self) -> bool: ...
    def advance_camera(self) -> bool: ...
    def tell(self, left_elevon_rad: float, right_elevon_rad: float, thrust_n: float) -> None: ...
    def command(self, bank_rad: float, climb_mps: float) -> None: ...
    def flown_actions(self) -> str: ...
    def observation(self, imu_rows: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]: ...
    def draw_images(self, draws: bool) -> None: ...
    def chase_view(self, width_px: int, height_px: int) -> np.ndarray: ...
    def page(self) -> str: ...
    def save_run(self, folder: str) -> None: ...

def add_detector(
    name: str, meaning: str, file: str, keys: list[Key], factory: Any, needs_images: bool, cost_s: float
) -> None: ...
def add_state_source(name: str, meaning: str, file: str, keys: list[Key], factory: Any) -> None: ...
def add_planner(name: str, meaning: str, file: str, keys: list[Key], factory: Any) -> None: ...
def add_course(name: str, meaning: str, file: str, keys: list[Key], factory: Any) -> None: ...
def hit_dtype() -> np.dtype[np.void]: ...
def point_dtype() -> np.dtype[np.void]: ...
def load_plugin(file: str) -> str: ...
def parts() -> dict[str, list[str]]: ...
def load_scenario(name: str, settings: list[str] = ..., with_files: list[str] = ...) -> Scenario: ...
def scenario_names() -> list[str]: ...
def data_root() -> str: ...
def keys() -> list[dict[str, str]]: ...
