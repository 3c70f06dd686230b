"""Parts of your own, written in Python: detectors, state sources, planners and courses.

A part is a class (or any callable) that makes it from a context, under a name that scenarios can give::

    @understory.detector("edges", keys=[understory.Key("depth_m", 8.0, 2.0, 50.0, "depth that is looked at")])
    class Edges:
        "Corners at one depth."                     # its meaning, for lists
        def __init__(self, context): ...            # context.rig, context.config["depth_m"], context.seed
        def detect(self, frame): ...                # frame.left, frame.right, frame.t_ns; returns hits(...)

`understory fly forest --plugin mine.py --set perception.detector=edges` flies it.
"""

from __future__ import annotations

import importlib.machinery
import os
import sys
import types
from typing import TYPE_CHECKING, Any, Callable, Sequence

import _understory

if TYPE_CHECKING:
    import numpy as np

_Factory = Callable[..., Any]


def _meaning(factory: _Factory) -> str:
    text = (factory.__doc__ or "").strip().splitlines()
    return text[0] if text else "no description"


def _file(factory: _Factory) -> str:
    """The file that a part was written in; parts typed into a session have none."""
    file = getattr(sys.modules.get(getattr(factory, "__module__", "")), "__file__", None)
    return "Python" if file is None else os.path.abspath(file)


def _registered(
    add: Callable[..., None], name: str, keys: Sequence[_understory.Key], *more: Any
) -> Callable[[_Factory], _Factory]:
    """The decorator that adds a part; more: what `add` takes after the factory."""

    def register(factory: _Factory) -> _Factory:
        add(name, _meaning(factory), _file(factory), list(keys), factory, *more)
        return factory

    return register


def detector(
    name: str,
    keys: Sequence[_understory.Key] = (),
    needs_images: bool = True,
    cost_s: float = 0.0,
) -> Callable[[_Factory], _Factory]:
    """Name a detector. The factory gets a context with rig, config, seed and make_detector(name); what it makes has
    detect(frame), which returns an array of hit_dtype, from top to bottom.

    cost_s: time that a pair costs the aircraft's computer, before perception.compute.factor.
    """
    return _registered(_understory.add_detector, name, keys, needs_images, float(cost_s))


def state_source(name: str, keys: Sequence[_understory.Key] = ()) -> Callable[[_Factory], _Factory]:
    """Name a state source. What the factory makes has on(sample), state() and state_at(t_ns), which return a State;
    context.make_state_source("filter") gives one of ours to build on."""
    return _registered(_understory.add_state_source, name, keys)


def planner(name: str, keys: Sequence[_understory.Key] = ()) -> Callable[[_Factory], _Factory]:
    """Name a planner. Its context is the one way to make a Plan, so that a planner needs a name. What the factory makes has plan(request), which returns a Plan: context.fly(request, commands)
    makes one from commands (bank_rad, climb_mps, duration_s), with its clearance_m. It may have
    concerns(position_world, plan): whether a new point of the map makes the plan outdated.
    counts: a dict of whole numbers of its own, for planner_counts of result.json."""
    return _registered(_understory.add_planner, name, keys)


def course(name: str, keys: Sequence[_understory.Key] = ()) -> Callable[[_Factory], _Factory]:
    """Name a course: a function of (seed, goal_x_m, **keys) that returns a list of Obstacle. Equal arguments must give
    equal obstacles."""
    return _registered(_understory.add_course, name, keys)


def trunk(x_m: float, y_m: float, radius_m: float = 0.15, height_m: float = 12.0, name: str = "trunk") -> Any:
    """An upright trunk on the ground at (x_m, y_m)."""
    return _understory.Obstacle(name, [x_m, y_m, 0.0], [x_m, y_m, height_m], radius_m)


def box(
    position_m: Any, size_m: Any, rotation_rad: Any = (0.0, 0.0, 0.0), name: str = "box"
) -> _understory.Obstacle:
    """A box: its middle, its size along its own axes, turned by roll, pitch and yaw, as in `obstacles` of a scenario."""
    return _understory.box(name, position_m, size_m, rotation_rad)


def hits(
    rig: _understory.StereoRig,
    columns_px: Any,
    rows_px: Any,
    disparities_px: Any,
    scores: Any = 0.0,
    block_px: int = 5,
) -> np.ndarray:
    """Hits from blocks of the left image, sorted from top to bottom: an array of hit_dtype.

    columns_px, rows_px: top left corner of each block; disparities_px: u_left - u_right; one number stands for all.
    """
    import numpy as np

    columns, rows, disparities = np.broadcast_arrays(
        np.atleast_1d(np.asarray(columns_px, dtype=np.int32)),
        np.asarray(rows_px, dtype=np.int32),
        np.asarray(disparities_px, dtype=float),
    )
    if columns.ndim != 1:
        raise ValueError(f"columns_px, rows_px and disparities_px must have one dimension, got shape {columns.shape}")
    if not np.all(disparities > rig.infinity_disparity_px):
        raise ValueError(f"disparities_px must be more than the rig's {rig.infinity_disparity_px:.2f} px of infinity")
    depths = rig.depth_m(disparities)
    middle = 0.5 * (block_px - 1)
    array = np.zeros(len(columns), dtype=_understory.hit_dtype())
    array["column_px"], array["row_px"], array["disparity_px"] = columns, rows, disparities
    array["score"] = scores
    array["position_camera"][:, 0] = (columns + middle - rig.center_left_x_px) * depths / rig.focal_px
    array["position_camera"][:, 1] = (rows + middle - rig.center_y_px) * depths / rig.focal_px
    array["position_camera"][:, 2] = depths
    farther = np.maximum(disparities - 1, rig.infinity_disparity_px)
    array["near_m"] = rig.depth_m(disparities + 1)
    with np.errstate(divide="ignore"):
        array["far_m"] = rig.depth_m(farther)  # infinite where a pixel less reaches infinity
    return array[np.lexsort((array["column_px"], array["row_px"]))]


def load_plugin(file: str | os.PathLike) -> str:
    """Load a plug-in, a shared library or a Python file, whose parts scenarios can then name. Returns its path."""
    return _understory.load_plugin(os.fspath(file))


def parts() -> dict[str, list[str]]:
    """Names of all parts, by kind."""
    return _understory.parts()


_folders: list[str] = []  # of plug-ins
_imported: list[str] = []  # files of modules there, as they were read


class _FromSource(importlib.machinery.SourceFileLoader):
    """Compiles what it reads: compiled files beside a module may be of an older text of the same second."""

    def get_code(self, fullname: str) -> Any:
        _imported.append(self.path)
        return self.source_to_code(self.get_data(self.path), self.path)


class _Extension(importlib.machinery.ExtensionFileLoader):
    def create_module(self, spec: Any) -> Any:
        _imported.append(self.path)
        return super().create_module(spec)


def _finder(path: str) -> Any:
    """Finds modules beside and below plug-ins, packages that are installed there excepted."""
    below = any(path == folder or path.startswith(folder + os.sep) for folder in _folders)
    if not below or "-packages" in path:
        raise ImportError
    return importlib.machinery.FileFinder(
        path,
        (_Extension, importlib.machinery.EXTENSION_SUFFIXES),
        (_FromSource, importlib.machinery.SOURCE_SUFFIXES),
    )


def _run_plugin(file: str, text: bytes) -> list[str]:
    """Run a plug-in's text as a module; its decorators add the parts. Returns the files of the modules there that it imported."""
    name = "understory_plugin_" + os.path.splitext(os.path.basename(file))[0]  # no name of another module
    folder = os.path.dirname(file)
    if _finder not in sys.path_hooks:
        sys.path_hooks.insert(0, _finder)
    if folder not in _folders:
        _folders.append(folder)
        sys.path_importer_cache.pop(folder, None)
    if folder not in sys.path:
        sys.path.append(folder)  # for modules beside it
    module = types.ModuleType(name)
    module.__file__ = file
    sys.modules[name] = module
    before = len(_imported)
    try:
        exec(compile(text, file, "exec", dont_inherit=True), module.__dict__)
    except BaseException:
        sys.modules.pop(name, None)
        raise
    return sorted(set(_imported[before:]))


def _outlive_parts() -> None:
    """Make os._exit() an error of the part that calls it; processes that it has forked may end so. Called by the program."""
    really_exit, process = os._exit, os.getpid()

    def exit_(status: int) -> Any:
        if os.getpid() == process:
            raise SystemExit(status)
        really_exit(status)

    os._exit = exit_
