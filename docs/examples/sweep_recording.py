#!/usr/bin/env python3
"""Maps one recording with every combination of settings and scores each map's trajectory: one table.

    python3 sweep_recording.py SEQ -o OUT --poses slam.txt --axis mapper.fusion.gain=0,0.25,0.5,1 -- --set mapper.fusion.mode=fixed
    python3 sweep_recording.py SEQ -o OUT --slam orb_slam2 --seeds 5 --axis slam.drift_scale=1,10 --axis mapper.scan.beams=160,640
    python3 sweep_recording.py robot.log -o OUT --truth truth.txt --axis mapper.surfel.match.gate_m=0.1,0.2

With --slam the poses are the true ones, disturbed as that system errs (`depthgrid slam`), on the recorded images. What
follows `--` goes to `depthgrid map` as it is. OUT/results.csv has a row for each run; without a truth only the share of
beams that lead through walls of the map is known. Started again with the same arguments it goes on where it was.
Keys are those of `depthgrid map --keys` and, with --slam, slam.NAME of `depthgrid run --keys`.
"""
import argparse
import concurrent.futures
import csv
import itertools
import json
import os
import re
import subprocess
import sys

SCORES = ("mean_euclidean_m", "ate_rmse_se2_m", "heading_rmse_rad")  # of docs/metrics.md


class BadInput(Exception):
    """What is wrong with what the user gave, or what depthgrid said: one line."""


def call(arguments):
    try:
        done = subprocess.run(arguments, capture_output=True, text=True)
    except OSError as error:
        raise BadInput(f"--program {arguments[0]}: {error.strerror}") from None
    if done.returncode:
        said = done.stderr.strip().splitlines() or [f"{' '.join(arguments)}: exit code {done.returncode}"]
        raise BadInput(said[-1].removeprefix("depthgrid: "))
    return done.stdout


def axis_of(text):
    key, equals, values = text.partition("=")
    if not (equals and key and all(values.split(","))):
        raise BadInput(f"--axis {text}: must be KEY=VALUE,VALUE,...")
    return key, values.split(",")


def settings_of(point, of_slam):
    """The --set of a point: those of SLAM, or the others."""
    return [word for key, value in point if key.startswith("slam.") == of_slam for word in ("--set", f"{key}={value}")]


def write(path, text):
    """Whole or not at all."""
    with open(path + ".part", "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(path + ".part", path)


class Sweep:
    def __init__(self, options):
        self.options = options
        self.axes = [axis_of(text) for text in options.axis]
        self.truth = options.truth or os.path.join(options.sequence, "groundtruth.txt")
        if not os.path.exists(self.truth):
            if options.truth:
                raise BadInput(f"--truth {options.truth}: there is no such file")
            self.truth = None
        if not options.slam:
            for key, _ in self.axes:
                if key.startswith("slam."):
                    raise BadInput(f"--axis {key}: needs --slam, which makes the poses")

    def runs(self):
        """Settings and seed of each run."""
        points = itertools.product(*([(key, value) for value in values] for key, values in self.axes))
        seeds = range(1, self.options.seeds + 1) if self.options.slam else [None]
        return [(point, seed) for point in points for seed in seeds]

    def poses(self, folder, point, seed):
        """The arguments that give a run its poses."""
        if not self.options.slam:
            files = [("--poses", self.options.poses), ("--loops", self.options.loops)]
            return [word for option, file in files if file for word in (option, file)]
        made = os.path.join(folder, "slam")
        call([self.options.program, "slam", self.options.sequence, "--profile", self.options.slam, "--seed", str(seed),
              "-o", made, "--force", *settings_of(point, True)])
        return ["--poses", os.path.join(made, "slam.txt"), "--loops", os.path.join(made, "loops.csv")]

    def do(self, index, point, seed):
        folder = os.path.join(self.options.output, f"run_{index}")
        done = os.path.join(folder, "scores.json")
        if os.path.exists(done):
            with open(done, encoding="utf-8") as file:
                return json.load(file)
        os.makedirs(folder, exist_ok=True)
        mapped = os.path.join(folder, "map")
        said = call([self.options.program, "map", self.options.sequence, "-o", mapped, "--force",
                     *self.poses(folder, point, seed), *settings_of(point, False), *self.options.rest])
        through = re.search(r"([\d.]+) % of the beams lead through walls", said)
        scores = {"through_walls_percent": float(through[1]) if through else ""}
        for name in ("online", "est") if self.truth else ():
            file = os.path.join(mapped, f"trajectory_{name}.txt")
            result = json.loads(call([self.options.program, "eval", "trajectory", self.truth, file, "--json"]))
            of_file = next(iter(result["trajectory"].values()))
            scores.update({f"{name}.{score}": of_file[score] for score in SCORES})
        write(done, json.dumps(scores))
        return scores

    def require_same(self):
        """A folder holds one sweep."""
        path = os.path.join(self.options.output, "sweep.json")
        said = {key: value for key, value in vars(self.options).items() if key not in ("output", "jobs", "program")}
        text = json.dumps(said, indent=1, sort_keys=True)
        if os.path.exists(path):
            with open(path, encoding="utf-8") as file:
                if file.read() != text:
                    raise BadInput(f"-o {self.options.output}: holds another sweep, must be an empty or a new folder")
        elif os.path.isdir(self.options.output) and os.listdir(self.options.output):
            raise BadInput(f"-o {self.options.output}: is not empty, must be an empty or a new folder")
        os.makedirs(self.options.output, exist_ok=True)
        write(path, text)

    def all(self):
        runs = self.runs()
        self.require_same()
        rows = [None] * len(runs)
        with concurrent.futures.ThreadPoolExecutor(self.options.jobs) as pool:
            jobs = {pool.submit(self.do, i, *run): i for i, run in enumerate(runs)}
            try:
                for count, job in enumerate(concurrent.futures.as_completed(jobs), 1):
                    point, seed = runs[jobs[job]]
                    rows[jobs[job]] = {**dict(point), **({"slam_seed": seed} if seed else {}), **job.result()}
                    print(f"{count} of {len(runs)} runs", file=sys.stderr)
            except BaseException:
                pool.shutdown(cancel_futures=True)  # what is done stays
                raise
        path = os.path.join(self.options.output, "results.csv")
        with open(path + ".part", "w", newline="", encoding="utf-8") as file:
            table = csv.DictWriter(file, rows[0].keys())
            table.writeheader()
            table.writerows(rows)
        os.replace(path + ".part", path)
        self.show(rows)
        print(f"the table is {path}")

    def show(self, rows):
        """Means over the seeds, in brackets the worst."""
        shown = [name for name in ("online.mean_euclidean_m", "est.mean_euclidean_m", "est.ate_rmse_se2_m") if name in rows[0]]
        shown = shown or ["through_walls_percent"]
        keys = [key for key, _ in self.axes]
        lines = [keys + shown]
        points = {}
        for row in rows:
            points.setdefault(tuple(row[key] for key in keys), []).append(row)
        for point, group in points.items():
            cells = []
            for name in shown:
                values = [row[name] for row in group if isinstance(row[name], (int, float))]
                cells.append(f"{sum(values) / len(values):.4f} ({max(values):.4f})" if values else "-")
            lines.append([*point, *cells])
        widths = [max(len(cell) for cell in column) for column in zip(*lines)]
        for line in lines:
            print("  ".join(cell.rjust(width) for cell, width in zip(line, widths)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sequence", help="TUM RGB-D folder or laser log, as for `depthgrid map`")
    parser.add_argument("-o", dest="output", required=True, help="folder to write")
    parser.add_argument("--axis", action="append", required=True, help="KEY=VALUE,VALUE,... (repeat for more)")
    parser.add_argument("--poses", help="SLAM's live poses")
    parser.add_argument("--loops", help="SLAM's loop closures")
    parser.add_argument("--slam", help="instead of --poses: a profile of `depthgrid slam`")
    parser.add_argument("--seeds", type=int, default=1, help="with --slam: seeds 1 to this")
    parser.add_argument("--truth", help="true trajectory (default: the folder's groundtruth.txt)")
    parser.add_argument("--program", default="depthgrid")
    parser.add_argument("-j", dest="jobs", type=int, default=1, help="runs at a time")
    words = sys.argv[1:]
    at = words.index("--") if "--" in words else len(words)
    options = parser.parse_args(words[:at])
    options.rest = words[at + 1:]
    if options.slam and (options.poses or options.loops):
        raise BadInput("--slam: makes poses and loops, so --poses and --loops cannot be given")
    for name in ("seeds", "jobs"):
        if getattr(options, name) < 1:
            raise BadInput(f"--{name} {getattr(options, name)}: must be at least 1")
    Sweep(options).all()


if __name__ == "__main__":
    try:
        main()
    except BadInput as error:
        print(f"sweep_recording: {error}", file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        sys.exit(130)
