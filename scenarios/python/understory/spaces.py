"""Spaces of observations and actions: Gymnasium's where it is installed, else these, which do the same."""

from __future__ import annotations

from typing import Any, Iterator, Mapping, Optional, Sequence

import numpy as np

try:
    from gymnasium.spaces import Box, Dict
except ImportError:

    class Box:  # type: ignore[no-redef]
        """Arrays of one shape and type between two bounds."""

        def __init__(self, low: Any, high: Any, shape: Optional[Sequence[int]] = None, dtype: Any = np.float32) -> None:
            self.dtype = np.dtype(dtype)
            self.shape = tuple(shape) if shape is not None else np.shape(low)
            self.low = np.full(self.shape, low, dtype=self.dtype)
            self.high = np.full(self.shape, high, dtype=self.dtype)
            self._random = np.random.default_rng()

        def seed(self, seed: Optional[int] = None) -> None:
            self._random = np.random.default_rng(seed)

        def sample(self) -> np.ndarray:
            """A random array of the space; where it has no bound, near 0."""
            if self.dtype.kind in "ui":
                return self._random.integers(self.low, self.high, endpoint=True, dtype=self.dtype)
            low, high = np.maximum(self.low, -1e3), np.minimum(self.high, 1e3)
            return self._random.uniform(low, high).astype(self.dtype)

        def contains(self, value: Any) -> bool:
            return (
                isinstance(value, np.ndarray)
                and value.shape == self.shape
                and np.can_cast(value.dtype, self.dtype)
                and bool(np.all(value >= self.low) and np.all(value <= self.high))
            )

        __contains__ = contains

        def __repr__(self) -> str:
            return f"Box{self.shape}, {self.dtype}"

    class Dict:  # type: ignore[no-redef]
        """Spaces by name."""

        def __init__(self, spaces: Mapping[str, Any]) -> None:
            self.spaces = dict(spaces)

        def seed(self, seed: Optional[int] = None) -> None:
            for index, space in enumerate(self.spaces.values()):
                space.seed(None if seed is None else seed + index)

        def sample(self) -> dict[str, Any]:
            return {name: space.sample() for name, space in self.spaces.items()}

        def contains(self, value: Any) -> bool:
            return (
                isinstance(value, dict)
                and value.keys() == self.spaces.keys()
                and all(space.contains(value[name]) for name, space in self.spaces.items())
            )

        __contains__ = contains

        def __getitem__(self, name: str) -> Any:
            return self.spaces[name]

        def __iter__(self) -> Iterator[str]:
            return iter(self.spaces)

        def keys(self) -> Any:
            return self.spaces.keys()

        def items(self) -> Any:
            return self.spaces.items()

        def __repr__(self) -> str:
            return f"Dict({self.spaces})"


def checked_action(given: Any, shape: tuple[int, ...]) -> np.ndarray:
    """The action as numbers. Raises ValueError at another shape, and where one lies beyond -1 and 1 or is no number."""
    values = np.asarray(given, dtype=float)
    if values.shape != shape:
        raise ValueError(f"action: must have shape {shape}, got {values.shape}")
    if not np.abs(values).max() <= 1:
        raise ValueError(f"action: must lie within -1 and 1, got {values.tolist()}")
    return values
