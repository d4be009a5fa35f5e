# A corridor 2 m wide round a block, twice as long as it is deep, with door recesses on both sides, and a way along
# its middle: one round and 20 m more, .8 m/s at 30 Hz, turning on the spot at the corners. Writes NAME.world.txt
# and NAME.truth.txt for laser_accuracy (docs/results.md, "Another building"):
#   awk -v name=/tmp/ring -v round_m=190 -v recess_every_m=3 -f bench/accuracy/laser_world.awk -f bench/accuracy/corridor_world.awk
# One side, with recesses .9 m wide and .15 m deep to the given side of it (1 left, -1 right).
function side(x1, y1, x2, y2, left,   n, c, s, at, end) {
  n = sqrt((x2 - x1) ^ 2 + (y2 - y1) ^ 2); c = (x2 - x1) / n; s = (y2 - y1) / n
  at = 0
  for (end = recess_every_m * (0.4 + 0.8 * chance()); end + 1.2 < n; end += 0.9 + recess_every_m * (0.4 + 0.8 * chance())) {
    wall(x1 + c * at, y1 + s * at, x1 + c * end, y1 + s * end)
    recess(x1 + c * end, y1 + s * end, c, s, left)
    at = end + 0.9
  }
  wall(x1 + c * at, y1 + s * at, x2, y2)
}
function recess(x, y, c, s, left,   dx, dy, ex, ey) {
  dx = -s * 0.15 * left; dy = c * 0.15 * left; ex = x + c * 0.9; ey = y + s * 0.9
  wall(x, y, x + dx, y + dy); wall(x + dx, y + dy, ex + dx, ey + dy); wall(ex + dx, ey + dy, ex, ey)
}
BEGIN {
  long = round_m / 3; short = round_m / 6; step = 0.8 / 30; quarter = atan2(1, 0)
  # The middle of the corridor runs from (0, 0); the block lies inside.
  side(-1, -1, long + 1, -1, -1); side(long + 1, -1, long + 1, short + 1, -1)
  side(long + 1, short + 1, -1, short + 1, -1); side(-1, short + 1, -1, -1, -1)
  side(1, 1, long - 1, 1, 1); side(long - 1, 1, long - 1, short - 1, 1)
  side(long - 1, short - 1, 1, short - 1, 1); side(1, short - 1, 1, 1, 1)
  x = long / 2; yaw = 0; left_m = long / 2; at_side = 0
  for (way = 0; way < round_m + 20; way += step) {
    pose(x, y, yaw)
    if (left_m < step) {
      for (k = 1; k < 30; k++) pose(x, y, yaw + quarter * k / 30)
      yaw += quarter; at_side++
      left_m = at_side % 2 ? short : long
    }
    x += step * cos(yaw); y += step * sin(yaw); left_m -= step
  }
}
