"""Understory flies a small delta wing through simulated forests on its own stereo vision.

A flight in Python is the flight of `understory fly`, bit for bit::

    import understory
    flight = understory.Flight("forest", seed=3)
    while flight.step("camera"):
        print(flight.truth.position_world_m, len(flight.hits))
    print(flight.result["outcome"], flight.digest)

Body frame: x forward, y left, z up. World frame: x along the course, y to its left, z up. Units are SI and stand at
the end of each name. Bad input raises InputError (a ValueError), a machine that fails raises MachineError (a
RuntimeError), each with one line that says what was wrong.
"""

import sys as _sys
from typing import TYPE_CHECKING as _TYPE_CHECKING
from typing import Any as _Any

import _understory

from _understory import (
    Controls,
    FlightState,
    InputError,
    Key,
    MachineError,
    Obstacle,
    Plan,
    PlanRequest,
    Scenario,
    State,
    StereoFrame,
    StereoRig,
    Truth,
    __version__,
)

from .commands import Campaign, CommandFailed, Trial, Tuning, campaign, evaluate, gate, keys, record
from .flight import Flight, load_scenario
from .parts import _outlive_parts, _run_plugin, box, course, detector, hits, load_plugin, parts, planner, state_source, trunk

__all__ = [
    "Campaign",
    "CommandFailed",
    "Controls",
    "Flight",
    "FlightState",
    "InputError",
    "Key",
    "MachineError",
    "Obstacle",
    "Plan",
    "PlanRequest",
    "Scenario",
    "State",
    "StereoFrame",
    "StereoRig",
    "Trial",
    "Truth",
    "Tuning",
    "__version__",
    "box",
    "campaign",
    "course",
    "detector",
    "evaluate",
    "gate",
    "hit_dtype",
    "hits",
    "keys",
    "load_plugin",
    "load_scenario",
    "parts",
    "planner",
    "point_dtype",
    "record",
    "state_source",
    "trunk",
]

if _TYPE_CHECKING:
    import numpy as _np

    hit_dtype: _np.dtype[_np.void]
    point_dtype: _np.dtype[_np.void]


def __getattr__(name: str) -> _Any:
    """The types of records, made when they are asked for: numpy is imported then."""
    if name in ("hit_dtype", "point_dtype"):
        return getattr(_understory, name)()
    raise AttributeError(f"module 'understory' has no attribute '{name}'")


if "gymnasium" in _sys.modules:  # gymnasium.register_envs(understory) expects environments to be registered by then
    from . import gym as _gym  # noqa: F401
