# %% [markdown]
# # A flight, step by step
# Run the cells in order, in an editor that knows the percent format or in a notebook (`jupytext --to ipynb tour.py`).

# %%
import numpy as np

import understory

flight = understory.Flight("forest", seed=1003, set={"forest.length_m": 40}, images=True)
print(flight, "rig", flight.rig.name, "looks", flight.rig.detection_depth_m, "m ahead")

# %% [markdown]
# The catapult fires after a quarter of a second. The forest begins 20 m ahead: fly until the detector sees three blocks.

# %%
while len(flight.hits) < 3 and flight.step("camera"):
    pass
print(f"{flight.t_s:.2f} s, at {np.round(flight.truth.position_world_m, 2)}, {flight.pitot.airspeed_mps:.1f} m/s")
print(f"the left image: {flight.left.shape}, mean gray {flight.left.mean():.0f}")

# %% [markdown]
# What the detector saw in this frame, and what the map still holds of earlier ones. The true depth is drawn where the
# aircraft is now; the frame is one latency (8 ms, 9 cm of flight) older.

# %%
depth_m = flight.depth
for hit in flight.hits[:5]:
    seen_m, true_m = hit["position_camera"][2], depth_m[hit["row_px"] + 2, hit["column_px"] + 2]
    print(f"hit at column {hit['column_px']}, row {hit['row_px']}: {seen_m:.2f} m, truly {true_m:.2f} m")
print(len(flight.hits), "hits,", len(flight.map), "points in the map")

# %% [markdown]
# How far the estimate has drifted, and where the plan leads.

# %%
drift_m = np.linalg.norm(flight.truth.position_world_m - flight.estimate.position_world_m)
plan = flight.plan
print(f"the estimate is {drift_m:.2f} m off; the plan is '{plan.origin}' and keeps {plan.clearance_m:.2f} m free")

# %% [markdown]
# To the end, and what is left: numbers, a trajectory, a page.

# %%
result = flight.run()
print(result["outcome"], f"after {result['simulated_s']:.2f} s, nearest obstacle {result['minimum_clearance_m']:.2f} m")
print("mean speed", np.round(np.linalg.norm(flight.trajectory[-200:, 8:11], axis=1).mean(), 2), "m/s")
flight.report("tour.html")
print("tour.html shows the flight; its digest is", flight.digest)
