"""Parts in Python take part in the program's commands, and the examples of docs/examples/python work."""

import importlib.util
import json
import os
import shutil
import subprocess
import sys
import unittest

import understory
from tests.python.support import EXAMPLES, SOURCE, InFolder, native, program

HAS_OPENCV = importlib.util.find_spec("cv2") is not None
HAS_MYPY = shutil.which("mypy") is not None
SHORT = ["--set", "forest.length_m=20"]

MINE = '''
import understory

@understory.detector("wrapped", keys=[understory.Key("gain", 1.0, 0.1, 2.0, "does nothing"),
                                      understory.Key("count", 3, 0, 5, "a whole number"),
                                      understory.Key("flag", True, "yes or no"),
                                      understory.Key("word", "a", "any word")])
class Wrapped:
    "ours, wrapped"
    def __init__(self, context):
        assert context.config == {"gain": 0.5, "count": 3, "flag": True, "word": "a"}, context.config
        self.inner = context.make_detector("pushbroom")
    def detect(self, frame):
        return self.inner.detect(frame)

@understory.planner("wrapped_sst")
class Planner:
    "SST, wrapped"
    def __init__(self, context):
        self.inner = context.make_planner("sst")
        self.counts = {"asked": 0}
    def plan(self, request):
        self.counts["asked"] += 1
        return self.inner.plan(request)
    def concerns(self, position_world, plan):
        return self.inner.concerns(position_world, plan)

@understory.state_source("wrapped_filter")
class Source:
    "the filter, wrapped"
    def __init__(self, context):
        self.inner = context.make_state_source("filter")
    def on(self, sample):
        self.inner.on(sample)
    def state(self):
        return self.inner.state()
    def state_at(self, t_ns):
        return self.inner.state_at(t_ns)

@understory.course("two_trunks")
def two_trunks(seed, goal_x_m):
    "a gate of two trunks"
    return [understory.trunk(15, 2 + seed % 2), understory.trunk(15, -2)]
'''


class Plugins(InFolder):
    def setUp(self):
        super().setUp()
        self.mine = self.folder / "mine.py"
        self.mine.write_text(MINE)

    def fly(self, *settings):
        arguments = ["forest", "--seed", 1003, *SHORT, "--plugin", self.mine]
        for setting in settings:
            arguments += ["--set", setting]
        return native(*arguments)

    def test_our_parts_wrapped_have_our_digest(self):
        ours = native("forest", "--seed", 1003, *SHORT)
        self.assertEqual(self.fly("perception.detector=wrapped", "perception.wrapped.gain=0.5"), ours)
        self.assertEqual(self.fly("autopilot.method=wrapped_sst"), ours)
        self.assertEqual(self.fly("estimation.source=wrapped_filter"), ours)

    def test_a_planner_counts_by_name(self):
        program("fly", "forest", "--seed", 1003, *SHORT, "--plugin", self.mine, "--set",
                "autopilot.method=wrapped_sst", "--out", self.folder / "run", "--quiet")
        result = json.loads((self.folder / "run" / "result.json").read_text())
        self.assertEqual(result["planner_counts"], {"asked": result["replans"]})

    def test_a_course_is_flown(self):
        program("fly", "forest", *SHORT, "--plugin", self.mine, "--set", "course=two_trunks", "--out",
                self.folder / "run", "--quiet")
        self.assertEqual((self.folder / "run" / "obstacles.csv").read_text().count(",trunk,"), 2)

    def test_they_are_listed_with_their_keys(self):
        printed = program("plugin", self.mine)
        for words in ("perception.detector=wrapped", "perception.wrapped.gain", "does nothing", "0.1 .. 2",
                      "course=two_trunks", "a gate of two trunks"):
            self.assertIn(words, printed)

    def test_keys_have_bounds(self):
        said = program("fly", "forest", "--plugin", self.mine, "--set", "perception.wrapped.gain=3", status=2)
        self.assertIn("perception.wrapped.gain", said)

    def test_they_are_checked(self):
        self.mine.write_text(MINE[: MINE.index("@understory.planner")].replace('"gain": 0.5', '"gain": 1.0'))
        self.assertIn("8 checks, 0 faults", program("plugin", self.mine, "--check"))

    def test_what_is_wrong_with_a_file_is_one_line(self):
        for code, words in (
            ("import nothing_there", "ModuleNotFoundError: No module named 'nothing_there' (mine.py:1)"),
            ("x = (", "SyntaxError"),
            ("x = 3", "adds no part"),
            ("import understory\n@understory.course('forest')\ndef f(): pass", "the name 'forest' is taken"),
            ("import understory\n@understory.detector('world')\nclass W: pass\n1 / 0", "ZeroDivisionError"),
        ):
            self.mine.write_text(code)
            said = program("plugin", self.mine, status=2)
            self.assertIn(words, said)
            self.assertEqual(said.count("\n"), 1, said)

    def test_an_exception_ends_a_flight_as_a_failed_machine_with_its_traceback(self):
        self.mine.write_text(MINE.replace("return self.inner.detect(frame)", "return frame.middle"))
        said = program("fly", "forest", *SHORT, "--plugin", self.mine, "--set", "perception.detector=wrapped",
                       "--set", "perception.wrapped.gain=0.5", "--out", self.folder / "run", status=3)
        self.assertIn("Traceback (most recent call last)", said)
        self.assertIn("detector 'wrapped': detect() threw: AttributeError", said.splitlines()[-1])

    def test_a_part_does_not_end_the_program(self):
        for code in ("sys.exit(0)", "sys.exit('bye')", "os._exit(0)", "raise KeyboardInterrupt"):
            self.mine.write_text("import os, sys\n" + MINE.replace("return self.inner.detect(frame)", code).replace('"gain": 0.5', '"gain": 1.0'))
            chosen = ["--plugin", self.mine, "--set", "perception.detector=wrapped"]
            said = program("fly", "forest", *SHORT, *chosen, "--out", self.folder / "run", status=3)
            self.assertIn("Traceback (most recent call last)", said)
            self.assertIn("detector 'wrapped': detect() threw: ", said.splitlines()[-1])
            program("record", "forest", *SHORT, *chosen, "--out", self.folder / "recording", status=3)
            program("plugin", self.mine, "--check", status=1)

    def test_an_edit_of_the_same_second_is_flown(self):
        """Python's compiled files are as old as a second: of two texts in one, the first would fly under the second's hash."""
        for file in ("helper.py", "pack/__init__.py"):
            (self.folder / "pack").mkdir(exist_ok=True)
            helper = self.folder / file
            module = file.split("/")[0].removesuffix(".py")
            self.mine.write_text(f"import {module}\n" + MINE.replace("trunk(15, 2 + seed % 2)", f"trunk({module}.X_M, 2)"))
            surroundings = {**os.environ}
            surroundings.pop("PYTHONDONTWRITEBYTECODE", None)
            hashes = []
            for x_m in (15, 14):
                helper.write_text(f"X_M = {x_m}\n")
                os.utime(helper, (1_700_000_000, 1_700_000_000))
                run = self.folder / f"run{x_m}{module}"
                program("fly", "forest", *SHORT, "--plugin", self.mine, "--set", "course=two_trunks", "--quiet", "--out", run,
                        env=surroundings)
                self.assertIn(f",{x_m}.000,", (run / "obstacles.csv").read_text())
                hashes.append((run / "scenario.yaml").read_text())
            self.assertNotEqual(*hashes)  # the imported module's hash stands there
            said = program("fly", self.folder / f"run15{module}" / "scenario.yaml", "--out", self.folder / "again", status=2)
            self.assertIn("files[0].hash", said)

    def test_a_box_in_python_is_the_scenarios_box(self):
        self.mine.write_text("import understory\n@understory.course('boxed')\ndef boxed(seed, goal_x_m):\n"
                             "    'a box'\n    return [understory.box([20, 1, 2], [1, 2, 4], [0, 0, 0.5])]\n")
        ours = native("clear", "--seed", 1003, *SHORT, "--set",
                      "obstacles=[{name: box, shape: box, position_m: [20, 1, 2], size_m: [1, 2, 4], rotation_rad: [0, 0, 0.5]}]")
        self.assertEqual(native("clear", "--seed", 1003, *SHORT, "--plugin", self.mine, "--set", "course=boxed"), ours)

    def test_what_a_loaded_part_flew_flies_again(self):
        self.mine.write_text(MINE.replace('"wrapped"', '"wrapped_saved"').replace('"wrapped_sst"', '"sst_saved"').replace(
            '"wrapped_filter"', '"filter_saved"').replace('"two_trunks"', '"trunks_saved"').replace('"gain": 0.5', '"gain": 1.0'))
        understory.load_plugin(self.mine)
        flight = understory.Flight("forest", seed=1003, set={"forest.length_m": 20}, detector="wrapped_saved")
        flight.run()
        flight.save(self.folder / "saved.yaml")
        self.assertEqual(native(self.folder / "saved.yaml"), flight.digest)
        flight.save_run(self.folder / "saved_run")
        self.assertEqual(native(self.folder / "saved_run" / "scenario.yaml"), flight.digest)
        self.mine.write_text(self.mine.read_text() + "# edited\n")
        with self.assertRaisesRegex(understory.InputError, "has changed since this process loaded it"):
            understory.load_plugin(self.mine)

    def test_a_part_of_this_program_alone_is_not_saved(self):
        understory.course("session_only")(lambda seed, goal_x_m: [understory.trunk(15, 2)])
        flight = understory.Flight("clear", seed=1003, set={"forest.length_m": 20, "course": "session_only"})
        flight.run()
        with self.assertRaisesRegex(RuntimeError, "load_plugin"):
            flight.save(self.folder / "never.yaml")

    def test_campaigns_fly_them(self):
        flown = {"scenario": "forest", "seeds": "1003..1004"}
        short = {"forest.length_m": 20}
        one = understory.campaign(flown, self.folder / "ours", set=short, jobs=1)
        wrapped = {**short, "perception.detector": "wrapped", "perception.wrapped.gain": 0.5}
        other = understory.campaign(flown, self.folder / "theirs", set=wrapped, plugins=[self.mine], jobs=1)
        self.assertEqual(one.rows["digest"].tolist(), other.rows["digest"].tolist())
        self.assertEqual(one.rows["outcome"].tolist(), ["goal", "goal"])
        verdict = understory.gate(one, other)
        self.assertTrue(verdict["passes"], verdict)
        self.assertEqual(verdict["verdict"], "unchanged on these flights")

    def recorded(self, *seeds):
        return [understory.record("forest", self.folder / f"recording-{seed}", seed=seed,
                                  set={"forest.length_m": 12, "forest.clear_m": 4, "cameras.rate_hz": 20}) for seed in seeds]

    def test_recordings_are_evaluated_from_python(self):
        self.mine.write_text(MINE.replace('"gain": 0.5', '"gain": context.config["gain"]'))
        folder = self.recorded(1003)[0]
        figures = understory.evaluate(folder, self.folder / "evaluation", plugins=[self.mine], detectors=["wrapped"],
                                      curves=["perception.wrapped.gain=0.5,1"])
        ours, theirs = (next(one for one in figures["all"]["algorithms"] if one["name"] == name)
                        for name in ("pushbroom", "wrapped"))
        self.assertGreater(ours["hits"], 0)
        for figure in ("hits", "precision", "recall", "trunk_precision", "false_on", "parts"):
            self.assertEqual(ours[figure], theirs[figure], figure)
        curve = next(one for one in figures["all"]["curves"] if one["name"] == "wrapped")
        self.assertEqual([point["threshold"] for point in curve["points"]], [0.5, 1])
        self.assertEqual(curve["points"][0]["precision"], ours["precision"]["one pixel"])
        rows = (self.folder / "evaluation" / "tables" / "parts.csv").read_text().splitlines()
        self.assertEqual([row.split(",", 1)[1] for row in rows if row.startswith("pushbroom,")],
                         [row.split(",", 1)[1] for row in rows if row.startswith("wrapped,")])

    def test_a_tuning_step_by_step(self):
        self.mine.write_text(MINE.replace('"gain": 0.5', '"gain": context.config["gain"]').replace(
            "return self.inner.detect(frame)", "return self.inner.detect(frame)[: int(self.count)]").replace(
            "self.inner = context.make_detector", "self.count = context.config['count']; self.inner = context.make_detector").replace(
            '"count": 3', '"count": context.config["count"]'))
        one, other = self.recorded(1003, 1004)
        (self.folder / "scenario.yaml").write_text("perception: {detector: wrapped}\n")
        tuning_file = self.folder / "tuning.yaml"
        tuning_file.write_text(
            "scenario: scenario.yaml\nparameters: {perception.wrapped.count: {from: 0, to: 5}}\n"
            "objective: {maximize: hits_per_frame}\nsearch: {method: cma_es, trials: 8, seed: 1}\n"
            f"over: recordings\ntraining: [{one.name}]\nvalidation: [{other.name}]\n")
        key = "perception.wrapped.count"
        with understory.Tuning(tuning_file, plugins=[self.mine]) as tuning:
            self.assertEqual(tuning.scenario, {key: 3})
            measured = [tuning.measure({key: count})["hits_per_frame"] for count in range(6)]
            self.assertEqual(measured[0], 0)
            self.assertEqual(measured, sorted(measured))
            self.assertGreater(measured[5], measured[3])
            self.assertIsNone(tuning.measure({key: 9}))  # beyond the key's bounds
            with self.assertRaisesRegex(understory.InputError, "measure: expected a number of each of"):
                tuning.measure({"count": 1})
            asked = []
            while trial := tuning.ask():
                self.assertEqual(tuning.ask().values, trial.values)
                asked.append(trial.values[key])
                tuning.tell(trial, {**dict.fromkeys(tuning.figures, 0), "hits_per_frame": -(trial.values[key] - 2) ** 2})
            self.assertEqual(len(asked), 8)
            self.assertEqual(tuning.best.values[key], min(asked, key=lambda count: abs(count - 2)))
            with self.assertRaisesRegex(understory.InputError, "tell: expected the number of the trial"):
                tuning.tell(tuning.best, None)
        with self.assertRaisesRegex(understory.CommandFailed, "none.yaml"):
            understory.Tuning("none.yaml")
        program("tune", tuning_file, "--plugin", self.mine, "--out", self.folder / "tuned")
        trials = (self.folder / "tuned" / "trials.jsonl").read_text().splitlines()
        self.assertEqual([json.loads(line)["parameters"][key] for line in trials[1:3]], asked[:2])
        climbed = subprocess.run([sys.executable, EXAMPLES / "hill_climb.py", self.folder / "short.yaml", "4"],
                                 capture_output=True, text=True)
        self.assertIn("short.yaml", climbed.stderr)
        (self.folder / "short.yaml").write_text(tuning_file.read_text().replace("wrapped.count", "pushbroom.minimum_edge_sum").replace(
            "to: 5", "to: 900").replace("scenario.yaml", "forest"))
        climbed = subprocess.run([sys.executable, EXAMPLES / "hill_climb.py", self.folder / "short.yaml", "4"],
                                 capture_output=True, text=True)
        self.assertIn("on validation data", climbed.stdout, climbed.stderr)


class Examples(InFolder):
    @unittest.skipUnless(HAS_OPENCV, "python3-opencv is not installed")
    def test_the_detector_flies(self):
        native("forest", "--seed", 1003, *SHORT, "--plugin", EXAMPLES / "edge_detector.py", "--set",
               "perception.detector=python_edges")

    def test_the_planner_flies(self):
        native("forest", "--seed", 1003, *SHORT, "--plugin", EXAMPLES / "swerve_planner.py", "--set",
               "autopilot.method=python_swerve")

    def test_the_policy_flies(self):
        sys.path.insert(0, str(EXAMPLES))
        import gym_policy
        from understory.gym import FlightEnv

        env = FlightEnv("forest", set={"forest.length_m": 20}, observe=gym_policy.OBSERVE, detector="true_depth")
        total, info = gym_policy.fly(env, gym_policy.policy, 1003)
        self.assertEqual(info["outcome"], "goal")
        self.assertGreater(total, 1.5)


@unittest.skipUnless(HAS_MYPY, "mypy is not installed")
class Types(unittest.TestCase):
    def test_the_package_and_its_stubs_agree(self):
        package = SOURCE / "scenarios" / "python" / "understory"
        ended = subprocess.run(["mypy", "--cache-dir=/dev/null", "--config-file", str(SOURCE / "tests/python/mypy.ini"), str(package)],
                               capture_output=True, text=True, cwd=SOURCE / "scenarios" / "python")
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)


if __name__ == "__main__":
    unittest.main()
