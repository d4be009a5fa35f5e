# A ROBOTLASER1 log with the true poses for its odometry, its readings with more noise if asked for: `share` of the
# range is the standard deviation added (docs/results.md, "Finished map"; 1 % in the log and .01732 more are 2 %):
#   awk -v share=0.01732 -f bench/accuracy/true_odometry.awk office.truth.txt office.log >exact.log
function normal() { return sqrt(-2 * log(1 - rand())) * cos(6.283185307 * rand()) }
BEGIN { srand(1) }
NR == FNR { x[FNR] = $2; y[FNR] = $3; yaw[FNR] = 2 * atan2($7, $8); next }
/^ROBOTLASER1/ {
  scan++
  readings = $9
  for (i = 10; share > 0 && i < 10 + readings; i++) {
    if ($i <= 0 || $i >= 6) continue
    range = $i * (1 + share * normal())
    $i = sprintf("%.4f", range < 6 ? range : 5.9999)
  }
  pose = 11 + readings + $(10 + readings)  # the laser's, then the robot's
  for (k = 0; k < 6; k += 3) { $(pose + k) = x[scan]; $(pose + k + 1) = y[scan]; $(pose + k + 2) = yaw[scan] }
  print
}
