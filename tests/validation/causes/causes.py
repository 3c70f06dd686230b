#!/usr/bin/env python3
"""Plants faults into flights that arrive, and asks understory explain for their cause (docs/causes.md).

For each seed the flight without a fault is flown ten times with other noise from the fault's moment on; the seed is
used where nine of ten arrive. Of each fault the first `wanted` lost flights are explained.

causes.py --program understory --plugin planted_faults.so --seeds 1000..1200 --wanted 10 --out FOLDER [--faults a,b]
"""

import argparse
import csv
import json
import subprocess
from pathlib import Path

AT_S = 3.0
# cause that explain must give: [its words], keys
FAULTS = {
    "not_detected": (["not detected"], {"perception.detector": "unseeing", "perception.unseeing.at_s": AT_S}),
    "never_in_view": (["never in view", "seen too late"], {"faults": f"[{{sensor: camera, kind: cover, at_s: {AT_S}, value: 0.5}}]"}),
    "false_obstacle": (["false obstacle"], {"perception.detector": "imagining", "perception.imagining.at_s": AT_S}),
    "forgotten": (["forgotten"], {"faults": f"[{{sensor: map, kind: dropout, at_s: {AT_S}}}]"}),
    "wrong_place": (["wrong place"], {"estimation.source": "turned", "estimation.turned.at_s": AT_S, "estimation.turned.yaw_rad": 0.4}),
    "too_late": (["too late"], {"faults": f"[{{sensor: camera, kind: delay, at_s: {AT_S}, value: 0.08}}]"}),
    "not_found": (["not found"], {"autopilot.method": "cut_short", "autopilot.cut_short.at_s": AT_S}),
    "not_flown": (["not flown"], {"faults": f"[{{sensor: elevons, kind: weaken, at_s: {AT_S}, value: 0.5}}]"}),
    "sensor": (["sensor's fault"], {"faults": f"[{{sensor: pitot, kind: bias, at_s: {AT_S}, value: 6}}]"}),
    "infeasible": (["infeasible"], {"obstacles": "[" + ", ".join(
        f"{{name: wall{i}, shape: capsule, position_m: [55, {-24.5 + 0.7 * i}, 5], size_m: [0.4, 0.4, 10]}}"
        for i in range(71)) + "]"}),
}


def seeds_in(text):
    first, last = text.split("..")
    return range(int(first), int(last) + 1)


class Proof:
    def __init__(self, arguments):
        self.arguments = arguments
        self.out = Path(arguments.out)
        self.out.mkdir(parents=True, exist_ok=True)

    def run(self, *words):
        return subprocess.run([self.arguments.program, *map(str, words)], capture_output=True, text=True)

    def campaign(self, name, seeds, overrides):
        """Flies and gives the rows, by override and seed."""
        folder = self.out / name
        lines = [f"scenario: {self.arguments.scenario}", f"seeds: {seeds}", "overrides:"]
        for override, keys in overrides.items():
            keys = {"plugins": f"[{{file: {Path(self.arguments.plugin).resolve()}}}]", **keys}
            lines.append(f"  - {{name: {override}, set: {{" + ", ".join(f"{k}: {v}" for k, v in keys.items()) + "}}")
        file = self.out / f"{name}.yaml"
        file.write_text("\n".join(lines) + "\n")
        resume = ["--resume"] if (folder / "campaign.json").exists() else []
        done = self.run("campaign", file, "--out", folder, *resume)
        if done.returncode not in (0, 1):
            raise SystemExit(done.stderr)
        with open(folder / "flights.csv", newline="") as table:
            return {(row["condition"], int(row["seed"])): row for row in csv.DictReader(table)}

    def sound_seeds(self):
        """Whose flight arrives at least nine times of ten, whatever the noise from the moment on."""
        seeds = self.arguments.seeds
        if self.arguments.sound:
            return [int(seed) for seed in self.arguments.sound.split(",")]
        rows = self.campaign("sound", seeds, {f"r{k}": {"ideal.redraw": k, "ideal.from_s": AT_S} for k in range(1, 11)})
        arrived = {}
        for (_, seed), row in rows.items():
            arrived[seed] = arrived.get(seed, 0) + (row["outcome"] == "goal")
        return [seed for seed in seeds_in(seeds) if arrived.get(seed, 0) >= 9]

    def explain(self, fault, seed):
        run = self.out / "runs" / f"{fault}-{seed}"
        if not (run / "explain.json").exists():
            condition = next((self.out / fault / "conditions").glob("*.yaml"))
            self.run("fly", condition, "--seed", seed, "--out", run, "--quiet")
            done = self.run("explain", run)
            if done.returncode != 0:
                raise SystemExit(f"{run}: {done.stderr}")
        return json.loads((run / "explain.json").read_text())


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    parser.add_argument("--plugin", required=True)
    parser.add_argument("--scenario", default="dense")
    parser.add_argument("--seeds", required=True)
    parser.add_argument("--wanted", type=int, default=10)
    parser.add_argument("--out", required=True)
    parser.add_argument("--sound", help="seeds known to be sound: they are not flown to find out")
    parser.add_argument("--faults", default=",".join(FAULTS))
    proof = Proof(parser.parse_args())
    sound = proof.sound_seeds()
    print(f"{len(sound)} sound seeds", flush=True)
    matrix = []
    for fault in proof.arguments.faults.split(","):
        words, keys = FAULTS[fault]
        seeds = "[" + ", ".join(map(str, sound)) + "]"
        rows = proof.campaign(fault, seeds, {fault: keys})
        lost = [seed for (_, seed), row in sorted(rows.items())
                if row["outcome"] not in ("goal", "time") and float(row["simulated_s"]) > AT_S + 0.3]
        print(f"{fault}: {len(lost)} of {len(rows)} lost", flush=True)
        for seed in lost[: proof.arguments.wanted]:
            found = proof.explain(fault, seed)
            right = found["cause"] in words
            matrix.append({"fault": fault, "seed": seed, "cause": found["cause"], "part": found["part"], "right": int(right),
                           "no_return_s": found["no_return_s"], "flights": len(found["flights"])})
            best = ", ".join(f"{e['part']} {e['difference']:+.2f}" for e in found["effects"][:4])
            print(f"  {seed} {'right' if right else 'WRONG'} {found['cause']} ({found['part']}): {best}", flush=True)
    with open(proof.out / "matrix.csv", "w", newline="") as table:
        writer = csv.DictWriter(table, matrix[0].keys())
        writer.writeheader()
        writer.writerows(matrix)
    print(f"right: {sum(one['right'] for one in matrix)} of {len(matrix)}")


if __name__ == "__main__":
    main()
