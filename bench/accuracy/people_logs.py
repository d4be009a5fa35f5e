#!/usr/bin/python3
"""Laser logs with people before the robot, drawn at random, and how far depthgrid map is off in
them (python3-numpy).

    people_logs.py make DIR FIRST_SEED
    people_logs.py score DEPTHGRID DIR STARTS [-- --set KEY=VALUE ...]

make writes 27 logs to DIR: KIND_SEED.log (CARMEN, ROBOTLASER1, the poses are odometry) and
KIND_SEED.truth.txt (TUM, the true poses), the seeds of each kind from FIRST_SEED on. Kinds are
tunnel, corridor, tworooms, yard, hall and turn (on the spot), the laser with 640 beams over 58
degrees, or 360 over 180 where a w is appended. One to three people, a third of them as two legs,
walk along with the robot or cross its way. The same seed gives the same log.

score maps each log of DIR from its frames 0 to STARTS - 1 on and prints the mean error of the
positions by kind and of all, m, at the end (final) and as they were given (online), of each log the
mean and the worst in brackets, the runs above .1 and .04 m and the geometric mean. The arguments
behind -- go to depthgrid map. docs/tried.md, "Misfits one by one".

The world is x y in m, yaw in rad counterclockwise from x; the laser is the robot's centre, looks
along yaw and is read 30 times a second. Walls are lines x0 y0 x1 y1.
"""
import glob
import math
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from typing import NamedTuple

import numpy as np

sys.dont_write_bytecode = True  # nothing beside the script
from people_worlds import draw_person, draw_world, outlines  # noqa: E402
from random_buildings import RATE_HZ, refuse, written  # noqa: E402

LOGS_OF_KIND = {"tunnel": 4, "tunnelw": 2, "corridor": 4, "corridorw": 2, "tworooms": 3, "yard": 2,
                "yardw": 1, "hall": 2, "hallw": 1, "turn": 4, "turnw": 2}
FIRST_TIME_S = 1000
LEAST_RANGE_M = 0.3  # nearer is read as 0
RANGE_NOISE = 0.01  # of the range
RUNS_AT_ONCE = 2


class Laser(NamedTuple):
    angles: np.ndarray
    step: float
    fov: float
    reach: float


# ---- Odometry


def motion_between(a, b):
    """From pose a to pose b, in the axes of a."""
    dx, dy = b[:2] - a[:2]
    c, s = np.cos(a[2]), np.sin(a[2])
    return np.array([c * dx + s * dy, -s * dx + c * dy, b[2] - a[2]])


def moved_by(pose, motion):
    c, s = np.cos(pose[2]), np.sin(pose[2])
    return np.array([pose[0] + c * motion[0] - s * motion[1],
                     pose[1] + s * motion[0] + c * motion[1], pose[2] + motion[2]])


def lasting_noise(count, chance, frames):
    """Of variance 1, that is forgotten in so many frames (Ornstein-Uhlenbeck)."""
    kept = np.exp(-1 / frames)
    fresh, value = chance.standard_normal(count), chance.standard_normal()
    noise = np.zeros(count)
    for k in range(count):
        value = kept * value + np.sqrt(1 - kept * kept) * fresh[k]
        noise[k] = value
    return noise


def motion_errors(motions, chance):
    count = len(motions)
    way, turned = np.hypot(motions[:, 0], motions[:, 1]), np.abs(motions[:, 2])
    ahead = lasting_noise(count, chance, 200) * (0.03 * way + 0.0004)
    aside = (lasting_noise(count, chance, 60) * 0.6 + chance.standard_normal(count)) * 0.0004
    yaw = lasting_noise(count, chance, 80) * 0.8 + chance.standard_normal(count)
    moves = way + 0.3 * turned > 1e-6
    return np.stack([ahead, aside, yaw * (0.0005 + 0.02 * turned)], 1) * moves[:, None]


def odometry(path, chance, drift):
    """The path with errors scaled so that it is drift (m) off on average."""
    motions = np.array([motion_between(a, b) for a, b in zip(path, path[1:])])
    errors = motion_errors(motions, chance)

    def drifted(scale):
        poses = [path[0]]
        for motion in motions + scale * errors:
            poses.append(moved_by(poses[-1], motion))
        return np.array(poses)

    low, high = 0.0, 20.0
    for _ in range(18):
        middle = (low + high) / 2
        poses = drifted(middle)
        if np.hypot(*(poses - path)[:, :2].T).mean() < drift:
            low = middle
        else:
            high = middle
    return poses


# ---- The laser and the logs


def laser_of(wide, reach):
    beams, fov = (360, np.radians(180)) if wide else (640, np.radians(58))
    step = fov / (beams - 1 if wide else beams)
    return Laser(-step * (beams - 1) / 2 + step * np.arange(beams), step, fov, reach)


def ranges_to(walls, pose, laser):
    """The distance to the first wall on each beam, inf where there is none."""
    x, y = walls[:, 0] - pose[0], walls[:, 1] - pose[1]
    dx, dy = walls[:, 2] - walls[:, 0], walls[:, 3] - walls[:, 1]
    nearest_end = np.minimum(np.hypot(x, y), np.hypot(x + dx, y + dy))
    near = nearest_end < laser.reach + np.hypot(dx, dy)
    x, y, dx, dy = x[near], y[near], dx[near], dy[near]
    c, s = np.cos(laser.angles + pose[2])[:, None], np.sin(laser.angles + pose[2])[:, None]
    with np.errstate(all="ignore"):  # beams along a wall
        across = c * dy - s * dx
        away = (x * dy - y * dx) / across
        along = (x * s - y * c) / across
    away[(along < 0) | (along > 1) | (away <= 0) | ~np.isfinite(away)] = np.inf
    return away.min(1)


def measured(ranges, laser, noise):
    factors = 1 + RANGE_NOISE * noise.standard_normal(len(ranges))
    ranges = np.where(np.isfinite(ranges), ranges * factors, np.inf)
    return np.where(ranges < LEAST_RANGE_M, 0, np.minimum(ranges, laser.reach))


def carmen_line(time, laser, ranges, pose):
    x_y_yaw = "%.6f %.6f %.7f" % tuple(pose)
    head = "ROBOTLASER1 0 %.9f %.9f %.12f %.3f 0.01 0 %d" % (
        laser.angles[0], laser.fov, laser.step, laser.reach, len(ranges))
    beams = " ".join("%.4f" % r for r in ranges)
    return f"{head} {beams} 0 {x_y_yaw} {x_y_yaw} 0 0 0.3 0.3 1 {time:.6f} h {time:.6f}\n"


def tum_line(time, pose):
    x, y, yaw = pose
    return f"{time:.6f} {x:.6f} {y:.6f} 0 0 0 {np.sin(yaw / 2):.9f} {np.cos(yaw / 2):.9f}\n"


def drift_of(place, path, chance):
    drift = chance.uniform(0.1, 0.4) * (1 if len(path) > 400 else 0.3)
    return drift * 0.15 if place == "turn" else drift


def write_log(kind, seed, name):
    """NAME.log and NAME.truth.txt."""
    place, wide = kind.removesuffix("w"), kind.endswith("w")
    chance = np.random.default_rng([seed, sum(map(ord, kind))])
    world = draw_world(place, chance)
    path = world.path
    laser = laser_of(wide, 10.0 if place == "yard" else chance.choice([6.0, 6.0, 10.0]))
    drift = drift_of(place, path, chance)
    people = [draw_person(place, world, chance) for _ in range(chance.integers(1, 4))]
    poses = odometry(path, np.random.default_rng(seed + 77), drift)
    noise = np.random.default_rng(seed + 999)
    with written(name + ".log") as log, written(name + ".truth.txt") as truth:
        for k, pose in enumerate(path):
            seen = [world.walls] + [line for one in people for line in outlines(one, k)]
            ranges = measured(ranges_to(np.concatenate(seen), pose, laser), laser, noise)
            time = FIRST_TIME_S + k / RATE_HZ
            log.write(carmen_line(time, laser, ranges, poses[k]))
            truth.write(tum_line(time, pose))


def make(arguments):
    folder, first = arguments
    if not first.isdecimal():
        return refuse(f"FIRST_SEED: is '{first}', must be a whole number")
    logs = [(kind, int(first) + k) for kind, count in LOGS_OF_KIND.items() for k in range(count)]
    try:
        os.makedirs(folder, exist_ok=True)
        with ProcessPoolExecutor(RUNS_AT_ONCE) as pool:
            list(pool.map(write_log, *zip(*logs), [f"{folder}/{kind}_{k}" for kind, k in logs]))
    except OSError as error:
        return refuse(f"{folder}: {error.strerror}")
    return 0


# ---- Scores


def read_trajectory(path):
    """Times, and x y yaw."""
    rows = np.loadtxt(path)
    yaws = 2 * np.arctan2(rows[:, 6], rows[:, 7])
    return rows[:, 0], np.column_stack([rows[:, 1:3], yaws])


def mean_error(truth_path, estimate_path):
    """Of the positions, m, the first pose laid on the true one."""
    times, truth = read_trajectory(truth_path)
    estimate_times, estimate = read_trajectory(estimate_path)
    truth = truth[np.searchsorted(times, estimate_times - 1e-4)]
    turned = truth[0, 2] - estimate[0, 2]
    c, s = np.cos(turned), np.sin(turned)
    x, y = (estimate[:, :2] - estimate[0, :2]).T
    laid = np.stack([c * x - s * y, s * x + c * y], 1) + truth[0, :2]
    return np.hypot(*(laid - truth[:, :2]).T).mean()


def errors_of_run(program, log, start, more):
    """Final and online; RuntimeError with what the program said."""
    with tempfile.TemporaryDirectory() as folder:
        out = f"{folder}/out"
        since = ["--set", f"sequence.from_s={start / RATE_HZ - 0.01:.4f}"] if start else []
        done = subprocess.run([program, "map", log, "-o", out, *since, *more],
                              capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(done.stderr.strip())
        return [mean_error(log.removesuffix(".log") + ".truth.txt", f"{out}/trajectory_{which}.txt")
                for which in ("est", "online")]


def print_kind(kind, errors):
    """errors: log, start, final and online."""
    final, online = errors[..., 0].mean(), errors[..., 1].mean()
    logs = " ".join(f"{of_log.mean():.3f}({of_log.max():.3f})" for of_log in errors[..., 0])
    print(f"{kind:<10} final {final:.4f} online {online:.4f} | by log: {logs}")


def print_all(errors):
    final, online = errors[..., 0].ravel(), errors[..., 1]
    print(f"{'ALL':<10} final {final.mean():.4f} online {online.mean():.4f}  "
          f"over .1: {(final > 0.1).sum()} over .04: {(final > 0.04).sum()} of {len(final)}  "
          f"geo {math.exp(np.log(final).mean()):.4f}")


def score(arguments, more):
    program, folder, starts = arguments
    if not os.access(program, os.X_OK):
        return refuse(f"{program}: is no program (./dev build depthgrid)")
    if not starts.isdecimal() or int(starts) < 1:
        return refuse(f"STARTS: is '{starts}', must be a whole number from 1 on")
    logs = sorted(glob.glob(f"{glob.escape(folder)}/*.log"))
    if not logs:
        return refuse(f"{folder}: has no logs (people_logs.py make {folder} FIRST_SEED)")
    runs = [(log, start) for log in logs for start in range(int(starts))]
    try:
        with ThreadPoolExecutor(RUNS_AT_ONCE) as pool:
            errors = list(pool.map(lambda run: errors_of_run(program, *run, more), runs))
    except RuntimeError as error:
        return refuse(error)
    except OSError as error:
        return refuse(f"{error.filename or folder}: {error.strerror or error}")
    errors = np.array(errors).reshape(len(logs), int(starts), 2)
    kinds = [os.path.basename(log).split("_")[0] for log in logs]
    for kind in dict.fromkeys(kinds):
        print_kind(kind, errors[[one == kind for one in kinds]])
    print_all(errors)
    return 0


def main():
    own = (sys.argv[1:] + ["--"]).index("--")
    arguments, more = sys.argv[1:own + 1], sys.argv[own + 2:]
    if arguments[:1] == ["make"] and len(arguments) == 3 and not more:
        return make(arguments[1:])
    if arguments[:1] == ["score"] and len(arguments) == 4:
        return score(arguments[1:], more)
    print(__doc__, file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main())
