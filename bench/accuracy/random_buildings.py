#!/usr/bin/python3
"""Buildings, ways and sensors drawn at random, and how far laser_accuracy is off in them (python3-numpy).

    random_buildings.py LASER_ACCURACY FOLDER FIRST COUNT [--hard] [-- ARGUMENT ...]

Building i is a rectangle of 5 to 45 m that walls with doors cut into rooms, with or without furniture and pillars, in any
direction, and a way between random places in it, 30, 60 or 100 s long. Of each, two seeds are run with a view, noise,
drift, reach and number of beams that are drawn as well (--hard: narrow views, short reach, much drift). FOLDER keeps the
worlds (wI.world.txt, wI.truth.txt) and lines of results; the arguments behind -- go to laser_accuracy. The same number
gives the same building and settings. docs/results.md, "Random buildings".
"""
import contextlib
import heapq
import math
import os
import random
import re
import subprocess
import sys
from collections import deque

import numpy as np

CELL_M = 0.1  # of the grid that ways are looked for in
RATE_HZ = 30


class Building:
    """Walls as lines from point to point, and where there is room to go."""

    def __init__(self, number):
        self.chance = np.random.default_rng(number)
        chance = self.chance
        self.width, self.height = [(chance.uniform(5, 9), chance.uniform(4, 8)),
                                   (chance.uniform(10, 20), chance.uniform(8, 16)),
                                   (chance.uniform(20, 45), chance.uniform(15, 30))][number % 3]
        self.thickness = chance.choice([0, 0.1, 0.2])
        self.least_room = chance.choice([2.2, 3.0, 4.5])
        self.walls = []
        self.add_polygon([(0, 0), (self.width, 0), (self.width, self.height), (0, self.height)])
        self.divide(0, 0, self.width, self.height, 0)
        self.furnish(int(self.width * self.height * chance.choice([0, 0.03, 0.1, 0.2])))
        self.turned_rad = chance.choice([0, chance.uniform(0, math.pi / 2)])

    def add_polygon(self, corners):
        for a, b in zip(corners, corners[1:] + corners[:1]):
            self.walls.append((*a, *b))

    def divide(self, x0, y0, x1, y1, depth):
        """A wall with one or two doors across, and again on either side of it."""
        chance, least = self.chance, self.least_room
        width, height = x1 - x0, y1 - y0
        if depth > 6 or (width < 2 * least and height < 2 * least):
            return
        if (chance.random() < 0.12 and depth > 1) or width * height < 12:
            return
        upright = width > height if chance.random() < 0.85 else width <= height
        if (width if upright else height) < 2 * least:
            return
        share = chance.uniform(0.35, 0.65)
        length = height if upright else width
        door = chance.uniform(0.85, 1.6)
        if length < 1.25 + door:
            return
        count = 1 if length < 6 or chance.random() < 0.5 else 2
        doors = sorted(chance.uniform(0.6 + door / 2, length - 0.6 - door / 2) for _ in range(count))
        at, half = (x0 + width * share if upright else y0 + height * share), self.thickness / 2
        begin = 0
        for end, next_begin in [(d - door / 2, d + door / 2) for d in doors] + [(length, length)]:
            if end - begin >= 0.05:
                self.add_wall(upright, at, half, (y0 if upright else x0) + begin, (y0 if upright else x0) + end)
            begin = max(begin, next_begin)
        if upright:
            self.divide(x0, y0, at - half, y1, depth + 1)
            self.divide(at + half, y0, x1, y1, depth + 1)
        else:
            self.divide(x0, y0, x1, at - half, depth + 1)
            self.divide(x0, at + half, x1, y1, depth + 1)

    def add_wall(self, upright, at, half, begin, end):
        if half == 0:
            self.walls.append((at, begin, at, end) if upright else (begin, at, end, at))
        elif upright:
            self.add_polygon([(at - half, begin), (at + half, begin), (at + half, end), (at - half, end)])
        else:
            self.add_polygon([(begin, at - half), (end, at - half), (end, at + half), (begin, at + half)])

    def furnish(self, count):
        chance = self.chance
        for _ in range(count):
            x, y = chance.uniform(0, self.width), chance.uniform(0, self.height)
            angle = chance.choice([0, 0, 0, chance.uniform(0, math.pi)])
            if chance.random() < 0.15:
                radius = chance.uniform(0.08, 0.3)
                self.add_polygon([(x + radius * math.cos(k * math.pi / 8), y + radius * math.sin(k * math.pi / 8))
                                  for k in range(16)])
                continue
            w, h = chance.uniform(0.2, 1.6) / 2, chance.uniform(0.2, 0.8) / 2
            c, s = math.cos(angle), math.sin(angle)
            self.add_polygon([(x + c * u - s * v, y + s * u + c * v) for u, v in [(-w, -h), (w, -h), (w, h), (-w, h)]])

    def distances(self):
        """From each cell to the nearest wall."""
        x, y = np.meshgrid(np.arange(int(self.width / CELL_M) + 1) * CELL_M,
                           np.arange(int(self.height / CELL_M) + 1) * CELL_M, indexing="ij")
        nearest = np.full(x.shape, 9.0)
        for x1, y1, x2, y2 in self.walls:
            dx, dy = x2 - x1, y2 - y1
            along = np.clip(((x - x1) * dx + (y - y1) * dy) / (dx * dx + dy * dy + 1e-12), 0, 1)
            nearest = np.minimum(nearest, np.hypot(x - x1 - along * dx, y - y1 - along * dy))
        return nearest


def largest_region(free):
    label, best, count = np.zeros(free.shape, int), (0, 0), 0
    for start in zip(*np.nonzero(free)):
        if label[start]:
            continue
        count += 1
        queue, size = deque([start]), 0
        label[start] = count
        while queue:
            i, j = queue.popleft()
            size += 1
            for cell in ((i + 1, j), (i - 1, j), (i, j + 1), (i, j - 1)):
                if 0 <= cell[0] < free.shape[0] and 0 <= cell[1] < free.shape[1] and free[cell] and not label[cell]:
                    label[cell] = count
                    queue.append(cell)
        best = max(best, (size, count), key=lambda one: one[0])
    return label == best[1] if best[0] else free


def cheapest(region, cost, start, goal):
    """The cells from start to goal (Dijkstra)."""
    least, before, queue = {start: 0}, {}, [(0, start)]
    while queue:
        far, cell = heapq.heappop(queue)
        if cell == goal:
            break
        if far > least[cell]:
            continue
        for di, dj in [(di, dj) for di in (-1, 0, 1) for dj in (-1, 0, 1) if di or dj]:
            to = (cell[0] + di, cell[1] + dj)
            if not (0 <= to[0] < region.shape[0] and 0 <= to[1] < region.shape[1]) or not region[to]:
                continue
            further = far + math.hypot(di, dj) * cost[to]
            if further < least.get(to, math.inf):
                least[to], before[to] = further, cell
                heapq.heappush(queue, (further, to))
    cells = [goal]
    while cells[-1] != start:
        cells.append(before[cells[-1]])
    return cells[::-1]


def smooth(points):
    """Chaikin's corner cutting."""
    for _ in range(3):
        if len(points) > 2:
            cut = np.column_stack([points[:-1] * 0.75 + points[1:] * 0.25, points[:-1] * 0.25 + points[1:] * 0.75])
            points = np.vstack([points[:1], cut.reshape(-1, 2), points[-1:]])
    return points


def way_through(building):
    """Poses x y yaw, RATE_HZ a second, looking ahead; None where there is no room."""
    chance, distances = building.chance, building.distances()
    region = largest_region(distances > chance.uniform(0.3, 0.42))
    cells = np.argwhere(region)
    if len(cells) < 100:
        return None
    cost = 1 + 0.3 / np.maximum(distances - 0.25, 0.05)
    frames = int(chance.choice([900, 1800, 3000]))
    here, parts, length = tuple(cells[chance.integers(len(cells))]), [], 0
    while length < frames / RATE_HZ * 0.75:
        goal = tuple(cells[chance.integers(len(cells))])
        if goal == here:
            continue
        on_way = cheapest(region, cost, here, goal)
        points = np.array(on_way) * CELL_M
        points = smooth(np.vstack([points[::4] if len(points) > 8 else points, np.array(on_way[-1]) * CELL_M]))
        length += np.hypot(*np.diff(points, axis=0).T).sum()
        parts.append(points)
        here = goal
    points = np.vstack(parts)
    points = points[np.r_[True, np.hypot(*np.diff(points, axis=0).T) > 1e-6]]
    along = np.r_[0, np.cumsum(np.hypot(*np.diff(points, axis=0).T))]
    speed, most_turn = chance.uniform(0.4, 0.8) / RATE_HZ, math.radians(chance.uniform(40, 90)) / RATE_HZ

    def at(way):
        return np.array([np.interp(way, along, points[:, 0]), np.interp(way, along, points[:, 1])])

    first = points[1] - points[0]
    yaw, way, poses = math.atan2(first[1], first[0]), 0, []
    while len(poses) < frames and way < along[-1] - 0.05:
        poses.append((*at(way), yaw))
        ahead = at(min(way + 0.15, along[-1])) - at(way)
        off = (math.atan2(ahead[1], ahead[0]) - yaw + math.pi) % (2 * math.pi) - math.pi
        yaw += np.clip(off, -most_turn, most_turn)
        way += speed * max(0.0, math.cos(min(abs(off) * 1.5, math.pi / 2)))
    return poses


@contextlib.contextmanager
def written(path):
    """A file that is there when it is whole: two runs may share a folder."""
    with open(f"{path}.{os.getpid()}", "w", encoding="ascii") as file:
        yield file
    os.replace(file.name, path)


def write_world(number, name):
    building = Building(number)
    poses = way_through(building)
    if poses is None:
        return False
    c, s, turned = math.cos(building.turned_rad), math.sin(building.turned_rad), building.turned_rad
    with written(name + ".world.txt") as file:
        for x1, y1, x2, y2 in building.walls:
            file.write("%.5f %.5f %.5f %.5f\n" % (c * x1 - s * y1, s * x1 + c * y1, c * x2 - s * y2, s * x2 + c * y2))
    with written(name + ".truth.txt") as file:
        for k, (x, y, yaw) in enumerate(poses):
            file.write("%.6f %.6f %.6f 0 0 0 %.12f %.12f\n" % (
                k / RATE_HZ, c * x - s * y, s * x + c * y, math.sin((yaw + turned) / 2), math.cos((yaw + turned) / 2)))
    return True


def settings_of(number, hard):
    chance = random.Random(number * 1000 + 1)
    drawn = [("fov", [45, 58, 70] if hard else [45, 58, 70, 90, 120, 180, 270]),
             ("noise", [0.01, 0.02, 0.03] if hard else [0.005, 0.01, 0.02, 0.03]),
             ("drift", [0.375, 1.0, 1.875] if hard else [0.0375, 0.1, 0.375, 1.0, 1.875]),
             ("max-range", [4, 6] if hard else [4, 6, 6, 10, 25]), ("beams", [180, 360, 640])]
    return {name: chance.choice(values) for name, values in drawn}


def refuse(what):
    print(f"{os.path.basename(sys.argv[0])}: {what}", file=sys.stderr)
    return 2


def read_command(usage, target, *flags):
    """PROGRAM FOLDER FIRST COUNT [FLAG] [-- ARGUMENT ...]: (program, folder, the numbers, the flag that was given or None,
    the arguments); None where it was refused. FOLDER is made."""
    own = (sys.argv[1:] + ["--"]).index("--")
    arguments, more = sys.argv[1:own + 1], sys.argv[own + 2:]
    given = [a for a in arguments if a in flags]
    arguments = [a for a in arguments if a not in flags]
    if len(arguments) != 4 or len(given) > 1:
        print(usage, file=sys.stderr)
        return None
    program, folder, *numbers = arguments
    if not os.access(program, os.X_OK):
        refuse(f"{program}: is no program (./dev build {target})")
        return None
    if not all(number.isdecimal() for number in numbers):
        refuse(f"FIRST COUNT: are '{' '.join(numbers)}', must be whole numbers")
        return None
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        refuse(f"{folder}: {error.strerror}")
        return None
    first, count = int(numbers[0]), int(numbers[1])
    return os.path.abspath(program), folder, range(first, first + count), given[0] if given else None, more


def main():
    command = read_command(__doc__, "laser_accuracy", "--hard")
    if command is None:
        return 2
    program, folder, numbers, hard, more = command
    online, final, priors = [], [], []
    for number in numbers:
        name = f"{folder}/w{number}"
        if not os.path.exists(name + ".truth.txt") and not write_world(number, name):
            continue
        settings = settings_of(number, hard is not None)
        options = [text for key, value in settings.items() for text in (f"--{key}", str(value))]
        done = subprocess.run([program, "--worlds", f"w{number}", "--seeds", "2", "--threads", "1", *options, *more],
                              cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            return refuse(done.stderr.strip())
        of_seed = (r"seed +(\d+) prior ([\d.]+)/\S+ online ([\d.]+)/\S+ max \S+ final ([\d.]+)/([\d.]+) .*"
                   r"through walls ([\d.]+)")
        for seed, prior, on, at_end, ate, through in re.findall(of_seed, done.stdout):
            print(f"w{number}", *options, f"seed {seed} prior {prior} online {on} final {at_end} ate {ate} beams through "
                  f"walls {through}", flush=True)
            priors.append(float(prior))
            online.append(float(on))
            final.append(float(at_end))
    if not priors:
        return refuse("no building has room for a way")
    off = np.array([priors, online, final])
    print(f"{len(priors)} runs, mean of prior {off[0].mean():.4f} online {off[1].mean():.4f} final {off[2].mean():.4f}; "
          f"median {np.median(off[0]):.4f} {np.median(off[1]):.4f} {np.median(off[2]):.4f}; worse than the prior by more "
          f"than 1 cm: online {int((off[1] > off[0] + 0.01).sum())}, final {int((off[2] > off[0] + 0.01).sum())}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
