"""Several environments at once, each in a process of its own, with observations in shared memory."""

from __future__ import annotations

import contextlib
import enum
import mmap
import multiprocessing
import os
import signal
import sys
import traceback
from multiprocessing import reduction
from typing import Any, Iterator, Mapping, Optional, Sequence

import numpy as np

from .spaces import batched, checked_actions

try:
    from gymnasium.vector import AutoresetMode
except ImportError:

    class AutoresetMode(enum.Enum):  # type: ignore[no-redef]
        """What follows an episode's end: values as in gymnasium.vector.AutoresetMode."""

        NEXT_STEP = "NextStep"
        SAME_STEP = "SameStep"
        DISABLED = "Disabled"


_ALIGNED = 64


def _layout(space: Any, count: int) -> tuple[list[tuple[str, tuple[int, ...], str, int]], int]:
    """Name, shape, type and offset of each array in the shared memory, and its size."""
    arrays, offset = [], 0
    for name, one in space.items():
        shape = (count, *one.shape)
        arrays.append((name, shape, one.dtype.str, offset))
        offset += -(-int(np.prod(shape)) * one.dtype.itemsize // _ALIGNED) * _ALIGNED
    return arrays, max(offset, _ALIGNED)


def _arrays(memory: mmap.mmap, layout: list[tuple[str, tuple[int, ...], str, int]]) -> dict[str, np.ndarray]:
    return {name: np.ndarray(shape, dtype, memory, offset) for name, shape, dtype, offset in layout}


def _work(pipe: Any, memory_file: Any, size: int, layout: Any, index: int, settings: dict[str, Any]) -> None:
    """A worker: an environment that is told by the pipe and observes into the shared memory."""
    from .gym import FlightEnv

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches all processes of a terminal; this one is told
    descriptor = memory_file.detach()
    memory = mmap.mmap(descriptor, size)
    os.close(descriptor)
    rows = {name: array[index] for name, array in _arrays(memory, layout).items()}

    def show(observation: dict[str, np.ndarray]) -> None:
        for name, value in observation.items():
            rows[name][...] = value

    env: Optional[FlightEnv] = None
    try:
        env = FlightEnv(**settings)
        pipe.send(("ready", None))
        while True:
            order, given = pipe.recv()
            if order == "close":
                break
            if order == "reset":
                observation, info = env.reset(**given)
                show(observation)
                pipe.send(("done", info))
            elif order == "step":
                action, resets_at_once = given
                observation, reward, terminated, truncated, info = env.step(action)
                last = None
                if resets_at_once and (terminated or truncated):
                    last = (observation, info)
                    observation, info = env.reset()
                show(observation)
                pipe.send(("done", (reward, terminated, truncated, info, last)))
            elif order == "save":
                try:
                    env.save(given)
                    pipe.send(("done", None))
                except (OSError, RuntimeError) as error:  # the episode goes on
                    pipe.send(("done", f"{type(error).__name__}: {error}"))
    except EOFError:  # the process that told it has ended
        pass
    except BaseException as error:  # told in one line; what led to it goes to standard error
        traceback.print_exc()
        pipe.send(("failed", f"{type(error).__name__}: {error}"))
    finally:
        if env is not None:
            env.close()


class VectorEnv:
    """`count` environments at once, after the API of gymnasium.vector.VectorEnv.

    settings: the arguments of FlightEnv. autoreset_mode: a member or value of AutoresetMode: "NextStep" (the step
    after an episode's end resets and takes no action), "SameStep" (the same step resets; info has final_obs and
    final_info), "Disabled" (reset(options={"reset_mask": ...}) resets).
    copy: batches are copies; without, they are views of the shared memory that the next call overwrites.

    Workers are new processes, never forks of this one: OpenGL does not outlive a fork. They import the script that makes
    them, which therefore needs `if __name__ == "__main__":`. Parts of your own come to them through
    settings["plugins"]. A worker that dies is replaced; its episode ends as truncated, with the reason in
    infos["worker_died"]. Wrong arguments raise here and end no episode. It is no subclass of Gymnasium's VectorEnv.
    """

    def __init__(
        self,
        count: int,
        settings: Optional[Mapping[str, Any]] = None,
        autoreset_mode: Any = "NextStep",
        copy: bool = True,
    ) -> None:
        from .gym import FlightEnv

        if count < 1:
            raise ValueError(f"count: must be at least 1, got {count}")
        self._workers: list[Any] = []
        self._memory: Optional[mmap.mmap] = None
        self.num_envs = count
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self._copy = copy
        self._settings = dict(settings or {})
        one = FlightEnv(**self._settings)  # what is wrong with the settings shows here, in one line
        self.single_observation_space, self.single_action_space = one.observation_space, one.action_space
        self.metadata = {**one.metadata, "autoreset_mode": self.autoreset_mode}
        one.close()
        self.observation_space = batched(self.single_observation_space, count)
        self.action_space = batched(self.single_action_space, count)
        self._layout, self._size = _layout(self.single_observation_space, count)
        self._file = os.memfd_create("understory", os.MFD_CLOEXEC)  # no name: it ends with the last process
        os.ftruncate(self._file, self._size)
        self._memory = mmap.mmap(self._file, self._size)
        self._batch = _arrays(self._memory, self._layout)
        self._ended = np.zeros(count, bool)
        self._began = np.zeros(count, bool)
        self._spawn = multiprocessing.get_context("spawn")
        with self._whole_calls():
            self._workers = [self._start(index) for index in range(count)]
            for index in range(count):
                self._answer(index)

    def _start(self, index: int) -> tuple[Any, Any]:
        ours, theirs = self._spawn.Pipe()
        # A file descriptor can be handed over only while a process is spawned.
        arguments = (theirs, _Descriptor(self._file), self._size, self._layout, index, self._settings)
        process = self._spawn.Process(target=_work, args=arguments, daemon=True)
        main = sys.modules["__main__"]
        if not os.path.exists(getattr(main, "__file__", None) or "."):
            del main.__file__  # a script on standard input is no file that a worker could import, and it needs none
        process.start()
        theirs.close()
        return process, ours

    def _answer(self, index: int) -> Any:
        """What a worker says. Raises _Died where it has ended."""
        process, pipe = self._workers[index]
        try:
            kind, value = pipe.recv()
        except (EOFError, OSError):
            process.join(10)
            raise _Died(f"worker {index} ended with status {process.exitcode}") from None
        if kind == "failed":
            process.join(10)
            raise _Died(value)
        return value

    def _tell(self, index: int, order: str, given: Any) -> None:
        try:
            self._workers[index][1].send((order, given))
        except (BrokenPipeError, OSError):
            pass  # its end shows where its answer is read

    def _replace(self, index: int) -> None:
        process, pipe = self._workers[index]
        pipe.close()
        process.kill()
        process.join(10)
        self._workers[index] = self._start(index)
        self._answer(index)

    def _observations(self) -> dict[str, np.ndarray]:
        return {name: array.copy() if self._copy else array for name, array in self._batch.items()}

    def reset(
        self, *, seed: int | Sequence[Optional[int]] | None = None, options: Optional[Mapping[str, Any]] = None
    ) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
        """Begin episodes. seed: of the first; the others follow, or one each. options: {"reset_mask": booleans} resets
        some only (autoreset mode Disabled)."""
        self._require_open()
        asked = dict(options or {})
        mask = np.asarray(asked.pop("reset_mask", np.ones(self.num_envs, bool)))
        if mask.shape != (self.num_envs,) or mask.dtype != bool:
            raise ValueError(f"options: reset_mask must be {self.num_envs} booleans")
        if asked:
            raise ValueError(f"options: may have reset_mask, got {sorted(asked)[0]!r}")
        if seed is None or isinstance(seed, (int, np.integer)):
            seeds = [None if seed is None else int(seed) + index for index in range(self.num_envs)]
        else:
            seeds = list(seed)
            if len(seeds) != self.num_envs:
                raise ValueError(f"seed: must be one number or {self.num_envs}, got {len(seeds)}")
        infos: dict[str, Any] = {}
        chosen = np.flatnonzero(mask)
        with self._whole_calls():
            for index in chosen:
                self._tell(index, "reset", {"seed": seeds[index]})
            for index in chosen:
                self._add(infos, index, self._reset_answer(index, seeds[index]))
                self._ended[index], self._began[index] = False, True
        return self._observations(), infos

    def _reset_answer(self, index: int, seed: Optional[int]) -> Any:
        """What a worker says to a reset; one that died before is replaced and asked again."""
        try:
            return self._answer(index)
        except _Died:
            self._replace(index)
            self._tell(index, "reset", {"seed": seed})
        return self._answer(index)

    @contextlib.contextmanager
    def _whole_calls(self) -> Iterator[None]:
        """A call that ends early leaves answers in the pipes: the environments are closed then."""
        try:
            yield
        except _Died as died:
            self.close()
            raise WorkerDied(str(died)) from None
        except BaseException:
            self.close()
            raise

    def step(
        self, actions: Any
    ) -> tuple[dict[str, np.ndarray], np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Fly one step in each. Returns batched observations, rewards, terminated, truncated, and infos."""
        self._require_open()
        if not self._began.all():
            raise RuntimeError("step() before reset(): reset all environments first")
        actions = checked_actions(actions, self.action_space.shape, "actions")
        if self.autoreset_mode is AutoresetMode.DISABLED and self._ended.any():
            ended = np.flatnonzero(self._ended).tolist()
            raise RuntimeError(f"step(): the episodes of {ended} have ended: reset them with options['reset_mask']")
        at_once = self.autoreset_mode is AutoresetMode.SAME_STEP
        resets = self._ended.copy()
        rewards = np.zeros(self.num_envs)
        terminated, truncated = np.zeros(self.num_envs, bool), np.zeros(self.num_envs, bool)
        infos: dict[str, Any] = {}
        with self._whole_calls():
            for index in range(self.num_envs):
                order = ("reset", {"seed": None}) if resets[index] else ("step", (actions[index], at_once))
                self._tell(index, *order)
            for index in range(self.num_envs):
                if resets[index]:
                    self._add(infos, index, self._reset_answer(index, None))
                    self._ended[index] = False
                    continue
                try:
                    rewards[index], terminated[index], truncated[index], info, last = self._answer(index)
                except _Died as died:
                    truncated[index] = True
                    last_seen = {name: array[index].copy() for name, array in self._batch.items()}
                    self._add(infos, index, {"worker_died": str(died)})
                    self._replace(index)
                    if at_once:
                        self._tell(index, "reset", {"seed": None})
                        info = {"worker_died": str(died)}
                        self._add(infos, index, {**self._answer(index), "final_obs": last_seen, "final_info": info})
                    self._ended[index] = not at_once
                    continue
                self._add(infos, index, info)
                if last is not None:
                    self._add(infos, index, {"final_obs": last[0], "final_info": last[1]})
                self._ended[index] = (terminated[index] or truncated[index]) and not at_once
        return self._observations(), rewards, terminated, truncated, infos

    def _add(self, infos: dict[str, Any], index: int, info: Mapping[str, Any]) -> None:
        """Infos as arrays over the environments, with a mask `_name` beside each."""
        for name, value in info.items():
            if name not in infos:
                number = isinstance(value, (int, float)) and not isinstance(value, bool)
                kind = type(value) if number else object
                infos[name] = np.zeros(self.num_envs, kind) if number else np.full(self.num_envs, None, kind)
                infos["_" + name] = np.zeros(self.num_envs, bool)
            infos[name][index] = value
            infos["_" + name][index] = True

    def save(self, index: int, file: str | os.PathLike) -> None:
        """FlightEnv.save of one environment, of the episode that it is in: with SameStep that is the one begun anew."""
        self._require_open()
        self._tell(index, "save", os.path.abspath(os.fspath(file)))
        with self._whole_calls():
            fault = self._answer(index)
        if fault is not None:
            raise RuntimeError(f"save: {fault}")

    def _require_open(self) -> None:
        if self._memory is None:
            raise RuntimeError("the environments are closed")

    def close(self) -> None:
        """End all workers. May be called twice."""
        if self._memory is None:
            return
        for index in range(len(self._workers)):
            self._tell(index, "close", None)
        for process, pipe in self._workers:
            process.join(10)
            if process.is_alive():
                process.kill()
                process.join(10)
            pipe.close()
        self._workers = []
        self._batch = {}
        self._memory = None
        os.close(self._file)

    def __enter__(self) -> VectorEnv:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __del__(self) -> None:
        try:
            self.close()
        except Exception:  # the interpreter is going down
            pass


class WorkerDied(RuntimeError):
    """A worker ended where no episode can be truncated: when it began, or twice in a reset. The environments are closed.
    A script that makes a VectorEnv needs `if __name__ == "__main__":`, since each worker imports it."""


class _Died(Exception):
    """A worker has ended."""


class _Descriptor:
    """A file descriptor as an argument of a process that is being spawned."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor

    def __reduce__(self) -> Any:
        return _detached, (reduction.DupFd(self._descriptor),)


def _detached(given: Any) -> Any:
    return given
