"""The commands of the program from Python: each runs `understory`, and reads what it leaves."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, Mapping, NamedTuple, Optional, Sequence

import _understory

if TYPE_CHECKING:
    import numpy as np

from .flight import settings_of


class CommandFailed(RuntimeError):
    """A command ended with an error: status 2 for bad input, 3 for a machine that failed."""

    def __init__(self, status: int, message: str) -> None:
        super().__init__(message)
        self.status = status


def program() -> str:
    """The program that belongs to this module: $UNDERSTORY_PROGRAM, beside the build tree's module, else in PATH."""
    given = os.environ.get("UNDERSTORY_PROGRAM")
    if given:
        return given
    module = Path(_understory.__file__).resolve() if getattr(_understory, "__file__", None) else None
    if module is not None:
        for folder in (module.parent.parent, *(parent / "bin" for parent in module.parents)):
            if os.access(folder / "understory", os.X_OK) and (folder / "understory").is_file():
                return str(folder / "understory")
    import shutil

    found = shutil.which("understory")
    if found is None:
        raise FileNotFoundError("the program understory was not found: install it, or set UNDERSTORY_PROGRAM")
    return found


def run(arguments: Sequence[str | os.PathLike], quiet: bool = True, accepted: Sequence[int] = (0,)) -> tuple[int, str]:
    """Run a command. Returns its status and what it printed. Raises CommandFailed at a status that is not accepted."""
    import subprocess

    command = [program(), *[os.fspath(argument) for argument in arguments]]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE if quiet else None, text=True
    ) as process:
        try:
            printed, complained = process.communicate()
        except BaseException:
            process.terminate()
            raise
    if process.returncode not in accepted:
        lines = (complained or printed or "").strip().splitlines()
        message = lines[-1] if lines else f"{' '.join(command)} ended with status {process.returncode}"
        raise CommandFailed(process.returncode, message.removeprefix("understory: "))
    if not quiet:
        sys.stdout.write(printed)
    return process.returncode, printed


def _options(set: Optional[Mapping[str, Any]], plugins: Sequence[str | os.PathLike], **named: Any) -> list[str]:
    """named: options by their names, left out where None."""
    options = []
    for setting in settings_of(set):
        options += ["--set", setting]
    for plugin in plugins:
        options += ["--plugin", os.fspath(plugin)]
    for name, value in named.items():
        if value is not None:
            options += [f"--{name}", os.fspath(value) if isinstance(value, os.PathLike) else str(value)]
    return options


class Campaign:
    """A campaign's folder: rows, summary and page of its flights."""

    def __init__(self, folder: str | os.PathLike) -> None:
        self.folder = Path(folder)
        if not (self.folder / "flights.csv").is_file():
            raise FileNotFoundError(f"{self.folder}: no flights.csv: not the folder of a campaign")

    @property
    def rows(self) -> np.ndarray:
        """A structured array, a record for each flight, fields as in flights.csv (docs/campaigns.md). A field is of
        numbers where all its cells are numbers or empty (nan), else of words; seeds are whole numbers."""
        import csv

        import numpy as np

        with open(self.folder / "flights.csv", encoding="utf-8", newline="") as file:
            names, *rows = list(csv.reader(file))
        fields = []
        for index, name in enumerate(names):
            cells = [row[index] for row in rows]
            if name == "seed":
                fields.append(np.array(cells, dtype=np.int64))
                continue
            try:
                if name in ("id", "condition", "reason", "outcome", "digest"):
                    raise ValueError
                fields.append(np.array([float(cell) if cell else np.nan for cell in cells]))
            except ValueError:
                fields.append(np.array(cells, dtype=str))
        array = np.empty(len(rows), dtype=[(name, field.dtype) for name, field in zip(names, fields)])
        for name, field in zip(names, fields):
            array[name] = field
        return array

    def to_pandas(self) -> Any:
        """The same as a pandas.DataFrame, where pandas is installed."""
        import pandas

        return pandas.read_csv(self.folder / "flights.csv")

    @property
    def page(self) -> Path:
        """The page of the campaign; `understory report` is run where there is none yet."""
        page = self.folder / "report.html"
        if not page.is_file():
            run(["report", self.folder])
        return page

    def __repr__(self) -> str:
        return f"<understory.Campaign {self.folder}>"


def campaign(
    file: str | os.PathLike | Mapping[str, Any],
    out: str | os.PathLike,
    set: Optional[Mapping[str, Any]] = None,
    plugins: Sequence[str | os.PathLike] = (),
    jobs: Optional[int] = None,
    resume: bool = False,
    quiet: bool = True,
) -> Campaign:
    """Fly a campaign: a file, a name of the library, or what would stand in the file as a dictionary,
    {"scenario": "forest", "seeds": "1000..1019"}. Equals `understory campaign`. Flights that could not be flown have a
    reason in their rows."""
    options = _options(set, plugins, out=os.fspath(out), jobs=jobs)
    if resume:
        options.append("--resume")
    if isinstance(file, Mapping):
        import tempfile

        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "campaign.yaml"
            path.write_text(json.dumps(dict(file)), encoding="utf-8")  # JSON is YAML
            run(["campaign", path, *options], quiet, (0, 1))
    else:
        run(["campaign", file, *options], quiet, (0, 1))
    return Campaign(out)


def gate(
    baseline: str | os.PathLike | Campaign,
    candidate: str | os.PathLike | Campaign,
    margin: float = 0.05,
    quiet: bool = True,
) -> dict[str, Any]:
    """The gate's verdict on two campaigns, as `understory gate --json` writes it: "passes", "verdict", "sentence",
    counts and intervals."""
    import tempfile

    folders = [one.folder if isinstance(one, Campaign) else one for one in (baseline, candidate)]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "gate.json"
        options = ["--margin", str(margin), "--json", file]
        run(["gate", "--baseline", folders[0], "--candidate", folders[1], *options], quiet, (0, 1, 4))
        return json.loads(file.read_text(encoding="utf-8"))


def evaluate(
    inputs: str | os.PathLike | Sequence[str | os.PathLike],
    out: str | os.PathLike,
    set: Optional[Mapping[str, Any]] = None,
    plugins: Sequence[str | os.PathLike] = (),
    detectors: Sequence[str] = (),
    disparities: Optional[Mapping[str, str | os.PathLike]] = None,
    curves: Sequence[str] = (),
    every: int = 1,
    quiet: bool = True,
) -> dict[str, Any]:
    """Compare detections on recordings with true depth: Understory's detectors, those of plug-ins by name, and
    disparities of other programs, {name: folder}; with further curves of precision over recall,
    "perception.edges.limit=1,2,4". Equals `understory evaluate`; returns evaluation.json."""
    folders = [inputs] if isinstance(inputs, (str, os.PathLike)) else list(inputs)
    options = _options(set, plugins)
    for name in detectors:
        options += ["--detector", name]
    for curve in curves:
        options += ["--curve", curve]
    for name, folder in dict(disparities or {}).items():
        options += ["--disparities", f"{name}={os.fspath(folder)}"]
    run(["evaluate", *folders, "--out", out, "--every", str(every), *options], quiet)
    return json.loads((Path(out) / "evaluation.json").read_text(encoding="utf-8"))


class Trial(NamedTuple):
    """A trial of a search: its number, and a value for each key."""

    number: int
    values: dict[str, float]


class Tuning:
    """A tuning step by step (docs/tuning.md): ask() and tell() are the search of the file, and figures may come from
    anywhere; measure() is the judge of the file, and values may come from anywhere. Recordings are read when they are
    measured first, and held. Close it, or use it in a `with` statement::

        with understory.Tuning("long.yaml") as tuning:
            while trial := tuning.ask():
                tuning.tell(trial, tuning.measure(trial.values))
            print(tuning.best)
    """

    def __init__(
        self,
        file: str | os.PathLike,
        out: Optional[str | os.PathLike] = None,
        plugins: Sequence[str | os.PathLike] = (),
        jobs: Optional[int] = None,
    ) -> None:
        import subprocess

        options = _options(None, plugins, out=out, jobs=jobs)
        command = [program(), "tune", os.fspath(file), "--ask", *options]
        pipe = subprocess.PIPE
        self._process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=pipe, text=True)
        about = self._answer()
        self.parameters: list[dict[str, Any]] = about["parameters"]
        """Each with "key", "whole", and either "from", "to" and "log", or "values"."""
        self.figures: list[str] = about["figures"]
        self.maximize: list[str] = about["maximize"]
        self.minimize: list[str] = about["minimize"]
        self.scenario: dict[str, float] = about["scenario"]
        """The values of the scenario as it is."""
        self.best: Optional[Trial] = None
        """The best trial told, that keeps the limits of the file."""
        self._told: dict[int, Trial] = {}

    def _answer(self) -> dict[str, Any]:
        line = self._process.stdout.readline()  # type: ignore[union-attr]
        if not line:
            complaint = self._process.stderr.read().strip()  # type: ignore[union-attr]
            raise CommandFailed(self._process.wait(), complaint.removeprefix("understory: "))
        answer = json.loads(line)
        if "error" in answer:
            raise _understory.InputError(answer["error"])
        return answer

    def _question(self, question: dict[str, Any]) -> dict[str, Any]:
        self._process.stdin.write(json.dumps(question) + "\n")  # type: ignore[union-attr]
        self._process.stdin.flush()  # type: ignore[union-attr]
        return self._answer()

    def ask(self) -> Optional[Trial]:
        """The next trial of the search; the same until it is told; None when all are told."""
        answer = self._question({"ask": True})
        return None if answer["trial"] is None else Trial(answer["trial"], answer["parameters"])

    def tell(self, trial: Trial, figures: Optional[Mapping[str, float]]) -> None:
        """The figures of the trial asked last, all of self.figures; None where it could not be measured."""
        answer = self._question({"tell": trial.number, "figures": None if figures is None else dict(figures)})
        self._told[trial.number] = trial
        self.best = self._told[answer["best"]] if answer["best"] else None

    def measure(self, values: Mapping[str, float], data: str = "training") -> Optional[dict[str, float]]:
        """The figures of any values on "training" or "validation" data, as `understory tune` measures them; None where
        the detector refuses the values."""
        answer = self._question({"measure": dict(values), "data": data})
        return answer.get("figures")

    def close(self) -> None:
        self._process.stdin.close()  # type: ignore[union-attr]
        self._process.wait()
        for pipe in (self._process.stdout, self._process.stderr):
            pipe.close()  # type: ignore[union-attr]

    def __enter__(self) -> Tuning:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def record(
    scenario: str | os.PathLike,
    out: str | os.PathLike,
    seed: Optional[int] = None,
    set: Optional[Mapping[str, Any]] = None,
    plugins: Sequence[str | os.PathLike] = (),
    path: Optional[str | os.PathLike] = None,
    quiet: bool = True,
) -> Path:
    """Record a flight, or cameras carried along the poses of `path`, as a EuRoC data set. Returns its folder. Equals
    `understory record`."""
    options = _options(set, plugins, out=os.fspath(out), seed=seed, path=path)
    run(["record", scenario, *options], quiet, (0, 1))
    return Path(out)


def keys() -> list[dict[str, str]]:
    """Every key of a scenario: key, default, unit, range, meaning. Equals `understory keys --json`."""
    return _understory.keys()
