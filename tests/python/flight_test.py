"""Flights from Python equal those of the program, and what they give is what it says."""

import subprocess
import sys
import threading
import unittest

import numpy as np

import understory
from tests.python.support import SHORT, InFolder, native

SETTINGS = ["--set", "forest.length_m=20"]


class Wrapped:
    """Understory's detector, called through Python."""

    def __init__(self, context):
        self.inner = context.make_detector("pushbroom")

    def detect(self, frame):
        return self.inner.detect(frame)


class Digests(InFolder):
    @classmethod
    def setUpClass(cls):
        cls.digest = native("forest", "--seed", 1003, *SETTINGS)
        understory.detector("wrapped_for_digests")(Wrapped)

    def test_a_flight_equals_the_programs_and_so_does_a_second(self):
        for _ in range(2):
            self.assertEqual(understory.Flight("forest", seed=1003, set=SHORT).run()["digest"], self.digest)

    def test_stepping_changes_nothing(self):
        for until in ("physics", "control", "camera"):
            flight = understory.Flight("forest", seed=1003, set=SHORT)
            while flight.step(until):
                pass
            self.assertEqual(flight.digest, self.digest, until)

    def test_asking_changes_nothing(self):
        flight = understory.Flight("forest", seed=1003, set=SHORT, images=True)
        while flight.step("camera"):
            flight.depth, flight.objects, flight.hits, flight.map, flight.plan.points, flight.chase_view(64, 48)
        self.assertEqual(flight.digest, self.digest)

    def test_our_detector_wrapped_in_python(self):
        flight = understory.Flight("forest", seed=1003, set=SHORT, detector="wrapped_for_digests")
        self.assertEqual(flight.run()["digest"], self.digest)

    def test_two_flights_interleaved_equal_two_alone(self):
        other = understory.Flight("forest", seed=1004, set=SHORT).run()["digest"]
        flights = [understory.Flight("forest", seed=seed, set=SHORT) for seed in (1003, 1004)]
        while any([flight.step("camera") for flight in flights]):
            pass
        self.assertEqual([flight.digest for flight in flights], [self.digest, other])

    def test_a_flight_by_hand_flies_again(self):
        flight = understory.Flight("forest", seed=1003, set=SHORT, by_hand=True)
        flight.command(0.1, 0.2)
        while flight.step("control"):
            if flight.t_s > 1.5:
                flight.control(0.05 * np.sin(7 * flight.t_s), 0.03, 3.3333333)
        file = self.folder / "by hand.yaml"
        flight.save(file)
        status = 0 if flight.outcome == "goal" else 1
        self.assertEqual(native(file, status=status), flight.digest)

    def test_a_flight_by_the_planner_flies_again(self):
        flight = understory.Flight("forest", seed=1003, set=SHORT)
        flight.run()
        flight.save(self.folder / "again.yaml")
        self.assertEqual(native(self.folder / "again.yaml"), self.digest)


class Values(InFolder):
    def test_what_a_flight_gives(self):
        flight = understory.Flight("forest", seed=1003, set=SHORT, images=True)
        self.assertEqual(flight.left.shape, (0, 0))
        self.assertIsNone(flight.outcome)
        self.assertIn("1003", flight._repr_html_())
        for _ in range(90):
            self.assertTrue(flight.step("camera"))
        rig = flight.rig
        shape = (rig.height_px, rig.width_px)
        for image, kind in ((flight.left, np.uint8), (flight.right, np.uint8), (flight.depth, np.float32),
                            (flight.objects, np.uint16)):
            self.assertEqual((image.shape, image.dtype), (shape, kind))
        self.assertGreater(flight.left.std(), 5)
        self.assertLess(np.linalg.norm(flight.truth.position_world_m - flight.estimate.position_world_m), 1)
        self.assertAlmostEqual(np.linalg.norm(flight.truth.T_world_body[:3, 0]), 1)
        self.assertEqual(flight.imu.specific_force_body_mps2.shape, (3,))
        self.assertGreater(flight.pitot.airspeed_mps, 5)
        self.assertEqual(flight.hits.dtype, understory.hit_dtype)
        self.assertEqual(flight.map.dtype, understory.point_dtype)
        self.assertEqual(flight.plan.points.shape[1], 10)
        self.assertEqual(flight.chase_view(64, 48).shape, (48, 64, 3))
        flight.run()
        self.assertEqual(flight.result["outcome"], flight.outcome)
        self.assertIn("outcome", flight.result)
        self.assertEqual(flight.trajectory.shape[1], 12)
        page = flight.report(self.folder / "page.html")
        self.assertIn("<html", page)
        self.assertIn("<iframe", flight._repr_html_())
        flight.save_run(self.folder / "run")
        self.assertTrue((self.folder / "run" / "result.json").is_file())

    def test_hits_lie_where_their_disparity_says(self):
        rig = understory.Flight("clear", set=SHORT).rig
        hits = understory.hits(rig, [100, 50], [80, 40], rig.disparity_px(10.0))
        np.testing.assert_array_equal(hits["row_px"], [40, 80])
        np.testing.assert_allclose(hits["position_camera"][:, 2], 10)
        np.testing.assert_allclose(
            hits["position_camera"][0, 0], (52 - rig.center_left_x_px) * 10 / rig.focal_px)

    def test_an_image_outlives_its_flight(self):
        flight = understory.Flight("forest", seed=1003, set=SHORT)
        for _ in range(80):
            flight.step("camera")
        kept, copy = flight.left, flight.left.copy()
        self.assertFalse(kept.flags.owndata)
        self.assertFalse(kept.flags.writeable)
        flight.run()
        del flight
        other = understory.Flight("forest", seed=1004, set=SHORT)
        other.run()
        np.testing.assert_array_equal(kept, copy)

    def test_keys_are_those_of_the_program(self):
        keys = {row["key"]: row for row in understory.keys()}
        self.assertEqual(keys["forest.length_m"]["unit"], "m")
        self.assertGreater(len(keys), 400)


class Threads(unittest.TestCase):
    def test_another_thread_is_refused(self):
        flight = understory.Flight("clear", set=SHORT)
        said = []

        def use():
            try:
                flight.step("control")
            except RuntimeError as error:
                said.append(str(error))

        thread = threading.Thread(target=use)
        thread.start()
        thread.join()
        self.assertEqual(len(said), 1)
        self.assertIn("belongs to the thread", said[0])
        self.assertTrue(flight.step("control"))

    def test_other_threads_run_while_a_flight_is_flown(self):
        flight = understory.Flight("forest", seed=1003, set=SHORT)
        counted = [0]
        done = threading.Event()

        def count():
            while not done.is_set():
                counted[0] += 1

        thread = threading.Thread(target=count)
        thread.start()
        before = counted[0]
        flight.step("end")
        during = counted[0]
        done.set()
        thread.join()
        self.assertGreater(during, before)

    def test_the_keyboard_interrupts_a_flight(self):
        code = (
            "import os, signal, threading, understory\n"
            "threading.Timer(1.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()\n"
            "try:\n"
            "    while True: understory.Flight('forest', seed=1003).run()\n"
            "except KeyboardInterrupt: print('interrupted')\n"
        )
        ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        self.assertEqual(ended.stdout, "interrupted\n", ended.stderr)


class Memory(unittest.TestCase):
    def test_many_flights_in_one_process_do_not_grow(self):
        def resident_kb():
            with open("/proc/self/status", encoding="ascii") as status:
                return int(next(line for line in status if line.startswith("VmRSS")).split()[1])

        scenario = understory.load_scenario("clear", set={"forest.length_m": 5, "perception.detector": "none"})
        for seed in range(100):
            understory.Flight(scenario, seed=seed, record=False).step("control")
        before_kb = resident_kb()
        for seed in range(1000):
            understory.Flight(scenario, seed=seed, record=False).step("control")
        self.assertLess(resident_kb() - before_kb, 4000)


if __name__ == "__main__":
    unittest.main()
