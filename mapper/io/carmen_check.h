// What may be wrong with a laser log although each of its lines can be read: no-returns that look
// like walls, ranges that are not in metres, headings in degrees, a scanner that is no half circle,
// a header that contradicts itself, a mount of a laser that states its own poses.
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

// Of each doubt at most one warning a log. The scans are given in order of time.
class CarmenCheck {
 public:
  explicit CarmenCheck(const CarmenLogOptions& options)
      : min_range_m_(options.min_range_m),
        knows_fov_(options.fov_deg > 0.0),
        knows_mount_(options.mount.base_from_laser() != Pose2{}) {}
  // As the line states it. Readings from `no_return_m` on are known to be no hit.
  void Add(const CarmenScan& scan, double no_return_m, int line_number);
  std::vector<std::string> Warnings(const std::string& path) const;

 private:
  bool DifferAsHitsDo() const;
  std::optional<std::string> DoubtOfUnits(const std::string& path) const;
  std::optional<std::string> DoubtOfLargest(const std::string& path) const;
  std::optional<std::string> DoubtOfLongest(const std::string& path) const;
  void AddReadings(const CarmenScan& scan, double no_return_m, int line_number);
  void AddPoses(const CarmenScan& scan, int line_number);
  void AddHeading(const CarmenScan& scan, int line_number);
  void AddCount(const CarmenScan& scan, int line_number);
  void AddAngles(const CarmenScan& scan, int line_number);

  double min_range_m_;
  bool knows_fov_;
  bool knows_mount_;

  std::int64_t readings_ = 0;
  std::int64_t largest_count_ = 0;  // readings as large as the largest hit
  double largest_m_ = 0.0;
  int largest_line_ = 0;
  double shortest_m_ = std::numeric_limits<double>::infinity();
  int shortest_line_ = 0;
  double longest_m_ = 0.0;
  double no_return_m_ = 0.0;

  RangeCrowdCheck crowd_;

  // Readings that are no return, by the power of kAlikeRatio they are.
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
  int uncommon_counts_ = 0;  // lines without angles that are no scanner's half circle
  std::size_t first_count_ = 0;
  int first_count_line_ = 0;

  // Lines whose field of view is not that of their readings, and the first of them.
  int contradictions_ = 0;
  int contradiction_line_ = 0;
  double contradiction_fov_rad_ = 0.0;
  double contradiction_step_rad_ = 0.0;
  std::size_t contradiction_count_ = 0;
};

}  // namespace depthgrid
