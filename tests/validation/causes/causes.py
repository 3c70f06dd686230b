#!/usr/bin/env python3
"""Asks understory explain for the causes of lost flights, planted and not (docs/causes.md).

causes.py planted --seeds 2000..3999 --out FOLDER [--only "forgetting at once;a pitot step"]
    plants each fault into flights. Of its lost flights, the first ten are explained that the fault decides: without it
    the flight arrives at least nine times of ten, whatever the noise from the fault's moment on, and with it at most
    five times. (Of a fault with which more than half of all flights are lost, the second is not flown.)
    Writes confusion.md.
causes.py lost --seeds 4001..4999 --out FOLDER [--only "paper;dense"] [--again "paper;dense"]
    flies each scenario until ten flights are lost and explains them; those of --again twice, with other noise.
    Writes causes.md and causes.svg.

FOLDER/planted and FOLDER/lost keep flown.csv (a row for each fault or scenario that is done, which is not flown
again) and explained.csv (a row for each explained flight).
"""

import argparse
import csv
import json
import shutil
import subprocess
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

AT_S = 3.0
WEAK_ELEVONS = f"{{sensor: elevons, kind: weaken, at_s: {AT_S}, value: 0.5}}"
COVER = f"{{sensor: camera, kind: cover, at_s: {AT_S}, value: 0.5}}"
FORGET = f"{{sensor: map, kind: dropout, at_s: {AT_S}}}"
TURNED = {"estimation.source": "turned", "estimation.turned.at_s": AT_S, "estimation.turned.yaw_rad": 0.4}
WALL = ", ".join(f"{{name: wall{i}, shape: capsule, position_m: [55, {-24.5 + 0.7 * i}, 5], size_m: [0.4, 0.4, 10]}}"
                 for i in range(71))
# fault: the words that explain must say (of two faults, any of these), the keys that plant it
FAULTS = {
    "a trunk made invisible": (["not detected"], {"perception.detector": "unseeing", "perception.unseeing.at_s": AT_S}),
    "a blind sector": (["never in view", "seen too late"], {"faults": f"[{COVER}]"}),
    "points across the way": (["false obstacle"], {"perception.detector": "imagining", "perception.imagining.at_s": AT_S}),
    "forgetting at once": (["forgotten"], {"faults": f"[{FORGET}]"}),
    "a yaw step": (["wrong place"], TURNED),
    "80 ms more latency": (["too late"], {"faults": f"[{{sensor: camera, kind: delay, at_s: {AT_S}, value: 0.08}}]"}),
    "5 iterations, no fallback": (["not found"], {"autopilot.method": "cut_short", "autopilot.cut_short.at_s": AT_S}),
    "weak elevons": (["not flown"], {"faults": f"[{WEAK_ELEVONS}]"}),
    "a pitot step": (["sensor's fault"], {"faults": f"[{{sensor: pitot, kind: bias, at_s: {AT_S}, value: 6}}]"}),
    "a wall of trunks": (["infeasible"], {"obstacles": f"[{WALL}]"}),
    "two: blind sector, weak elevons": (["joint", "never in view", "seen too late", "not flown"],
                                        {"faults": f"[{COVER}, {WEAK_ELEVONS}]"}),
    "two: forgetting, yaw step": (["joint", "forgotten", "wrong place"], {"faults": f"[{FORGET}]", **TURNED}),
}
# The forest of dense, seen at one depth of 10 m. Few of its flights are lost with some faults, and most of them by
# chance: a search cut short decides more where trees stand closer and are all seen, lateness where the sight is short,
# and a pitot step only a filter that goes on believing it.
DENSE = {"forest.square_metres_per_tree": 25}
SETTINGS = {"80 ms more latency": {"perception.depths_m": "[6]"},
            "5 iterations, no fallback": {"forest.square_metres_per_tree": 12, "perception.detector": "true_depth"},
            "a pitot step": {"estimation.filter.distrust.exclude": "false"}}
SCENARIOS = ["paper", "dense", "woods_dense", "rough_sensors", "inventory_5cm", "inventory_3cm"]
CAUSES = ["never in view", "seen too late", "not detected", "false obstacle", "forgotten", "wrong place", "sensor's fault",
          "too late", "not found", "not flown", "joint", "infeasible", "chance", "sight", "map"]


def seeds_in(text):
    first, last = text.split("..")
    return list(range(int(first), int(last) + 1))


def slug(words):
    return "_".join(words.replace(",", "").replace(":", "").split())


def blocks(entries, size):
    return (entries[i:i + size] for i in range(0, len(entries), size))


def is_lost(row, after_s=0.0):
    return row["outcome"] not in ("goal", "time") and float(row["simulated_s"]) > after_s


class Flights:
    def __init__(self, arguments):
        self.arguments = arguments
        self.out = Path(arguments.out) / arguments.what
        self.known = {}
        self.out.mkdir(parents=True, exist_ok=True)

    def kept(self, table):
        file = self.out / f"{table}.csv"
        if not file.exists():
            return []
        with open(file, newline="") as text:
            return list(csv.DictReader(text))

    def keep(self, table, *rows):
        """Adds these rows, which are dictionaries, to that table."""
        rows = [*self.kept(table), *rows]
        with open(self.out / f"{table}.csv", "w", newline="") as text:
            writer = csv.DictWriter(text, rows[-1].keys(), restval="", lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)

    def run(self, *words):
        command = [self.arguments.program, *map(str, words), "--renderer", self.arguments.renderer]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode not in (0, 1):
            raise SystemExit(f"{' '.join(command)}\n{done.stderr}")

    def to_do(self, names):
        done = {row["of"] for row in self.kept("flown")}
        return [name for name in self.arguments.only or names if name not in done]

    def campaign(self, name, scenario, seeds, overrides):
        """The rows of these flights."""
        lines = [f"scenario: {scenario}", f"seeds: {seeds}", "overrides:"]
        for override, keys in overrides.items():
            lines.append(f"  - {{name: {override}, set: {{" + ", ".join(f"{k}: {v}" for k, v in keys.items()) + "}}")
        file = self.out / f"{name}.yaml"
        file.write_text("\n".join(lines) + "\n")
        folder = self.out / name
        self.run("campaign", file, "--out", folder, *(["--resume"] if (folder / "campaign.json").exists() else []))
        with open(folder / "flights.csv", newline="") as table:
            return list(csv.DictReader(table))

    def explain(self, run, condition, seed, *options):
        """What explain says of that flight, in its run's folder; flown and explained where it is not yet."""
        if not (run / "explain.json").exists():
            shutil.rmtree(run, ignore_errors=True)
            self.run("fly", condition, "--seed", seed, "--out", run, "--quiet")
            self.run("explain", run, *options)
        return json.loads((run / "explain.json").read_text())

    def explain_all(self, of, name, seeds, *options, folder="runs"):
        condition = next((self.out / name / "conditions").glob("*.yaml"))
        kept = {int(one["seed"]): one for one in self.kept("explained") if (one["of"], one["folder"]) == (of, folder)}
        seeds_left = [seed for seed in seeds if seed not in kept]
        with ThreadPoolExecutor(self.arguments.at_once) as pool:
            found = list(pool.map(lambda seed: self.explain(self.out / folder / f"{name}-{seed}", condition, seed, *options),
                                  seeds_left))
        new = [{"of": of, "seed": seed, "folder": folder, "cause": one["cause"], "part": one["part"],
                "effects": ", ".join(f"{e['part']} {e['difference']:+.2f}" for e in one["effects"])}
               for seed, one in zip(seeds_left, found)]
        for row in new:
            print(f"  {name} {row['seed']}: {row['cause']} ({row['part']}): {row['effects']}", flush=True)
        if new:
            self.keep("explained", *new)
        return [kept[seed] for seed in seeds if seed in kept] + new

    def arrivals(self, name, seeds, keys):
        """How often of ten each seed's flight arrives with other noise from the fault's moment on."""
        known = self.known.setdefault(str(keys), {})
        new = [seed for seed in seeds if seed not in known]
        if new:
            redraws = {f"r{k}": {"ideal.redraw": k, "ideal.from_s": AT_S, **keys} for k in range(1, 11)}
            rows = self.campaign(f"{name}-{new[0]}", "forest", new, redraws)
            for seed in new:
                known[seed] = sum(row["outcome"] == "goal" for row in rows if int(row["seed"]) == seed)
        return known


def planted(flights):
    plugin = {"plugins": f"[{{file: {Path(flights.arguments.plugin).resolve()}}}]"}
    for fault in flights.to_do(FAULTS):
        name = slug(fault)
        setting = {**DENSE, **SETTINGS.get(fault, {})}
        keys = {**plugin, **FAULTS[fault][1], **setting}
        explained, flown, lost, undecided = [], 0, 0, 0
        for block in blocks(seeds_in(flights.arguments.seeds), flights.arguments.block):
            rows = flights.campaign(f"{name}-{block[0]}", "forest", block, {name: keys})
            # A flight that ends 0.3 s after the fault was lost before it.
            its = [int(row["seed"]) for row in rows if is_lost(row, AT_S + 0.3)]
            flown, lost = flown + len(rows), lost + len(its)
            new = []
            for some in blocks(its, 12):
                if len(explained) + len(new) >= flights.arguments.wanted:
                    break
                arrive = flights.arrivals(f"without-{name}", some, setting)
                sound = [seed for seed in some if arrive[seed] >= 9]
                if 2 * lost <= flown and sound:
                    arrive = flights.arrivals(f"with-{name}", sound, keys)
                    undecided += sum(arrive[seed] > 5 for seed in sound)
                    sound = [seed for seed in sound if arrive[seed] <= 5]
                new += sound
            new = new[: flights.arguments.wanted - len(explained)]
            explained += flights.explain_all(fault, f"{name}-{block[0]}", new)
            if len(explained) == flights.arguments.wanted:
                break
        right = sum(one["cause"] in FAULTS[fault][0] for one in explained)
        print(f"{fault}: {lost} of {flown} lost, {undecided} by chance, {right} of {len(explained)} right", flush=True)
        flights.keep("flown", {"of": fault, "flown": flown, "lost": lost, "by_chance": undecided})
    said = {fault: [] for fault in FAULTS}
    for one in flights.kept("explained"):
        said[one["of"]].append(one["cause"])
    said = {fault: some for fault, some in said.items() if some}
    causes = [cause for cause in CAUSES if any(cause in some for some in said.values())]
    lines = ["| planted | right | " + " | ".join(causes) + " |", "|---|---:|" + "---:|" * len(causes)]
    for fault, some in said.items():
        counts = Counter(some)
        right = sum(counts[word] for word in FAULTS[fault][0])
        cells = [f"**{counts[c]}**" if c in FAULTS[fault][0] and counts[c] else str(counts[c] or "") for c in causes]
        lines.append(f"| {fault} | {right} of {len(some)} | " + " | ".join(cells) + " |")
    (flights.out / "confusion.md").write_text("\n".join(lines) + "\n")


def bars(counts):
    """One stacked bar of causes for each scenario, as SVG."""
    colours = ["#4477aa", "#66ccee", "#228833", "#ccbb44", "#ee6677", "#aa3377", "#997700", "#bbbbbb", "#ee8866", "#44bb99",
               "#77aadd", "#222222", "#dddddd", "#99ddff", "#bbcc33"]
    shown = [cause for cause in CAUSES if any(one[cause] for one in counts.values())]
    rows, text = [], 'font-family="sans-serif" font-size="13"'
    for i, (scenario, some) in enumerate(counts.items()):
        x, y, scale = 130, 10 + 30 * i, 460 / max(1, sum(some.values()))
        rows.append(f'<text x="120" y="{y + 15}" text-anchor="end" {text}>{scenario}</text>')
        for cause in shown:
            if some[cause]:
                rows.append(f'<rect x="{x:.1f}" y="{y}" width="{some[cause] * scale:.1f}" height="22" stroke="white" '
                            f'fill="{colours[CAUSES.index(cause)]}"><title>{cause}: {some[cause]}</title></rect>'
                            f'<text x="{x + some[cause] * scale / 2:.1f}" y="{y + 16}" text-anchor="middle" {text}>'
                            f'{some[cause]}</text>')
                x += some[cause] * scale
    for i, cause in enumerate(shown):
        y = 12 + 20 * i
        rows.append(f'<rect x="610" y="{y}" width="14" height="14" fill="{colours[CAUSES.index(cause)]}"/>'
                    f'<text x="630" y="{y + 12}" {text}>{cause}</text>')
    height = 20 + max(30 * len(counts), 20 * len(shown))
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 740 {height}"><rect width="740" height="{height}" '
            'fill="white"/>' + "".join(rows) + "</svg>\n")


def lost(flights):
    for scenario in flights.to_do(SCENARIOS):
        found, again, flown, all_lost = [], [], 0, 0
        for block in blocks(seeds_in(flights.arguments.seeds), flights.arguments.block):
            name = f"{scenario}-{block[0]}"
            rows = flights.campaign(name, scenario, block, {"as_it_is": {}})
            its = [int(row["seed"]) for row in rows if is_lost(row)]
            flown, all_lost = flown + len(rows), all_lost + len(its)
            its = its[: flights.arguments.wanted - len(found)]
            found += flights.explain_all(scenario, name, its)
            if scenario in flights.arguments.again:
                again += flights.explain_all(scenario, name, its, "--first-seed", 1001, folder="again")
            if len(found) == flights.arguments.wanted:
                break
        flights.keep("flown", {"of": scenario, "flown": flown, "lost": all_lost})
    counts, lines = {}, ["| scenario | flown, lost | causes of those explained |", "|---|---:|---|"]
    explained = flights.kept("explained")
    for row in flights.kept("flown"):
        counts[row["of"]] = Counter(one["cause"] for one in explained if (one["of"], one["folder"]) == (row["of"], "runs"))
        words = ", ".join(f"{count} {cause}" for cause, count in counts[row["of"]].most_common())
        lines.append(f"| {row['of']} | {row['flown']}, {row['lost']} | {words} |")
    causes = {(one["of"], one["seed"], one["folder"]): one["cause"] for one in explained}
    again = [(causes[of, seed, "runs"], cause) for (of, seed, folder), cause in causes.items() if folder == "again"]
    if again:
        same = sum(first == second for first, second in again)
        lines.append(f"\nExplained twice, with other noise: {same} of {len(again)} flights had the same cause.")
    (flights.out / "causes.md").write_text("\n".join(lines) + "\n")
    (flights.out / "causes.svg").write_text(bars(counts))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["planted", "lost"])
    parser.add_argument("--program", default="build/release/understory")
    parser.add_argument("--plugin", default="build/release/tests/validation/planted_faults.so")
    parser.add_argument("--seeds", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--wanted", type=int, default=10)
    parser.add_argument("--block", type=int, default=40, help="fly so many seeds before lost flights are counted")
    parser.add_argument("--only", type=lambda text: text.split(";"), help="faults or scenarios, with ; between them")
    parser.add_argument("--again", type=lambda text: text.split(";"), default=[], help="scenarios, likewise")
    parser.add_argument("--renderer", default="osmesa")
    parser.add_argument("--at-once", type=int, default=1, help="explain so many flights at once")
    arguments = parser.parse_args()
    {"planted": planted, "lost": lost}[arguments.what](Flights(arguments))


if __name__ == "__main__":
    main()
