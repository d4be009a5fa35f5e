# Poses of a robot's base become poses of its camera, or back: TUM rows (stamp tx ty tz qx qy qz qw)
# in and out. The base has x forward, y left, z up; the camera stands at (x, y, z) m in it, looks
# `yaw` degrees to the left of forward and `pitch` degrees down.
#
#   awk -v x=0.3 -v z=0.9 -v pitch=15 -f base_poses.awk odometry.txt >camera.txt
#   depthgrid map RECORDING --poses camera.txt -o OUT
#   awk -v x=0.3 -v z=0.9 -v pitch=15 -v back=1 -f base_poses.awk OUT/trajectory_est.txt >base.txt

function times(a, b, out) {  # quaternions x y z w
  out[1] = a[4] * b[1] + a[1] * b[4] + a[2] * b[3] - a[3] * b[2]
  out[2] = a[4] * b[2] - a[1] * b[3] + a[2] * b[4] + a[3] * b[1]
  out[3] = a[4] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[4]
  out[4] = a[4] * b[4] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3]
}
BEGIN {
  CONVFMT = OFMT = "%.17g"
  rad = atan2(0, -1) / 180
  left[3] = sin(yaw * rad / 2); left[4] = cos(yaw * rad / 2)
  down[2] = sin(pitch * rad / 2); down[4] = cos(pitch * rad / 2)
  split("-.5 .5 -.5 .5", optical)  # z forward, x right, y down
  times(left, down, turned)
  times(turned, optical, mount)
  if (back) for (i = 1; i <= 3; i++) mount[i] = -mount[i]
}
/^#/ || NF < 8 { next }
{
  for (i = 1; i <= 4; i++) q[i] = $(i + 4)
  times(q, mount, turned)
  for (i = 1; i <= 4; i++) base[i] = back ? turned[i] : q[i]
  arm[1] = x; arm[2] = y; arm[3] = z; arm[4] = 0
  for (i = 1; i <= 3; i++) inverse[i] = -base[i]
  inverse[4] = base[4]
  times(base, arm, half)
  times(half, inverse, offset)
  sign = back ? -1 : 1
  printf "%s %.9f %.9f %.9f %.9f %.9f %.9f %.9f\n", $1, $2 + sign * offset[1], $3 + sign * offset[2],
    $4 + sign * offset[3], turned[1], turned[2], turned[3], turned[4]
}
