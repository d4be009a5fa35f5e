#include "mapper/graph/scan_submap_graph.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// Nodes 0..n-1 are the scans, the submaps follow.
class ScanSubmapGraph {
 public:
  ScanSubmapGraph(const std::vector<MappedFrame>& frames,
                  const std::vector<ScanMeasurement>& measurements, int scans_per_submap,
                  const GraphOptions& options)
      : options_(options), scan_count_(static_cast<int>(frames.size())) {
    for (const MappedFrame& frame : frames) poses_.push_back(frame.map_from_base);
    for (int i = 0; i < scan_count_; i += scans_per_submap) {
      poses_.push_back(frames[static_cast<std::size_t>(i)].map_from_base);
    }
    AddSubmapConstraints(measurements, scans_per_submap);
    AddStepConstraints(frames, measurements);
  }

  PoseGraphSolution Solve(const std::vector<PoseConstraint>& loops) const {
    std::vector<PoseConstraint> all = constraints_;
    all.insert(all.end(), loops.begin(), loops.end());
    return SolvePoseGraph(poses_, all, options_.solver);
  }

 private:
  void AddSubmapConstraints(const std::vector<ScanMeasurement>& measurements,
                            int scans_per_submap) {
    const double share = std::sqrt(static_cast<double>(scans_per_submap));
    const Eigen::Vector3d sigma =
        share *
        Eigen::Vector3d(options_.submap_link_m, options_.submap_link_m, options_.submap_link_rad);
    for (int i = 0; i < scan_count_; ++i) {
      const int newest = i / scans_per_submap;
      for (int back = 0; back < 2 && newest - back >= 0; ++back) {
        const ScanMeasurement& measured = measurements[static_cast<std::size_t>(i)];
        constraints_.push_back(
            {.from = scan_count_ + newest - back,
             .to = i,
             .from_from_to = measured.submap_from_scan[static_cast<std::size_t>(back)],
             .sigma = sigma});
      }
    }
  }

  void AddStepConstraints(const std::vector<MappedFrame>& frames,
                          const std::vector<ScanMeasurement>& measurements) {
    for (int i = 1; i < scan_count_; ++i) {
      const MappedFrame& frame = frames[static_cast<std::size_t>(i)];
      Eigen::Vector3d sigma(options_.scan_step_m, options_.scan_step_m, options_.scan_step_rad);
      if (!frame.slam_motion && !frame.match.found) {
        const double gap_s = frame.stamp_s - frames[static_cast<std::size_t>(i - 1)].stamp_s;
        sigma += std::max(gap_s, 0.0) * Eigen::Vector3d(options_.epoch_speed_m_per_s,
                                                        options_.epoch_speed_m_per_s,
                                                        options_.epoch_speed_rad_per_s);
      }
      constraints_.push_back(
          {.from = i - 1,
           .to = i,
           .from_from_to = measurements[static_cast<std::size_t>(i)].previous_from_scan,
           .sigma = sigma});
    }
  }

  GraphOptions options_;
  int scan_count_;
  std::vector<Pose2> poses_;
  std::vector<PoseConstraint> constraints_;
};

PoseConstraint AsConstraint(const PlanarLoop& loop) {
  return {.from = loop.first,
          .to = loop.second,
          .from_from_to = loop.first_from_second,
          .sigma = {loop.sigma_translation_m, loop.sigma_translation_m, loop.sigma_yaw_rad},
          .robust = true};
}

}  // namespace

void GraphOptions::Visit(OptionsVisitor& v) {
  v.Group("solver", solver, "Ceres");
  v.Number("submap_link_m", submap_link_m, {1e-4, 10.0}, "sigma between neighbouring submaps");
  v.Number("submap_link_rad", submap_link_rad, {1e-4, 3.0}, "sigma between neighbouring submaps");
  v.Number("scan_step_m", scan_step_m, {1e-5, 1.0}, "sigma from one scan to the next");
  v.Number("scan_step_rad", scan_step_rad, {1e-5, 1.0}, "sigma from one scan to the next");
  v.Number("epoch_speed_m_per_s", epoch_speed_m_per_s, {0.0, 100.0},
           "sigma per second where neither SLAM nor a match tells the motion");
  v.Number("epoch_speed_rad_per_s", epoch_speed_rad_per_s, {0.0, 100.0},
           "sigma per second where neither SLAM nor a match tells the motion");
  v.Number("max_loop_residual_sigmas", max_loop_residual_sigmas, {0.1, 1e6},
           "loops farther than this from the optimised poses are taken out");
}

ScanMeasurement MeasurementOf(const std::vector<Pose2>& map_from_base, int scan,
                              int scans_per_submap) {
  const auto pose = [&](int i) { return map_from_base[static_cast<std::size_t>(i)]; };
  ScanMeasurement measurement;
  if (scan > 0) measurement.previous_from_scan = Between(pose(scan - 1), pose(scan));
  const int newest = scan / scans_per_submap;
  for (int back = 0; back < 2 && newest - back >= 0; ++back) {
    measurement.submap_from_scan[static_cast<std::size_t>(back)] =
        Between(pose((newest - back) * scans_per_submap), pose(scan));
  }
  return measurement;
}

Adjustment AdjustScansAndSubmaps(const std::vector<MappedFrame>& frames,
                                 const std::vector<ScanMeasurement>& measurements,
                                 const std::vector<PlanarLoop>& loops, int scans_per_submap,
                                 const GraphOptions& options) {
  Require(measurements.size() == frames.size(), "every frame has a measurement");
  Adjustment adjustment;
  adjustment.map_from_base = PosesOf(frames);
  adjustment.loop_accepted.assign(loops.size(), true);
  if (loops.empty()) return adjustment;
  const ScanSubmapGraph graph(frames, measurements, scans_per_submap, options);
  const double max_chi2 = options.max_loop_residual_sigmas * options.max_loop_residual_sigmas;
  while (true) {
    std::vector<PoseConstraint> accepted;
    for (std::size_t i = 0; i < loops.size(); ++i) {
      if (adjustment.loop_accepted[i]) accepted.push_back(AsConstraint(loops[i]));
    }
    const PoseGraphSolution solution = graph.Solve(accepted);
    double worst = 0.0;
    for (const PoseConstraint& loop : accepted) {
      worst = std::max(worst, ConstraintChi2(solution.poses, loop));
    }
    if (worst <= max_chi2) {
      std::copy_n(solution.poses.begin(), frames.size(), adjustment.map_from_base.begin());
      return adjustment;
    }
    // Rejects the worst ones together, so that many false loops do not need as many rounds.
    for (std::size_t i = 0; i < loops.size(); ++i) {
      const double chi2 = ConstraintChi2(solution.poses, AsConstraint(loops[i]));
      if (chi2 > max_chi2 && chi2 >= 0.5 * worst) adjustment.loop_accepted[i] = false;
    }
  }
}

}  // namespace depthgrid
