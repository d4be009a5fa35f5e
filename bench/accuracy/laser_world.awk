# What the worlds for laser_accuracy are written with, as NAME.world.txt and NAME.truth.txt. Metres, radians.
function wall(x1, y1, x2, y2) { printf("%.4f %.4f %.4f %.4f\n", x1, y1, x2, y2) > (name ".world.txt") }
# The robot's next pose, 30 a second.
function pose(x, y, yaw) {
  printf("%.6f %.6f %.6f 0 0 0 %.12f %.12f\n", (frame++) / 30, x, y, sin(yaw / 2), cos(yaw / 2)) > (name ".truth.txt")
}
# Numbers in [0, 1) that look like chance and are the same everywhere.
function chance(  v) { counter++; v = counter * 0.6180339887498949 + counter * counter * 0.0137; return v - int(v) }
