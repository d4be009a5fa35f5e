# A laser world as a scene, and its truth as the path of a level camera 1 m above the floor, so that `depthgrid
# render` draws the true map and what of it could be seen (docs/results.md, "Walls"):
#   awk -v name=/tmp/office -f bench/accuracy/laser_world_scene.awk office.world.txt office.truth.txt
# writes NAME.yaml and NAME.txt.
FNR == 1 { file_number++ }
/^#/ || NF == 0 { next }
file_number == 1 {
  for (i = 1; i <= 3; i += 2) {
    if (walls + i == 1 || $i > high_x) high_x = $i
    if (walls + i == 1 || $(i + 1) > high_y) high_y = $(i + 1)
    if (walls + i == 1 || $i < low_x) low_x = $i
    if (walls + i == 1 || $(i + 1) < low_y) low_y = $(i + 1)
  }
  wall[walls++] = sprintf("  - {shape: wall, from: [%s, %s], to: [%s, %s], thickness_m: 0.01}", $1, $2, $3, $4)
}
file_number == 2 {
  s = $7; c = $8
  printf("%s %s %s 1 %.12f %.12f %.12f %.12f\n", $1, $2, $3, (-c - s) / 2, (c - s) / 2, (s - c) / 2, (c + s) / 2) > (name ".txt")
}
END {
  scene = name ".yaml"
  printf("floor_z_m: 0\nshapes:\n  - {shape: box, size: [%s, %s, 0.1], at: [%s, %s, -0.1]}\n", high_x - low_x + 1,
         high_y - low_y + 1, (high_x + low_x) / 2, (high_y + low_y) / 2) > scene
  for (i = 0; i < walls; i++) print wall[i] > scene
}
