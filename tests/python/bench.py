"""Speed of the Python module, as ratios by turns in one run: python3 -m tests.python.bench (docs/benchmarks.md).

PYTHONPATH and UNDERSTORY_PROGRAM as in CMakeLists.txt beside it. Takes about four minutes on a quiet machine.
"""

import json
import multiprocessing
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import understory
from tests.python.support import program
from understory.gym import FlightEnv

CAMERAS = {"scenario": "forest"}
BARE = {"observe": ("imu", "airspeed", "altitude", "gravity"), "act": "control", "step": "control", "record": False}


def native_loop_s(seed):
    """Wall time of the program's loop, without set-up."""
    with tempfile.TemporaryDirectory() as folder:
        program("fly", "forest", "--seed", seed, "--quiet", "--out", Path(folder) / "run")
        result = json.loads((Path(folder) / "run" / "result.json").read_text())
    return result["wall_s"] - sum(result["timings"][stage]["total_s"] for stage in ("setup", "context"))


def python_loop_s(seed):
    flight = understory.Flight("forest", seed=seed)
    begin = time.perf_counter()
    while flight.step("camera"):
        pass
    return time.perf_counter() - begin


def _stepping(barrier, seconds, seed):
    env = FlightEnv(**CAMERAS)
    env.reset(seed=seed)
    barrier.wait()
    begin = time.perf_counter()
    for _ in range(120):
        env.step((0.0, 0.0))
    seconds.put(time.perf_counter() - begin)


def side_by_side_s(count, seed):
    """Wall time of 120 steps in each of `count` processes that begin together."""
    context = multiprocessing.get_context("spawn")
    barrier, seconds = context.Barrier(count), context.Queue()
    processes = [context.Process(target=_stepping, args=(barrier, seconds, seed)) for _ in range(count)]
    for process in processes:
        process.start()
    slowest = max(seconds.get() for _ in processes)
    for process in processes:
        process.join()
    return slowest


def control_steps_per_s(scenario):
    env = FlightEnv(scenario, **BARE)
    action, steps, seconds = [0.0, 0.0, 0.6], 0, 0.0
    for seed in range(1000, 1012):
        env.reset(seed=seed)
        begin, over = time.perf_counter(), False
        while not over:
            _, _, terminated, truncated, _ = env.step(action)
            steps, over = steps + 1, terminated or truncated
        seconds += time.perf_counter() - begin
    return steps / seconds


def reset_ms(settings):
    env = FlightEnv("forest", **settings)
    env.reset(seed=1000)
    times = []
    for seed in range(1001, 1011):
        begin = time.perf_counter()
        env.reset(seed=seed)
        times.append(1e3 * (time.perf_counter() - begin))
    return statistics.median(times)


def wall_s(command, repeats=7):
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        subprocess.run(command, check=True, capture_output=True)
        times.append(time.perf_counter() - begin)
    return statistics.median(times)


def by_turns(one, other, turns):
    """Median of one's values over other's, turn by turn."""
    return statistics.median([one(turn) / other(turn) for turn in range(turns)])


def main():
    def show(what, value, digits=2):
        print(f"{what:75s} {value:10.{digits}f}", flush=True)

    show("stepping forest at camera rate, speed against the program's",
         by_turns(lambda turn: native_loop_s(1000 + turn), lambda turn: python_loop_s(1000 + turn), 7), 3)
    show("two environments with cameras side by side, a process each, against one",
         by_turns(lambda turn: 2 * side_by_side_s(1, 1000 + turn), lambda turn: side_by_side_s(2, 1000 + turn), 5))
    for scenario in ("clear", "forest"):
        show(f"control steps a second, one core, {scenario}",
             statistics.median([control_steps_per_s(scenario) for _ in range(3)]), 0)
    show("reset without cameras, ms", reset_ms(BARE), 1)
    show("reset with cameras, ms", reset_ms({}), 1)
    with tempfile.TemporaryDirectory() as folder:
        mine = Path(folder) / "mine.py"
        mine.write_text("import understory\n@understory.course('mine')\ndef mine(seed, goal_x_m): return []\n")
        executable = understory.commands.program()
        show("a plug-in in Python adds to a process, s",
             wall_s([executable, "plugin", str(mine)]) - wall_s([executable, "plugin"]), 3)
    bare, numpy = wall_s([sys.executable, "-c", "pass"]), wall_s([sys.executable, "-c", "import numpy"])
    show("import understory, s", wall_s([sys.executable, "-c", "import understory"]) - bare, 3)
    show("import numpy, for comparison, s", numpy - bare, 3)


if __name__ == "__main__":
    main()
