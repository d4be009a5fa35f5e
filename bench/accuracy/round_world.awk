# A round room of 5 m radius with a cupboard and two pillars, and two rounds of 13 m in it, .5 m/s at 30 Hz: for seconds
# nothing but the round wall is in view, which tells no heading. Writes NAME.world.txt and NAME.truth.txt for
# laser_accuracy (docs/results.md, "Another building"):
#   awk -v name=round -f bench/accuracy/laser_world.awk -f bench/accuracy/round_world.awk
function box(x, y, w, h) { wall(x, y, x + w, y); wall(x + w, y, x + w, y + h); wall(x + w, y + h, x, y + h); wall(x, y + h, x, y) }
BEGIN {
  pi = 2 * atan2(1, 0)
  for (i = 0; i < 120; i++) {
    a = i * pi / 60; b = a + pi / 60
    wall(5 * cos(a), 5 * sin(a), 5 * cos(b), 5 * sin(b))
  }
  box(3, 1, 1, 0.6); box(-2.5, 3, 0.3, 0.3); box(-3.2, -1.5, 0.3, 0.3)
  for (k = 0; k < 1560; k++) {
    round_rad = k / 30 * 0.5 / 2.07
    pose(2.07 * cos(round_rad), 2.07 * sin(round_rad), round_rad + pi / 2)
  }
}
