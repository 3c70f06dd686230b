"""Wrong uses of the Python module, each with what it is answered: one line that says what was wrong."""

import os
import subprocess
import sys
import unittest

import numpy as np

import understory
from tests.python.support import SHORT, InFolder
from understory.gym import FlightEnv

InputError, MachineError = understory.InputError, understory.MachineError


def flight(**more):
    return understory.Flight("clear", set=SHORT, **more)


def flown(**more):
    return understory.Flight("forest", seed=1003, set=SHORT, **more).run()


def env(**more):
    return FlightEnv("clear", set=SHORT, **{"observe": ("imu",), **more})


def begun(**more):
    one = env(**more)
    one.reset(seed=1)
    return one


class Detecting:
    """A detector that gives what it is told."""

    def __init__(self, given):
        self.given = given

    def detect(self, frame):
        return self.given(frame) if callable(self.given) else self.given


def one_hit(**fields):
    def hits(_):
        array = understory.hits(RIG, [100], [80], RIG.disparity_px(10.0))
        for name, value in fields.items():
            array[name] = value
        return array

    return hits


class Planning:
    def __init__(self, given):
        self.given = given

    def plan(self, request):
        return self.given


class Stating:
    """A state source that gives what it is told of the filter's state."""

    def __init__(self, **changed):
        self.changed = changed

    def on(self, sample):
        pass

    def state(self):
        state = understory.State()
        for name, value in self.changed.items():
            setattr(state, name, value)
        return state

    def state_at(self, t_ns):
        return self.state()


def keyed(*keys):
    return understory.detector("keyed", keys=keys)(Detecting)


RIG = understory.load_scenario("clear").rig
MIRRORED = np.diag([1.0, -1.0, 1.0, 1.0])

WRONG = [
    # scenarios and keys
    ("no such scenario", lambda: understory.Flight("forrest"), InputError, "did you mean forest"),
    ("no such file", lambda: understory.Flight("./nothing.yaml"), InputError, "nothing.yaml"),
    ("unknown key", lambda: understory.Flight("forest", set={"forest.lenght_m": 3}), InputError, "did you mean"),
    ("key out of range", lambda: flight(seed=-1), InputError, "seed"),
    ("word for a number", lambda: understory.Flight("forest", set={"forest.length_m": "long"}), InputError, "length_m"),
    ("value of a wrong kind", lambda: understory.Flight("forest", set={"forest.length_m": {}}), TypeError, "length_m"),
    ("no such rig", lambda: flight(rig="none"), InputError, "rig"),
    ("no such detector", lambda: flight(detector="none_such"), InputError, "perception.detector"),
    ("set beside a Scenario", lambda: understory.Flight(understory.load_scenario("clear"), set=SHORT), ValueError,
     "load_scenario"),
    ("no such renderer", lambda: flight(renderer="vulkan"), ValueError, "osmesa"),
    # order of calls
    ("no such step", lambda: flight().step("frame"), ValueError, "physics, control, camera or end"),
    ("result before the end", lambda: flight().result, RuntimeError, "has not ended"),
    ("result without a record", lambda: flight(record=False).result, RuntimeError, "record=True"),
    ("page before the end", lambda: flight().report(), RuntimeError, "has not ended"),
    ("depth without images", lambda: flight(detector="none").depth, RuntimeError, "images=True"),
    ("chase view without images", lambda: flight(detector="none").chase_view(), RuntimeError, "images=True"),
    ("controls of a planner's flight", lambda: flight().control(0, 0, 0), RuntimeError, "by_hand=True"),
    ("the run folder of a flight by hand", lambda: flight(by_hand=True).save_run("never"), RuntimeError, r"save\(\)"),
    ("writing to an image", lambda: flown_image().fill(0), ValueError, "read-only"),
    # parts
    ("a detector without detect()", lambda: flight(detector=object()), TypeError, r"detect\(\)"),
    ("a planner without plan()", lambda: flight(planner=object()), TypeError, r"plan\(\)"),
    ("a state source without on()", lambda: flight(state_source=object()), TypeError, r"on\(\)"),
    ("a detector that gives None", lambda: flown(detector=Detecting(None)), MachineError, "hit_dtype"),
    ("a detector that gives a list", lambda: flown(detector=Detecting([1, 2])), MachineError, "hit_dtype"),
    ("a detector that gives floats", lambda: flown(detector=Detecting(np.zeros((3, 3)))), MachineError, "hit_dtype"),
    ("a hit outside the image", lambda: flown(detector=Detecting(one_hit(column_px=5000))), MachineError, "outside"),
    ("a hit that is not finite", lambda: flown(detector=Detecting(one_hit(disparity_px=np.nan))), MachineError,
     "finite"),
    ("a hit behind the camera", lambda: flown(detector=Detecting(one_hit(position_camera=(0, 0, -1)))), MachineError,
     "behind"),
    ("a detector that raises", lambda: flown(detector=Detecting(lambda _: 1 / 0)), MachineError, "ZeroDivisionError"),
    ("a planner that gives None", lambda: flown(planner=Planning(None)), MachineError, "must be an understory.Plan"),
    ("a planner that gives a list", lambda: flown(planner=Planning([1])), MachineError, "must be an understory.Plan"),
    ("a detector that exits", lambda: flown(detector=Detecting(lambda _: sys.exit(0))), MachineError, "SystemExit: 0"),
    ("a state without a rotation", lambda: flown(state_source=Stating(T_world_body=np.zeros((4, 4)))), MachineError,
     "no pose"),
    ("a mirrored state", lambda: flown(state_source=Stating(T_world_body=MIRRORED)), MachineError, "no pose"),
    ("a wind that is not finite", lambda: flown(state_source=Stating(wind_world_mps=[0, np.nan])), MachineError,
     "not finite"),
    ("a default out of bounds", lambda: keyed(understory.Key("a", 100.0, 2.0, 40.0, "m")), ValueError,
     "expected a number from 2 to 40, got 100"),
    ("a default that is not finite", lambda: keyed(understory.Key("a", np.nan, 2.0, 40.0, "m")), ValueError,
     "expected a number from 2 to 40"),
    ("bounds the other way round", lambda: keyed(understory.Key("a", 3.0, 40.0, 2.0, "m")), ValueError,
     "expected a number from 40 to 2"),
    ("a key twice", lambda: keyed(*[understory.Key("a", 3.0, 2.0, 4.0, "m")] * 2), ValueError, "given twice"),
    ("a key's name with a point", lambda: keyed(understory.Key("a.b", 3.0, 2.0, 4.0, "m")), ValueError, "letters, digits"),
    ("a cost below zero", lambda: understory.detector("cheap", cost_s=-1.0)(Detecting), ValueError, "cost_s"),
    ("controls that are no numbers", lambda: flight(by_hand=True).control(np.nan, 0, 1), ValueError,
     "left_elevon_rad: must be a number, got nan"),
    ("controls that are words", lambda: flight(by_hand=True).control(0, "a", 1), TypeError,
     "right_elevon_rad: must be a number, got str"),
    ("a command that is no number", lambda: flight(by_hand=True).command(np.nan, 0), ValueError, "bank_rad"),
    ("a step that is a number", lambda: flight().step(5), TypeError, "step: must be a word, got int"),
    ("a picture of no size", lambda: flight().chase_view(-1, 5), ValueError, "width_px: must be from 1 to 8192"),
    ("a picture too large", lambda: flight().chase_view(10**6, 10**6), ValueError, "width_px: must be from 1 to 8192"),
    ("a box for a kind", lambda: understory.Obstacle("a", [0, 0, 0], [0, 0, 1], 0.1, "box"), ValueError, r"box\(\)"),
    ("hits that are no numbers", lambda: understory.hits(RIG, [1], [1], np.nan), ValueError, "infinity"),
    ("a seed beyond 32 bits", lambda: begun().reset(seed=2**40), ValueError, "seed"),
    ("a seed that is a word", lambda: understory.load_scenario("clear").with_seed("a"), TypeError, "seed: must be a whole"),
    ("a name that is taken", lambda: understory.detector("pushbroom")(Detecting), ValueError, "is taken"),
    ("a name with blanks", lambda: understory.course("my course")(list), ValueError, "letters a-z"),
    ("a kind of obstacle that is none", lambda: understory.Obstacle("a", [0, 0, 0], [0, 0, 1], 0.1, "tree"),
     ValueError, "trunk"),
    ("images of two shapes", lambda: understory.StereoFrame(np.zeros((4, 4), "u1"), np.zeros((4, 5), "u1")),
     ValueError, "one shape"),
    ("an image of floats", lambda: understory.StereoFrame(np.zeros((4, 4)), np.zeros((4, 4))), ValueError, "uint8"),
    ("a hit beyond infinity", lambda: understory.hits(RIG, [1], [1], RIG.infinity_disparity_px), ValueError, "infinity"),
    ("a class for an object", lambda: flight(detector=Detecting), TypeError, "call it first"),
    ("saving a flight with an object", lambda: flight(detector=Detecting(one_hit())).save("never.yaml"), RuntimeError,
     "by name"),
    ("a plug-in of an environment that is not there", lambda: env(plugins=["gone.py"]), InputError, "gone.py"),
    ("hits of two dimensions", lambda: understory.hits(RIG, [[1]], [[1]], 20), ValueError, "one dimension"),
    ("no such plug-in", lambda: understory.load_plugin("nothing.py"), InputError, "nothing.py"),
    # environments
    ("unknown observation", lambda: env(observe=("sonar",)), ValueError, "sonar"),
    ("unknown action", lambda: env(act="stick"), ValueError, "stick"),
    ("unknown step", lambda: env(step="frame"), ValueError, "frame"),
    ("a picture of no size in an environment", lambda: env(render_mode="rgb_array", render_size=(0, 0)), ValueError,
     "render_size"),
    ("unknown render mode", lambda: env(render_mode="human"), ValueError, "human"),
    ("step before reset", lambda: env().step([0, 0]), RuntimeError, "before reset"),
    ("render before reset", lambda: env(render_mode="rgb_array").render(), RuntimeError, "before reset"),
    ("save before reset", lambda: env().save("a.yaml"), RuntimeError, "before reset"),
    ("action of a wrong shape", lambda: begun().step([0, 0, 0]), ValueError, "shape"),
    ("action out of bounds", lambda: begun().step([0, 2]), ValueError, "within"),
    ("action that is not finite", lambda: begun().step([np.nan, 0]), ValueError, "within"),
    ("unknown option", lambda: env().reset(options={"sed": 1}), ValueError, "sed"),
    ("a wrong setting", lambda: FlightEnv("forrest"), InputError, "did you mean"),
    # files
    ("a folder that is no campaign", lambda: understory.Campaign("/tmp"), FileNotFoundError, "flights.csv"),
    ("a campaign that is none", lambda: understory.campaign({"scenario": "forest"}, "never"), understory.CommandFailed,
     "seeds"),
]


def flown_image():
    one = understory.Flight("forest", seed=1003, set=SHORT)
    while one.left.size == 0:
        one.step("camera")
    return one.left


class WrongUses(unittest.TestCase):
    def test_each_is_answered_in_one_line(self):
        self.assertGreaterEqual(len(WRONG), 30)
        for name, use, kind, words in WRONG:
            with self.subTest(name):
                with self.assertRaisesRegex(kind, words) as caught:
                    use()
                self.assertNotIn("\n", str(caught.exception).strip())

    def test_an_error_ends_a_flight_for_good(self):
        one = understory.Flight("forest", seed=1003, set=SHORT, detector=Detecting(None))
        for _ in range(2):
            with self.assertRaisesRegex(MachineError, "hit_dtype"):
                one.run()

class Reentrance(unittest.TestCase):
    def test_a_part_does_not_step_its_own_flight(self):
        for step in ("physics", "camera", "end"):
            detector = Detecting(lambda _: detector.flight.step(step))
            detector.flight = understory.Flight("forest", seed=1003, set=SHORT, detector=detector)
            with self.assertRaisesRegex(MachineError, "cannot step the flight that it is a part of"):
                detector.flight.run()

    def test_an_interrupt_is_no_later_flights(self):
        class Interrupted:
            def on(self, sample):
                pass

            def state(self):
                raise KeyboardInterrupt

            def state_at(self, t_ns):
                pass

        with self.assertRaises(KeyboardInterrupt):
            flight(state_source=Interrupted())
        with self.assertRaisesRegex(MachineError, "ZeroDivisionError"):
            flown(detector=Detecting(lambda _: 1 / 0))


class OtherProcesses(InFolder):
    def python(self, code):
        return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)

    def test_a_fork_after_the_import_flies_without_images(self):
        code = (
            "import os, understory\n"
            "understory.Flight('clear', set={'forest.length_m': 5}, detector='none').run()\n"
            "child = os.fork()\n"
            "if child == 0:\n"
            "    understory.Flight('clear', set={'forest.length_m': 5}, detector='none').run(); os._exit(0)\n"
            "print(os.waitpid(child, 0)[1])\n"
        )
        ended = self.python(code)
        self.assertEqual(ended.stdout, "0\n", ended.stderr)

    def test_a_flight_may_be_dropped_on_another_thread(self):
        for dropped in ("threading.Thread(target=box.clear)", "threading.Thread(target=gc.collect)"):
            ended = self.python(
                "import gc, threading, understory\n"
                "fly = lambda: understory.Flight('forest', seed=1003, set={'forest.length_m': 5})\n"
                "class Box(list): pass\n"
                "box = Box([fly()]); box[0].step('camera'); box.itself = box; gc.disable()\n"
                + ("del box\n" if "gc" in dropped else "")
                + f"thread = {dropped}; thread.start(); thread.join()\n"
                "print(fly().run()['outcome'])\n")
            self.assertEqual(ended.stdout, "goal\n", ended.stderr)

    def test_a_thread_that_flies_at_the_end_ends_quietly(self):
        for detector in ("'none'", "Mine()"):
            ended = self.python(
                "import threading, time, numpy, understory\n"
                "class Mine:\n"
                "    def detect(self, frame): return numpy.zeros(0, understory.hit_dtype)\n"
                "def fly():\n"
                f"    understory.Flight('forest', set={{'forest.length_m': 900}}, detector={detector}).run()\n"
                "for _ in range(2): threading.Thread(target=fly, daemon=True).start()\n"
                "time.sleep(1)\n")
            self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (0, "", ""))

    def test_the_watchdog_sees_every_call_and_no_stopped_time(self):
        # Nested: the inner flight's calls come and go while the outer call does not return. On another thread: that one's
        # calls come and go. Stopped for longer than a call may take: it flies on. All at once, for each takes 20 s.
        begin = (
            "import threading, time, numpy, understory\n"
            "class Sleeps:\n"
            "    first = True\n"
            "    def detect(self, frame):\n"
            "        if Sleeps.first: Sleeps.first = False; self.once()\n"
            "        return numpy.zeros(0, understory.hit_dtype)\n"
            "class Quick:\n"
            "    def detect(self, frame): return numpy.zeros(0, understory.hit_dtype)\n"
            "def fly(detector): return understory.Flight('clear', seed=1, set={'forest.length_m': 5}, detector=detector).run()\n"
        )
        nested = begin + (
            "def once(self):\n"
            "    while True: fly(Quick())\n"
            "Sleeps.once = once\nfly(Sleeps())\n")
        beside = begin + (
            "def once(self): time.sleep(3600)\n"
            "def others():\n"
            "    while True: fly(Quick())\n"
            "Sleeps.once = once\nthreading.Thread(target=others, daemon=True).start()\nfly(Sleeps())\n")
        stopped = begin + (
            "import os, signal, subprocess\n"
            "def once(self):\n"
            "    subprocess.Popen(['sh', '-c', 'sleep 23; kill -CONT %d' % os.getpid()])\n"
            "    os.kill(os.getpid(), signal.SIGSTOP)\n"
            "Sleeps.once = once\nprint(fly(Sleeps())['outcome'])\n")
        began = [subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                 for code in (nested, beside, stopped)]
        ended = [one.communicate() for one in began]
        for (_, said), one in zip(ended[:2], began):
            self.assertIn("detect(): has not returned for 20 s", said)
            self.assertEqual(one.returncode, 3)
        self.assertEqual(ended[2][0], "goal\n", ended[2][1])

    def test_a_program_that_ends_in_the_middle_of_flights_ends(self):
        code = (
            "import understory\n"
            "from understory.gym import FlightEnv\n"
            "flight = understory.Flight('forest'); flight.step('camera')\n"
            "env = FlightEnv('clear', observe=('imu',)); env.reset(seed=1)\n"
        )
        file = self.folder / "ends.py"
        file.write_text(code)
        ended = subprocess.run([sys.executable, file], capture_output=True, text=True)
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))

    def test_the_data_folder_can_be_named(self):
        surroundings = {**os.environ, "UNDERSTORY_ROOT": "/proc/nowhere"}
        ended = subprocess.run([sys.executable, "-c", "import understory; understory.Flight('forest')"],
                               capture_output=True, text=True, env=surroundings)
        self.assertIn("UNDERSTORY_ROOT=/proc/nowhere: must be a folder with models/ and scenarios/", ended.stderr)


if __name__ == "__main__":
    unittest.main()
