"""A detector of one's own: 5x5 blocks with edges that match at one depth, and at no other nearby.

understory fly forest --plugin edge_detector.py --set perception.detector=python_edges --video
"""

import cv2
import numpy as np

import understory

BLOCK_PX = 5


@understory.detector(
    "python_edges",
    keys=[
        understory.Key("depth_m", 10.0, 2.0, 50.0, "depth that is looked at"),
        understory.Key("least_edges", 220.0, 0.0, 10000.0, "least sum of a block's edges"),
        understory.Key("largest_score", 0.20, 0.0, 10.0, "largest difference, as a share of the edges"),
        understory.Key("uniqueness", 1.5, 1.0, 10.0, "how much worse other disparities must match"),
    ],
)
class EdgeDetector:
    "blocks with edges that match at one depth, found with OpenCV"

    def __init__(self, context):
        self.rig, self.config = context.rig, context.config
        self.disparity_px = round(float(context.rig.disparity_px(self.config["depth_m"])))

    def difference(self, left, right, disparity_px):
        shifted = np.roll(right, disparity_px, axis=1)
        return cv2.boxFilter(cv2.absdiff(left, shifted), cv2.CV_32F, (BLOCK_PX, BLOCK_PX), normalize=False)

    def detect(self, frame):
        left, right, at = frame.left, frame.right, self.disparity_px
        edges = cv2.boxFilter(cv2.convertScaleAbs(cv2.Laplacian(left, cv2.CV_16S)), cv2.CV_32F, (BLOCK_PX, BLOCK_PX), normalize=False)
        here = self.difference(left, right, at)
        others = np.minimum.reduce([self.difference(left, right, at + by) for by in (-8, -5, 5, 8)])
        good = (edges > self.config["least_edges"]) & (here < self.config["largest_score"] * edges)
        good &= others > self.config["uniqueness"] * here
        good[:, : at + BLOCK_PX] = False  # the right image does not reach there
        rows, columns = np.nonzero(good[2 : self.rig.height_px - 34 : BLOCK_PX, 2:-2:BLOCK_PX])
        score = (here / np.maximum(edges, 1))[rows * BLOCK_PX + 2, columns * BLOCK_PX + 2]
        return understory.hits(self.rig, columns * BLOCK_PX, rows * BLOCK_PX, at, score)
