"""Worlds, the robot's path through them and people before it, drawn at random, for people_logs.py.

x y are in m, yaw in rad counterclockwise from x. Walls are lines x0 y0 x1 y1; the path has RATE_HZ
poses a second. A world is one of WORLDS by name; chance is a numpy generator.
"""
import sys
from typing import NamedTuple

import numpy as np

sys.dont_write_bytecode = True  # nothing beside the script
from random_buildings import RATE_HZ  # noqa: E402

STEPS_HZ = 0.9  # of a pair of legs


class World(NamedTuple):
    walls: np.ndarray
    path: np.ndarray  # x y yaw of each frame
    half_width: float  # of the room that people have beside the path


class Person(NamedTuple):
    at: np.ndarray  # x y in each frame, nan where absent
    on_legs: bool  # two thin circles in place of one


def box(x0, y0, x1, y1):
    return [(x0, y0, x1, y0), (x1, y0, x1, y1), (x1, y1, x0, y1), (x0, y1, x0, y0)]


def notched_wall(x0, x1, y, chance, every, width, depth):
    """Along x, with recesses away from y = 0 about every so many m."""
    walls, x = [], x0
    while True:
        begin = x + every * (0.5 + chance.random())
        end = begin + width * (0.8 + 0.4 * chance.random())
        if end > x1 - 0.5:
            return walls + [(x, y, x1, y)]
        back = y + depth * (0.7 + 0.6 * chance.random()) * np.sign(y)
        walls += [(x, y, begin, y), (begin, y, begin, back), (begin, back, end, back),
                  (end, back, end, y)]
        x = end


def passage(x0, x1, half, chance, every, width, depth):
    """Two notched walls, closed at both ends."""
    return (notched_wall(x0, x1, half, chance, every, width, depth)
            + notched_wall(x0, x1, -half, chance, every, width, depth)
            + [(x0, -half, x0, half), (x1, -half, x1, half)])


def within_half_turn(angle):
    return (angle + np.pi) % (2 * np.pi) - np.pi


def drive(places, speed, most_turn):
    """The path from place to place, m/s and rad/s."""
    at = np.array(places[0], float)
    ahead = np.array(places[1]) - at
    yaw = np.arctan2(ahead[1], ahead[0])
    path = [(at[0], at[1], yaw)] * 3
    dt = 1 / RATE_HZ
    for place in np.array(places[1:], float):
        while np.hypot(*(place - at)) > 0.15:
            off = within_half_turn(np.arctan2(place[1] - at[1], place[0] - at[0]) - yaw)
            unsteady = 1 + 0.1 * np.sin(len(path) / 40)
            now = speed * max(0, np.cos(off)) ** 2 * unsteady
            yaw += np.clip(2 * off, -most_turn, most_turn) * dt
            at = at + now * dt * np.array([np.cos(yaw), np.sin(yaw)])
            path.append((at[0], at[1], yaw))
    return np.array(path)


def turn_on_the_spot(at, rates_and_seconds):
    path, yaw = [], 0.0
    for rate, seconds in rates_and_seconds:
        for _ in range(int(RATE_HZ * seconds)):
            yaw += rate / RATE_HZ
            path.append((*at, yaw))
    return np.array(path)


def tunnel(chance):
    length, half = chance.uniform(26, 36), chance.uniform(1, 1.5)
    walls = passage(-4, length + 6, half, chance, 9, 1, 0.3)
    places = [(0, 0), (length / 3, 0.2), (2 * length / 3, -0.2), (length, 0)]
    return walls, drive(places, chance.uniform(0.6, 0.8), 0.8), half


def corridor(chance):
    length, half = chance.uniform(16, 22), chance.uniform(0.9, 1.2)
    walls = passage(-1, length + 2, half, chance, 2.2, 0.9, 0.12)
    places = [(0, 0), (length * 0.5, 0.1), (length, 0), (length - 0.5, 0.1), (length * 0.4, 0)]
    return walls, drive(places, chance.uniform(0.55, 0.7), 0.9), half


def two_rooms(chance):
    door, second, height = chance.uniform(4, 5), chance.uniform(4, 5.5), chance.uniform(4, 5)
    end, middle = door + second, height / 2
    walls = [(0, 0, end, 0), (end, 0, end, height), (end, height, 0, height), (0, height, 0, 0),
             (door, 0, door, middle - 0.5), (door, middle + 0.5, door, height),
             *box(0.6, 0, 1.8, 0.7), *box(end - 1.2, height - 0.8, end, height),
             *box(door + 1.8, 0, door + 2.6, 0.45)]
    places = [(1, middle), (door - 1, middle), (end - 1.3, middle), (end - 1.4, 1.2),
              (door + 1, middle), (1.4, middle), (1.6, height - 1.2), (door - 1, middle + 0.2),
              (door + 1.2, middle)]
    return walls, drive(places, 0.5, 0.7), 2.0


def yard(chance):
    walls = box(-8, -7, 9, 7)
    for _ in range(9):
        x, y = chance.uniform([-7, -6], [8, 6])
        if abs(y) >= 1.2 and np.hypot(x, y - 3) >= 1:
            walls += box(x, y, x + chance.uniform(0.2, 1.5), y + chance.uniform(0.2, 1.5))
    places = [(-5, 0), (4, 0.3), (5.5, 2.2), (0, 3), (-4, 2.2), (-4, 0), (3, 0)]
    return walls, drive(places, 0.6, 0.7), 2.0


def hall(_):
    walls = box(-6, -5, 6, 5)
    for x in (-3, 0, 3):
        for y in (-2.2, 2.2):
            walls += box(x - 0.2, y - 0.2, x + 0.2, y + 0.2)
    places = [(-4.5, 0), (4, 0.2), (4.3, 3.6), (-4.3, 3.6), (-4.5, 0.2), (2, -0.2)]
    return walls, drive(places, 0.6, 0.7), 2.0


def turn(chance):
    x, y = chance.uniform(4, 6) / 2, chance.uniform(4, 6) / 2
    walls = [*box(-x, -y, x, y), *box(x - 0.6, -0.4, x, 0.5), *box(-0.7, y - 0.5, 0.6, y),
             *box(-x, -y, -x + 0.5, -y + 1)]
    at = chance.uniform(-0.4, 0.4), chance.uniform(-0.4, 0.4)
    return walls, turn_on_the_spot(at, [(0, 0.2), (0.5, 6), (0.6, 4), (0.4, 7), (-0.5, 6),
                                        (-0.6, 7), (0, 0.5), (0.5, 4)]), 2.0


WORLDS = {"tunnel": tunnel, "corridor": corridor, "tworooms": two_rooms, "yard": yard, "hall": hall,
          "turn": turn}


def draw_world(place, chance):
    walls, path, half_width = WORLDS[place](chance)
    return World(np.array(walls), path, half_width)


# ---- People


def slowly_varying(count, chance, low, high, period_s):
    """A number for each frame, in low to high, drawn anew each period and smooth between."""
    drawn = low + (high - low) * chance.random(int(count / (period_s * RATE_HZ)) + 4)
    time = np.arange(count) / (period_s * RATE_HZ)
    before = time.astype(int)
    share = time - before
    share = share * share * (3 - 2 * share)
    return drawn[before] * (1 - share) + drawn[before + 1] * share


def beside_path(path, travelled, arcs, sides):
    """The places so far along the path (straight on behind its end) and to its left."""
    known = travelled + 1e-9 * np.arange(len(path))  # grows even where the robot stands
    x, y = np.interp(arcs, known, path[:, 0]), np.interp(arcs, known, path[:, 1])
    yaw = np.interp(arcs, known, np.unwrap(path[:, 2]))
    over = np.maximum(0, arcs - travelled[-1])
    return np.stack([x + over * np.cos(yaw) - sides * np.sin(yaw),
                     y + over * np.sin(yaw) + sides * np.cos(yaw)], 1)


def walk_round(path, chance):
    """Before a robot that turns, as it turns."""
    count = len(path)
    away = slowly_varying(count, chance, 0.9, 1.6, 5)
    angle = path[:, 2] + slowly_varying(count, chance, -0.45, 0.45, 4)
    angle += 0.05 * np.sin(np.arange(count) / 5)
    return path[:, :2] + away[:, None] * np.stack([np.cos(angle), np.sin(angle)], 1)


def walk_ahead(path, half_width, chance):
    count = len(path)
    travelled = np.r_[0, np.cumsum(np.hypot(*np.diff(path[:, :2], axis=0).T))]
    side, period_s = (0.7 * half_width, 6) if half_width < 1.9 else (0.8, 5)
    sides = slowly_varying(count, chance, -side, side, period_s)
    arcs = travelled + slowly_varying(count, chance, 0.8, 3.2, 5)
    phase = chance.random() * 6
    sway = 0.03 * np.sin(np.arange(count) * 2 * np.pi * STEPS_HZ / RATE_HZ + phase)
    return beside_path(path, travelled, arcs, sides) + sway[:, None]


def walk_across(path, chance):
    """Four times for six seconds, at most somewhat aslant."""
    count = len(path)
    at = np.full((count, 2), np.nan)
    for _ in range(4):
        middle = chance.integers(0, count)
        frames = np.arange(max(0, middle - 90), min(count, middle + 90))
        ahead, speed = chance.uniform(1, 2.8), chance.uniform(0.8, 1.4) * chance.choice([-1, 1])
        left = (frames - middle) / RATE_HZ * speed
        ahead = ahead + chance.uniform(-0.6, 0.6) * left
        c, s = np.cos(path[middle, 2]), np.sin(path[middle, 2])
        at[frames] = path[middle, :2] + np.stack([c * ahead - s * left, s * ahead + c * left], 1)
    return at


def draw_person(place, world, chance):
    path = world.path
    follows = chance.random() < 0.65
    if place == "turn":
        at = walk_round(path, chance)
    elif follows:
        at = walk_ahead(path, world.half_width, chance)
    else:
        at = walk_across(path, chance)
    there = slowly_varying(len(path), chance, 0, 1, 6) > chance.choice([-1, 0.35])
    at[~there] = np.nan
    at[np.hypot(*(at - path[:, :2]).T) < 0.5] = np.nan
    return Person(at, chance.random() < 0.35)


def circle(centre, radius, corners):
    angles = 2 * np.pi * np.arange(corners + 1) / corners
    points = centre + radius * np.stack([np.cos(angles), np.sin(angles)], 1)
    return np.concatenate([points[:-1], points[1:]], 1)


def outlines(one, frame):
    """Of a person, as walls."""
    at = one.at[frame]
    if not np.isfinite(at[0]):
        return []
    if not one.on_legs:
        return [circle(at, 0.22, 14)]
    moved = one.at[max(1, frame)] - one.at[max(1, frame) - 1]
    length = np.hypot(*moved)
    ahead = moved / length if np.isfinite(length) and length > 1e-4 else np.array([1.0, 0.0])
    left = np.array([-ahead[1], ahead[0]])
    swing = 0.25 * np.sin(2 * np.pi * STEPS_HZ * frame / RATE_HZ)
    leg = 0.12 * left + swing * ahead
    return [circle(at + leg, 0.075, 10), circle(at - leg, 0.075, 10)]
