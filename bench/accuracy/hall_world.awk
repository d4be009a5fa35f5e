# A hall of 30 x 48 m, too wide for a sensor that reaches 6 m: six racks 16 m long with bare sides, pillars, pallets. A
# way of 80 m through it, along aisles chosen by `way` (1, 2, ...), .7 m/s at 30 Hz, turning on the spot where aisles cross.
# Writes NAME.world.txt and NAME.truth.txt for laser_accuracy (docs/results.md, "Another building"):
#   awk -v name=/tmp/hall1 -v way=1 -f bench/accuracy/laser_world.awk -f bench/accuracy/hall_world.awk
function box(x1, y1, x2, y2) { wall(x1, y1, x2, y1); wall(x2, y1, x2, y2); wall(x2, y2, x1, y2); wall(x1, y2, x1, y1) }
# Turns by the shorter side, 90 degrees a second.
function turn_to(wanted,   off, steps, k, from) {
  off = wanted - yaw
  while (off > pi) off -= 2 * pi
  while (off <= -pi) off += 2 * pi
  steps = int(sqrt(off * off) / (pi / 60) + 0.5); from = yaw
  for (k = 1; k < steps; k++) pose(x, y, from + off * k / steps)
  yaw = from + off
}
function go_to(to_x, to_y,   n, steps, k, from_x, from_y) {
  turn_to(atan2(to_y - y, to_x - x))
  n = sqrt((to_x - x) ^ 2 + (to_y - y) ^ 2); steps = int(n / (0.7 / 30)); from_x = x; from_y = y
  for (k = 0; k < steps; k++) pose(from_x + (to_x - from_x) * k / steps, from_y + (to_y - from_y) * k / steps, yaw)
  x = to_x; y = to_y; gone_m += n
}
BEGIN {
  pi = 2 * atan2(1, 0)
  box(0, 0, 30, 48)
  for (column = 0; column < 3; column++) {
    box(5 + 7 * column, 4, 7 + 7 * column, 20); box(5 + 7 * column, 26, 7 + 7 * column, 42)
  }
  for (row = 0; row < 4; row++) { box(23.5, 5 + 12 * row, 24, 5.5 + 12 * row); box(8.2, 8 + 9 * row, 8.5, 8.3 + 9 * row) }
  for (i = 0; i < 7; i++) { at_x = 26 + 3 * chance(); at_y = 3 + 6 * i + 2 * chance(); box(at_x, at_y, at_x + 0.8, at_y + 1.2) }
  # Aisles cross here.
  split("2.5 10.2 17.5 22.3", across, " "); split("2 23 45", along, " ")
  counter += 1000 * way
  column = 1 + int(4 * chance()); row = 1 + int(3 * chance())
  x = across[column]; y = along[row]; yaw = 0
  for (came_from = -1; gone_m < 80; came_from = (go + 2) % 4) {
    do {
      go = int(4 * chance())
      next_column = column + (go == 0) - (go == 2); next_row = row + (go == 1) - (go == 3)
    } while (go == came_from || next_column < 1 || next_column > 4 || next_row < 1 || next_row > 3)
    if (came_from < 0) yaw = go * pi / 2
    column = next_column; row = next_row
    go_to(across[column], along[row])
  }
}
