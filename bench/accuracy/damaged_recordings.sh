#!/usr/bin/env bash
# What a recording's faults cost: the rendered living room with ORB-SLAM2's errors, damaged in one way after the
# other and mapped with defaults; a line of F1 of observable walls and mean errors in the plane each
# (docs/results.md, "Recordings damaged on purpose"). Needs awk, jq and ffmpeg.
#   bench/accuracy/damaged_recordings.sh build/release/bin/depthgrid /tmp/damaged
set -euo pipefail
program=$(realpath "$1")
folder=$2
mkdir "$folder"
cd "$folder"

# scored NAME SEQUENCE [ARGUMENT ...]: maps and scores; the truth is in SEQUENCE's original, $base.
scored() {
  local name=$1 sequence=$2
  shift 2
  "$program" map "$sequence" -o "out_$name" "$@" >"$name.log" 2>&1 || { echo "$name: $(tail -1 "$name.log")"; return; }
  "$program" eval trajectory "$base/groundtruth.txt" "out_$name/trajectory_est.txt" --json >"$name.trajectory.json"
  "$program" eval map "$base/truth_map.yaml" "out_$name/map.yaml" --json >"$name.map.json"
  printf '%-28s F1 %.3f mean %.4f aligned (RMSE) %.4f m\n' "$name" "$(jq .map.observable.occupied.f1 "$name.map.json")" \
    "$(jq .trajectory.est.mean_euclidean_m "$name.trajectory.json")" \
    "$(jq .trajectory.est.ate_rmse_se2_m "$name.trajectory.json")"
}

# rendered NAME CAMERA NOISE [ARGUMENT ...] and its SLAM: NAME and NAME_slam.
rendered() {
  local name=$1 camera=$2 noise=$3
  shift 3
  "$program" render living_room --no-colour -o "$name" --set "sensor.camera=$camera" --set "sensor.noise=$noise" "$@" >/dev/null
  "$program" slam "$name" --profile orb_slam2 --seed 3 -o "${name}_slam" >/dev/null
  base=$name
}

# copied NAME: the rendered recording under another name, its images shared.
copied() {
  mkdir "$1"
  cp "$base"/*.txt "$base"/camera.yaml "$1"
  ln -s "../$base/depth" "$1/depth"
}

# tilted AX AY AZ DEGREES: TUM rows in a world turned about an axis.
tilted() {
  awk -v ax="$1" -v ay="$2" -v az="$3" -v deg="$4" '
    BEGIN { n = sqrt(ax * ax + ay * ay + az * az); h = deg * atan2(0, -1) / 360
            s = sin(h) / n; X = ax * s; Y = ay * s; Z = az * s; W = cos(h) }
    { tx = 2 * (Y * $4 - Z * $3); ty = 2 * (Z * $2 - X * $4); tz = 2 * (X * $3 - Y * $2)
      printf("%s %.9f %.9f %.9f %.12f %.12f %.12f %.12f\n", $1,
             $2 + W * tx + Y * tz - Z * ty, $3 + W * ty + Z * tx - X * tz, $4 + W * tz + X * ty - Y * tx,
             W * $5 + X * $8 + Y * $7 - Z * $6, W * $6 - X * $7 + Y * $8 + Z * $5,
             W * $7 + X * $6 - Y * $5 + Z * $8, W * $8 - X * $5 - Y * $6 - Z * $7) }'
}

# from_first: TUM rows in the frame of the first camera.
from_first() {
  awk 'function turned(X, Y, Z, W, x, y, z,   tx, ty, tz) {
      tx = 2 * (Y * z - Z * y); ty = 2 * (Z * x - X * z); tz = 2 * (X * y - Y * x)
      r[1] = x + W * tx + Y * tz - Z * ty; r[2] = y + W * ty + Z * tx - X * tz; r[3] = z + W * tz + X * ty - Y * tx }
    NR == 1 { px = $2; py = $3; pz = $4; X = -$5; Y = -$6; Z = -$7; W = $8 }
    { turned(X, Y, Z, W, $2 - px, $3 - py, $4 - pz)
      printf("%s %.9f %.9f %.9f %.12f %.12f %.12f %.12f\n", $1, r[1], r[2], r[3],
             W * $5 + X * $8 + Y * $7 - Z * $6, W * $6 - X * $7 + Y * $8 + Z * $5,
             W * $7 + X * $6 - Y * $5 + Z * $8, W * $8 - X * $5 - Y * $6 - Z * $7) }'
}

# with_holes NAME: a third of each image's pixels become 65535, others in each image.
with_holes() {
  mkdir -p "$1/depth"
  cp "$base"/*.txt "$base"/camera.yaml "$1"
  awk -v base="$PWD/$base" '!/^#/ { printf("file \047%s/%s\047\nduration 0.1\n", base, $2) }' "$base/depth.txt" >"$1.list"
  ffmpeg -v error -threads 1 -filter_threads 1 -f concat -safe 0 -i "$1.list" -vsync 0 \
    -vf "format=gray16le,geq=lum='if(lt(random(1),0.333),65535,lum(X,Y))'" -start_number 0 "$1/depth/%06d.png"
  awk '/^#/ { print; next } { printf("%s depth/%06d.png\n", $1, n++) }' "$base/depth.txt" >"$1/depth.txt"
}

rendered level icl_nuim handa
slam=level_slam/slam.txt
loops=level_slam/loops.csv
scored undamaged level --poses $slam --loops $loops
tilted 1 0 0 26 <$slam >tilted_x.txt
scored tilted_26_about_x level --poses tilted_x.txt --loops $loops
tilted 1 -2 0 26 <$slam >tilted_xy.txt
scored tilted_26_about_1_-2_0 level --poses tilted_xy.txt --loops $loops
# The axis that was up becomes x, -x, y, -y, -z.
tilted 0 1 0 90 <$slam >up_x.txt
tilted 0 1 0 -90 <$slam >up_-x.txt
tilted 1 0 0 -90 <$slam >up_y.txt
tilted 1 0 0 90 <$slam >up_-y.txt
tilted 1 0 0 180 <$slam >up_-z.txt
for axis in x -x y -y -z; do scored "up_along_$axis" level --poses "up_$axis.txt" --loops $loops; done
from_first <$slam >first.txt
scored first_camera_is_world level --poses first.txt --loops $loops
scored no_loops level --poses $slam

awk '{ $1 = sprintf("%.6f", $1 + 0.05); print }' $slam >late.txt
scored late_50_ms_told level --poses late.txt --set sequence.recording.time_offset_s=0.05
scored late_50_ms_not_told level --poses late.txt
awk 'NR % 3 == 1' level/groundtruth.txt >true_10hz.txt
scored true_10_hz_interpolated level --poses true_10hz.txt --set sequence.recording.interpolate_poses=true
awk 'NR % 3 == 1' $slam >slam_10hz.txt
scored slam_10_hz_interpolated level --poses slam_10hz.txt --loops $loops --set sequence.recording.interpolate_poses=true
awk 'NR % 3 == 1' $slam >slam_10hz_left.txt
scored slam_10_hz_only level --poses slam_10hz_left.txt --loops $loops

# Rows of poses missing (each seventh), doubled (each fifth), NaN (each eleventh); then all reversed.
awk 'NR % 7 == 0 { next } NR % 11 == 0 { print $1, "nan", $3, $4, $5, $6, $7, $8; next } { print } NR % 5 == 0' \
  $slam >rows.txt
scored rows_missing_doubled_nan level --poses rows.txt --loops $loops
sort -t' ' -k1,1gr rows.txt >rows_back.txt
scored same_in_reverse_order level --poses rows_back.txt --loops $loops
# Two seconds without a pose, at five places.
for from in 5 8 12 16 20; do
  awk -v from=$from '$1 < from || $1 > from + 2' $slam >"gap_$from.txt"
  scored "gap_from_${from}_to_$((from + 2))_s" level --poses "gap_$from.txt" --loops $loops
done
# One pose for two seconds, at the same places.
for from in 5 8 12 16 20; do
  awk -v from=$from '$1 < from || $1 > from + 2 { print; pose = $2 " " $3 " " $4 " " $5 " " $6 " " $7 " " $8; next }
    { print $1, pose }' $slam >"held_$from.txt"
  scored "held_from_${from}_to_$((from + 2))_s" level --poses "held_$from.txt" --loops $loops
done
copied cut
awk 'NR % 9 == 0 { print substr($0, 1, 12); next } { print }' level/depth.txt >cut/depth.txt
head -c -20 $slam | awk 'NR % 13 == 0 { print "?", $0; next } { print }' >cut_slam.txt
scored damaged_rows cut --poses cut_slam.txt --loops $loops
mkdir broken
cp level/*.txt level/camera.yaml broken
cp -r level/depth broken
k=0
for image in broken/depth/*.png; do
  k=$((k + 1))
  if [ $((k % 10)) = 0 ]; then truncate -s 3000 "$image"; fi
done
scored every_tenth_image_cut broken --poses $slam --loops $loops

with_holes third
scored third_of_pixels_missing third --poses $slam --loops $loops

rendered kinect kinect_v1 nguyen
scored kinect_v1 kinect --poses kinect_slam/slam.txt --loops kinect_slam/loops.csv
tilted 1 0 0 26 <kinect_slam/slam.txt >kinect_x.txt
scored kinect_v1_tilted_x kinect --poses kinect_x.txt --loops kinect_slam/loops.csv
tilted 1 -2 0 26 <kinect_slam/slam.txt >kinect_xy.txt
scored kinect_v1_tilted_1_-2_0 kinect --poses kinect_xy.txt --loops kinect_slam/loops.csv

rendered tof tof_540x360 kinect_v2
scored time_of_flight tof --poses tof_slam/slam.txt --loops tof_slam/loops.csv
with_holes tof_third
scored tof_third_missing tof_third --poses tof_slam/slam.txt --loops tof_slam/loops.csv
copied tof_half
rm tof_half/depth
ln -s ../tof_third/depth tof_half/depth
awk '/^#/ || NR % 2' tof_third/depth.txt >tof_half/depth.txt
scored tof_third_every_other tof_half --poses tof_slam/slam.txt --loops tof_slam/loops.csv
