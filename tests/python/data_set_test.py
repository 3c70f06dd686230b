"""Data sets of `understory record`, read by numpy alone."""

import unittest

import numpy as np

import understory
from tests.python.support import InFolder, program

EVERY = 20


def read_pfm(file):
    """Rows from the top."""
    kind, size, scale, values = file.read_bytes().split(b"\n", 3)
    assert kind == b"Pf" and float(scale) < 0, "one channel, little endian"
    width, height = map(int, size.split())
    return np.flipud(np.frombuffer(values, "<f4").reshape(height, width))


def read_calibration(file):
    return dict(line.split("=", 1) for line in file.read_text().split("\n") if line)


class Middlebury(InFolder):
    def test_disparities_and_poses_are_those_of_the_flight(self):
        settings = {"time_limit_s": 0.9, "cameras.rate_hz": 60}
        options = [f"--set={key}={value}" for key, value in settings.items()]
        program("record", "forest", "--seed", 1003, *options, "--format", "middlebury", "--every", EVERY, "--out",
                self.folder / "set", "--quiet")
        pairs = self.folder / "set" / "pairs"
        flight = understory.Flight("forest", seed=1003, set=settings, images=True)
        times = np.loadtxt(pairs / "times.txt")
        for number, time_s in enumerate(times):
            while flight.t_s < time_s - 1e-6:
                flight.step("physics")
            pair = pairs / f"{number:06}"
            calibration = read_calibration(pair / "calib.txt")
            focal_px = float(calibration["cam0"].strip("[").split()[0])
            disparity, depth = read_pfm(pair / "disp0.pfm"), flight.depth
            near = (depth > 0) & (depth < 65)
            expected = focal_px * float(calibration["baseline"]) / 1000 / depth[near] - float(calibration["doffs"])
            np.testing.assert_allclose(disparity[near], expected, rtol=1e-3)
            self.assertGreater(np.mean(np.isinf(disparity)), 0.1, "the sky has none")
        poses = np.loadtxt(pairs / "poses.txt").reshape(-1, 3, 4)
        self.assertGreater(len(times), 2)
        self.assertEqual(len(poses), len(times))
        for pose in poses:
            np.testing.assert_allclose(pose[:, :3] @ pose[:, :3].T, np.eye(3), atol=1e-8)


if __name__ == "__main__":
    unittest.main()
