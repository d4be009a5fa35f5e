// Checks a laser log for faults that no single line shows: no-returns that look like walls, ranges
// not in metres, headings in degrees, a field of view other than a half circle, a contradictory
// header, a mount given for a log that states the laser's poses.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mapper/io/carmen_line.h"
#include "mapper/io/carmen_log.h"
#include "mapper/io/range_crowd.h"

namespace depthgrid {

// Gives at most one warning of each kind per log. Scans are added in order of time.
class CarmenCheck {
 public:
  explicit CarmenCheck(const CarmenLogOptions& options)
      : min_range_m_(options.min_range_m),
        knows_fov_(options.fov_deg > 0.0),
        knows_mount_(options.mount.base_from_laser() != Pose2{}) {}
  // Adds a scan as written in its line. Readings of at least `no_return_m` are known to be no hit.
  void Add(const CarmenScan& scan, double no_return_m, int line_number);
  std::vector<std::string> Warnings(const std::string& path) const;

 private:
  bool DifferAsHitsDo() const;
  std::optional<std::string> DoubtOfUnits(const std::string& path) const;
  std::optional<std::string> DoubtOfLargest(const std::string& path) const;
  std::optional<std::string> DoubtOfLongest(const std::string& path) const;
  std::optional<std::string> DoubtOfHeadings(const std::string& path) const;
  std::optional<std::string> DoubtOfStamps(const std::string& path) const;
  std::optional<std::string> DoubtOfFov() const;
  std::optional<std::string> DoubtOfStatedMount(const std::string& path) const;
  std::optional<std::string> DoubtOfCount(const std::string& path) const;
  std::optional<std::string> DoubtOfAngles(const std::string& path) const;
  void AddReadings(const CarmenScan& scan, double no_return_m, int line_number);
  void AddHit(double range_m, int line_number);
  void AddPoses(const CarmenScan& scan, int line_number);
  void AddHeading(const CarmenScan& scan, int line_number);
  void AddCount(const CarmenScan& scan, int line_number);
  void AddAngles(const CarmenScan& scan, int line_number);

  double min_range_m_;
  bool knows_fov_;
  bool knows_mount_;

  std::int64_t readings_ = 0;
  // The hits that equal the largest one, by their range.
  struct Repeated {
    std::int64_t count = 0;
    int first_line = 0;
  };
  std::map<double, Repeated> largest_;
  double shortest_m_ = std::numeric_limits<double>::infinity();
  int shortest_line_ = 0;
  double longest_m_ = 0.0;
  double no_return_m_ = 0.0;

  RangeCrowdCheck crowd_;

  // Number of no-return readings in bins of log(range) to base kAlikeRatio.
  std::map<int, std::int64_t> beyond_;
  int beyond_line_ = 0;
  double beyond_m_ = 0.0;  // where the first began

  struct Heading {
    double yaw_rad = 0.0;
    double stamp_s = 0.0;
    int line_number = 0;
  };
  std::optional<Heading> last_heading_;
  int second_line_ = 0;
  std::vector<double> steps_s_;
  std::optional<Heading> beyond_a_turn_;  // the first
  int steps_ = 0;
  int impossible_steps_ = 0;

  int stated_mounts_ = 0;  // lines whose two poses differ, and the first of them
  int stated_mount_line_ = 0;
  Pose2 stated_mount_;

  bool any_states_angles_ = false;
  bool any_takes_fov_ = false;
  int uncommon_counts_ = 0;  // lines without angles whose count fits no half-circle scanner
  std::size_t first_count_ = 0;
  int first_count_line_ = 0;

  // Lines whose stated field of view contradicts their readings, and the first of them.
  int contradictions_ = 0;
  int contradiction_line_ = 0;
  double contradiction_fov_rad_ = 0.0;
  double contradiction_step_rad_ = 0.0;
  std::size_t contradiction_count_ = 0;
};

}  // namespace depthgrid
