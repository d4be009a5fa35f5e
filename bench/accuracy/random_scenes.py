#!/usr/bin/python3
"""Rooms, paths, depth cameras and SLAM drawn at random, and how far depthgrid run is off in them (python3-numpy).

    random_scenes.py DEPTHGRID FOLDER FIRST COUNT [--uneven | --odd] [-- ARGUMENT ...]

Scene i is a building of random_buildings.py up to 20 m long, its walls up to the ceiling, with or without furniture of
several forms and heights. The path leads between random places in it, 30 or 60 s, on a robot (the camera .25 to 1.2 m
high) or hand-held. Camera, depth noise, its artifacts, SLAM profile, drift, loops and losses are drawn as well. FOLDER
keeps the scenes (sI.yaml), paths (sI.path.txt), experiments (sI.run.yaml), the results of each run (sI.out) and those
of earlier calls; the arguments behind -- go to depthgrid run. The same number gives the same scene and settings.
--uneven: floors with rugs, platforms, ramps and lower parts, the drift of the SLAM profile itself and no losses; files
are uI. --odd: cameras from 6 cm to 2.2 m high, from 30 degrees up to 55 down, half of them on their side or head, and no
losses; files are oI. docs/results.md, "Random rooms".
"""
import csv
import json
import math
import os
import random
import subprocess
import sys

import numpy as np

sys.dont_write_bytecode = True  # nothing beside the script
import random_buildings as buildings  # noqa: E402

MOST_FRAMES = 1800
OPTICAL = np.array([[0, 0, 1], [-1, 0, 0], [0, -1, 0]])  # the camera's axes in those of a body: x ahead, z up


class Room(buildings.Building):
    """A building with heights, as shapes of a scene file."""

    def __init__(self, number):
        self.shapes = []
        self.look = np.random.default_rng(number + 77000)
        self.ceiling = float(self.look.uniform(2.3, 3.2))
        super().__init__(number)
        width, length, wall = self.width, self.height, 0.2
        self.add_floor()
        self.add_box(width + 1, length + 1, 0.1, width / 2, length / 2, self.ceiling)
        for x0, y0, x1, y1 in [(-wall, -wall, width + wall, 0), (-wall, length, width + wall, length + wall),
                               (-wall, 0, 0, length), (width, 0, width + wall, length)]:
            self.add_block(x0, y0, x1, y1)

    def add_box(self, sx, sy, sz, x, y, z, yaw_rad=0.0):
        self.shapes.append(f"{{shape: box, size: [{sx:.4f}, {sy:.4f}, {sz:.4f}], at: [{x:.4f}, {y:.4f}, {z:.4f}], "
                           f"yaw_deg: {math.degrees(yaw_rad):.3f}}}")

    def add_floor(self):
        self.add_box(self.width + 1, self.height + 1, 0.1, self.width / 2, self.height / 2, -0.1)

    def add_block(self, x0, y0, x1, y1):
        self.add_box(x1 - x0, y1 - y0, self.ceiling, (x0 + x1) / 2, (y0 + y1) / 2, 0)

    def add_wall(self, upright, at, half, begin, end):
        super().add_wall(upright, at, half, begin, end)
        half = max(half, 0.03)
        if upright:
            self.add_block(at - half, begin, at + half, end)
        else:
            self.add_block(begin, at - half, end, at + half)

    def furnish(self, count):
        look = self.look
        for _ in range(count):
            x, y = look.uniform(0, self.width), look.uniform(0, self.height)
            yaw_rad = look.choice([0, 0, 0, look.uniform(0, math.pi)])
            kind = look.choice(["box", "table", "cylinder", "cushion", "shelf", "box"])
            sx, sy = look.uniform(0.2, 1.6), look.uniform(0.2, 0.8)
            if kind == "cylinder":
                self.add_cylinder(x, y, look.uniform(0.08, 0.3), look.uniform(0.4, 2.2))
                continue
            if kind == "table":
                self.add_table(sx, sy, look.uniform(0.45, 1.1), x, y, yaw_rad)
            elif kind == "cushion":
                tall = look.uniform(0.4, 1.0)
                self.shapes.append(f"{{shape: superellipsoid, size: [{sx:.4f}, {sy:.4f}, {tall:.4f}], upright: 0.6, "
                                   f"level: 0.4, at: [{x:.4f}, {y:.4f}, {tall / 2:.4f}], "
                                   f"yaw_deg: {math.degrees(yaw_rad):.3f}}}")
            else:
                tall = look.uniform(1.2, 2.2) if kind == "shelf" else look.uniform(0.25, 1.5)
                self.add_box(sx, sy, tall, x, y, 0, yaw_rad)
            self.add_polygon(corners(sx, sy, x, y, yaw_rad))

    def add_cylinder(self, x, y, radius, tall):
        self.shapes.append(f"{{shape: cylinder, radius_m: {radius:.4f}, height_m: {tall:.4f}, "
                           f"at: [{x:.4f}, {y:.4f}, 0]}}")
        self.add_polygon([(x + radius * math.cos(k * math.pi / 8), y + radius * math.sin(k * math.pi / 8))
                          for k in range(16)])

    def add_table(self, sx, sy, tall, x, y, yaw_rad):
        self.add_box(sx, sy, 0.04, x, y, tall - 0.04, yaw_rad)
        for leg_x, leg_y in corners(sx - 0.06, sy - 0.06, x, y, yaw_rad):
            self.add_box(0.05, 0.05, tall - 0.04, leg_x, leg_y, 0, yaw_rad)


class UnevenRoom(Room):
    """One with rugs, platforms, ramps and lower floors beside the way; over a rug of up to 12 cm it also leads."""

    def add_floor(self):
        look, holes = self.look, []
        for kind in look.choice(["rug", "platform", "ramp", "lower"], size=2, replace=False):
            for _ in range(int(look.integers(1, 3))):
                sx, sy = look.uniform(0.8, 3, 2)
                x, y = look.uniform(0.5, self.width - 0.5), look.uniform(0.5, self.height - 0.5)
                if kind == "rug":
                    self.add_box(sx, sy, look.uniform(0.01, 0.12), x, y, 0, look.uniform(0, math.pi))
                    continue
                if kind == "platform":
                    self.add_box(sx, sy, look.uniform(0.13, 0.5), x, y, 0)
                elif kind == "ramp":
                    self.add_ramp(sx, sy, look.uniform(3, 10), x, y)
                elif any(abs(x - u) < (sx + w) / 2 + 0.2 and abs(y - v) < (sy + h) / 2 + 0.2
                         for u, v, w, h, _ in holes):
                    continue
                else:
                    holes.append((x, y, sx, sy, look.uniform(0.08, 0.6)))
                self.add_polygon(corners(sx, sy, x, y, 0.0))
        self.lay_around(holes)

    def add_ramp(self, sx, sy, degrees, x, y):
        """Up along x, its upper edge a drop."""
        rise = sx * math.tan(math.radians(degrees))
        self.shapes.append(f"{{shape: prism, outline: [[0, 0], [{sx:.4f}, 0], [{sx:.4f}, {rise:.4f}]], "
                           f"height_m: {sy:.4f}, at: [{x - sx / 2:.4f}, {y + sy / 2:.4f}, 0], rpy_deg: [90, 0, 0]}}")

    def lay_around(self, holes):
        """The floor in strips from hole to hole, and the lower floors."""
        cuts = sorted({-0.5, self.width + 0.5, *(x + side * sx / 2 for x, _, sx, _, _ in holes for side in (-1, 1))})
        for x0, x1 in zip(cuts, cuts[1:]):
            across = [(y, sy) for x, y, sx, sy, _ in holes if abs((x0 + x1) / 2 - x) < sx / 2]
            ends = [-0.5, *(y + side * sy / 2 for y, sy in sorted(across) for side in (-1, 1)), self.height + 0.5]
            for y0, y1 in zip(ends[::2], ends[1::2]):
                if y1 > y0:
                    self.add_box(x1 - x0, y1 - y0, 0.8, (x0 + x1) / 2, (y0 + y1) / 2, -0.8)
        for x, y, sx, sy, depth in holes:
            self.add_box(sx + 0.2, sy + 0.2, 0.1, x, y, -depth - 0.1)


def corners(sx, sy, x, y, yaw_rad):
    c, s = math.cos(yaw_rad), math.sin(yaw_rad)
    return [(x + c * u - s * v, y + s * u + c * v)
            for u, v in [(-sx / 2, -sy / 2), (sx / 2, -sy / 2), (sx / 2, sy / 2), (-sx / 2, sy / 2)]]


def wander(chance, count, sigma, frames):
    """An error that lasts about so many frames (Ornstein-Uhlenbeck), smoothed over half a second."""
    keeps = math.exp(-1 / frames)
    values, value = np.zeros(count), chance.normal() * sigma
    for i in range(count):
        values[i] = value
        value = keeps * value + math.sqrt(1 - keeps * keeps) * chance.normal() * sigma
    window = np.hanning(15)
    return np.convolve(np.pad(values, 7, mode="edge"), window / window.sum(), "valid")


def quaternion(rotation):
    """x y z w, w >= 0 (Bar-Itzhack 2000)."""
    m = rotation
    k = np.array([[m[0, 0] - m[1, 1] - m[2, 2], 0, 0, 0], [m[1, 0] + m[0, 1], m[1, 1] - m[0, 0] - m[2, 2], 0, 0],
                  [m[2, 0] + m[0, 2], m[2, 1] + m[1, 2], m[2, 2] - m[0, 0] - m[1, 1], 0],
                  [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], m.trace()]]) / 3
    values, vectors = np.linalg.eigh(k)
    q = vectors[:, np.argmax(values)]
    return q if q[3] > 0 else -q


def camera_path(poses, drawn, number):
    """TUM lines of a camera carried along poses x y yaw."""
    chance = np.random.default_rng(number + 99000)
    hand, count = drawn["hand"], len(poses)
    up = wander(chance, count, 0.06 if hand else 0.0, 60)
    pitch = wander(chance, count, 4 if hand else 0.15, 45)
    roll = wander(chance, count, 2.5 if hand else 0.15, 45)
    aside = wander(chance, count, 6 if hand else 0, 60)
    for k, (x, y, yaw) in enumerate(poses):
        a, b = yaw + math.radians(aside[k]), math.radians(-(drawn["pitch"] + pitch[k]))
        c = math.radians(drawn.get("roll", 0) + roll[k])
        about_z = np.array([[math.cos(a), -math.sin(a), 0], [math.sin(a), math.cos(a), 0], [0, 0, 1]])
        about_y = np.array([[math.cos(b), 0, math.sin(b)], [0, 1, 0], [-math.sin(b), 0, math.cos(b)]])
        about_x = np.array([[1, 0, 0], [0, math.cos(c), -math.sin(c)], [0, math.sin(c), math.cos(c)]])
        yield "%.6f %.6f %.6f %.6f %.9f %.9f %.9f %.9f\n" % (
            k / buildings.RATE_HZ, x, y, drawn["height"] + up[k], *quaternion(about_z @ about_y @ about_x @ OPTICAL))


def odd_stand(number, hand):
    chance = random.Random(number * 1000 + 11)
    height = chance.uniform(0.6, 1.9) if hand else chance.choice([chance.uniform(0.06, 0.2), chance.uniform(0.2, 2.2)])
    return {"height": height, "pitch": chance.choice([0, 10, 20, 30, -10, -25, -30, -35, -45, -55]),
            "roll": chance.choice([0, 0, 0, 90, -90, 180])}


def settings_of(number, kind):
    chance = random.Random(number * 1000 + 7)
    camera, noise = chance.choice([("icl_nuim", "handa"), ("tum_fr1", "nguyen"), ("d435", "d435"),
                                   ("kinect_v2", "kinect_v2"), ("azure", "azure"), ("kinect_v1", "nguyen")])
    hand = chance.random() < 0.4
    profile = chance.choice(["orb_slam2", "planar_slam", "planar_slam_mh", "orb_slam2_measured",
                             "planar_slam_measured", "orb_slam2_desk"])
    height = chance.uniform(0.9, 1.5) if hand else chance.uniform(0.25, 1.2)
    pitch = chance.choice([0, -5, -15, 5])
    measured = profile.endswith(("measured", "desk"))
    drawn = {"camera": camera, "noise": noise, "hand": hand, "profile": profile, "height": height, "pitch": pitch,
             "drift_scale": chance.choice([None, 1, 3] if measured else [None, 5, 15, 40]),
             "scenario": chance.choice([None, None, "none", "late", "missed", "false"]),
             "flying": chance.choice([0, 0, 0.3]), "shadow": chance.choice([0, 0.075]),
             "alike": chance.choice([0, 0, 3]), "lost": chance.choice([0, 0, 0, 0.02])}
    if kind == "--uneven":
        drawn.update(drift_scale=None, lost=0)
    if kind == "--odd":
        drawn.update(odd_stand(number, hand), lost=0)
    return drawn


def experiment(number, scene, drawn):
    lines = [f"scene: ./{scene}.yaml", f"trajectory: ./{scene}.path.txt", f"seed: {number + 1}",
             f"sensor: {{camera: {drawn['camera']}, noise: {drawn['noise']}, flying_pixels: {drawn['flying']}, "
             f"shadow_baseline_m: {drawn['shadow']}, noise_correlation_px: {drawn['alike']}}}",
             "slam:", f"  profile: {drawn['profile']}"]
    if drawn["drift_scale"]:
        lines.append(f"  drift_scale: {drawn['drift_scale']}")
    if drawn["scenario"]:
        lines.append(f"  loops: {{scenario: {drawn['scenario']}}}")
    if drawn["lost"]:
        lines += [f"  lost_rate_hz: {drawn['lost']}", "  lost_mean_s: 1", "  relocalisation_translation_m: 0.05",
                  "  relocalisation_rotation_deg: 2"]
    return "".join(line + "\n" for line in lines)


def write_scene(number, folder, scene, drawn, uneven):
    # every third building is one of 20 to 45 m
    room = (UnevenRoom if uneven else Room)(number if number % 3 != 2 else number + 1)
    poses = buildings.way_through(room)
    if poses is None:
        return False
    with buildings.written(f"{folder}/{scene}.yaml") as file:
        file.write("floor_z_m: 0\nshapes:\n" + "".join(f"  - {shape}\n" for shape in room.shapes))
    with buildings.written(f"{folder}/{scene}.path.txt") as file:
        file.writelines(camera_path(poses[:MOST_FRAMES], drawn, number))
    with buildings.written(f"{folder}/{scene}.run.yaml") as file:
        file.write(experiment(number, scene, drawn))
    return True


def scores_of(folder):
    """Mean error of SLAM, online and final, m; F1 of observable walls; share of frames in which the camera was taken to
    be 4 cm higher or lower above the floor than it is."""
    with open(folder + "/metrics.json", encoding="ascii") as file:
        metrics = json.load(file)
    errors = [metrics["trajectory"][name]["mean_euclidean_m"] for name in ("slam", "online", "est")]
    with open(folder + "/trajectory_truth.txt", encoding="ascii") as file:
        true_m = {line.split()[0]: float(line.split()[3]) for line in file if not line.startswith("#")}
    with open(folder + "/frames.csv", encoding="ascii") as file:
        off_m = [abs(float(row["camera_height_m"]) - true_m[row["stamp_s"]])
                 for row in csv.DictReader(file) if row["camera_height_m"]]
    # None where no wall is observable
    return [*errors, metrics["map"]["observable"]["occupied"]["f1"] or 0.0, float(np.mean(np.array(off_m) > 0.04))]


def main():
    command = buildings.read_command(__doc__, "depthgrid", "--uneven", "--odd")
    if command is None:
        return 2
    program, folder, numbers, kind, more = command
    rows = []
    for number in numbers:
        drawn, scene = settings_of(number, kind), f"{kind[2] if kind else 's'}{number}"
        name = f"{folder}/{scene}"
        if not os.path.exists(name + ".run.yaml") and not write_scene(number, folder, scene, drawn, kind == "--uneven"):
            continue
        done = subprocess.run([program, "run", name + ".run.yaml", "-o", name + ".out", "--force", *more],
                              capture_output=True, text=True, check=False)
        if done.returncode != 0:
            return buildings.refuse(done.stderr.strip())
        rows.append(scores_of(name + ".out"))
        print(scene, *(f"{key} {value}" for key, value in drawn.items()),
              "slam %.4f online %.4f final %.4f f1 %.3f height off %.3f" % tuple(rows[-1]), flush=True)
    if not rows:
        return buildings.refuse("no building has room for a way")
    off = np.array(rows)
    scores = "%s of slam %.4f online %.4f final %.4f f1 %.3f height off %.3f;"
    print(f"{len(rows)} runs", scores % ("mean", *np.mean(off, axis=0)), scores % ("median", *np.median(off, axis=0)),
          f"worse than SLAM by more than 1 cm: online {int((off[:, 1] > off[:, 0] + 0.01).sum())}, "
          f"final {int((off[:, 2] > off[:, 0] + 0.01).sum())}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
