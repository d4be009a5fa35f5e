#!/usr/bin/env bash
# docs/examples/sweep_recording.py on a short rendered recording: the table, going on, and slips of its user's.
# usage: run.sh DEPTHGRID SCRIPT FOLDER
set -euo pipefail
python=$(command -v python3) || { echo 'skipped: no python3'; exit 77; }
program=$(readlink -m "$1") script=$(readlink -m "$2")
rm -rf "$3" && mkdir -p "$3" && cd "$3"
failed=0
fail() { echo "FAILED: $*"; cat out err 2>/dev/null || true; failed=1; }
sweep() { "$python" "$script" --program "$program" "$@" >out 2>err; }
# refused WORDS ARGUMENT...: exit code 2 and one line that holds the words.
refused() {
  local words=$1 code=0
  sweep "${@:2}" || code=$?
  [ $code = 2 ] || fail "${*:2}: exit code $code"
  [ "$(wc -l <err)" = 1 ] || fail "${*:2}: not one line"
  grep -qF -- "$words" err || fail "${*:2}: does not say '$words'"
}

cat >room.yaml <<'YAML'
name: room
floor_z_m: 0
shapes:
  - {shape: box, size: [4, 3, 0.1], at: [2, 1.5, -0.1]}
  - {shape: wall, from: [0, 0], to: [4, 0], side: right}
  - {shape: wall, from: [4, 0], to: [4, 3], side: right}
  - {shape: wall, from: [4, 3], to: [0, 3], side: right}
  - {shape: wall, from: [0, 3], to: [0, 0], side: right}
  - {shape: box, size: [0.5, 0.4, 1.2], at: [3.5, 2.6, 0]}
trajectories:
  way: {kind: planar, height_m: 0.6, waypoints: [{at: [1, 1]}, {at: [2, 1.2]}, {at: [2.5, 1.8]}]}
YAML
cat >drive.yaml <<'YAML'
scene: ./room.yaml
frames: 40
sensor: {noise: none, width: 96, height: 72}
YAML
"$program" render ./drive.yaml --no-colour -o seq >out 2>err || fail 'render'

all=(seq -o table --slam orb_slam2 --seeds 2 --axis slam.drift_scale=1,30 --axis mapper.fusion.gain=0,1)
rest=(-- --up z --set mapper.fusion.mode=fixed)
sweep "${all[@]}" -j 2 "${rest[@]}" || fail 'the sweep'
[ "$(grep -c '^ *[0-9.]*  .*(' out)" = 4 ] || fail 'four points in the table that is shown'
[ "$(head -5 out | awk '{print length}' | sort -u | wc -l)" = 1 ] || fail 'its columns are not aligned'
[ "$(wc -l <table/results.csv)" = 9 ] || fail 'eight runs and a line of names'
head -1 table/results.csv | grep -q '^slam.drift_scale,mapper.fusion.gain,slam_seed,.*est.mean_euclidean_m' || fail 'names'
# K = 0 is SLAM's trajectory, so the fifth run (drift 30, K = 0, seed 1) has its very score.
"$program" slam seq --profile orb_slam2 --seed 1 -o slam --set slam.drift_scale=30 >out 2>err
"$program" eval trajectory seq/groundtruth.txt slam/slam_final.txt --json >out
score=$(grep -m1 -o '"mean_euclidean_m": [0-9.e-]*' out)
grep -q "^30,0,1,.*,${score#*: }," table/results.csv || fail "no such score: $score"

# Going on: of two runs one is gone, the other's folder is not touched, and the table is the same.
cp table/results.csv before.csv
rm -r table/run_3 table/results.csv
touch -d 2001-01-01 table/run_2/scores.json
sweep "${all[@]}" "${rest[@]}" || fail 'going on'
cmp -s before.csv table/results.csv || fail 'another table'
[ table/run_2/scores.json -ot before.csv ] || fail 'done again'

refused 'holds another sweep' "${all[@]}" --seeds 3 "${rest[@]}"
refused "must be KEY=VALUE" seq -o none --axis mapper.fusion.gain
refused "did you mean 'mapper.fusion.gain'" seq -o typo --axis mapper.fusion.gian=1
refused 'needs --slam' seq -o none --axis slam.drift_scale=1
refused 'is not empty' seq -o seq --axis mapper.fusion.gain=1
refused 'there is no such file' seq -o none --truth nowhere.txt --axis mapper.fusion.gain=1
[ ! -e none ] || fail 'a folder of nothing'
exit $failed
