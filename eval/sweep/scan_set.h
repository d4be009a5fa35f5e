// The scans of one sequence, for one depth sensor and one SLAM system: all that a run needs of its
// frames. Runs that differ only in the mapper share one set.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eval/run/synthetic_source.h"
#include "mapper/scan/frame_scans.h"

namespace depthgrid {

struct ScanSet {
  ExperimentOptions options;  // of any of its runs, completed; the runs' mapper options differ
  std::shared_ptr<const World> world;
  SlamOutput slam;
  std::vector<FrameScans> scans;  // one per frame; null where SLAM is lost
  std::string failure;            // why there are no scans; else empty
};

// A set without its scans.
ScanSet MakeSet(const ExperimentOptions& options, std::shared_ptr<const World> world);

// Key of the scans' content: everything that affects it, and nothing else.
std::string ContentKey(const ScanSet& set);
// Key of the depth images that the scans are made from.
std::string DepthKey(const ScanSet& set);

// Approximate memory that the scans take.
std::size_t BytesOf(const ScanSet& set);

// Returns the frames of a set in order.
class ScannedSource final : public FrameSource {
 public:
  // The set must outlive the source.
  explicit ScannedSource(const ScanSet& set) : set_(set) {}

  std::optional<Frame> Next() override;
  std::optional<PinholeCamera> Camera() const override { return set_.world->camera; }
  int FrameCount() const override { return static_cast<int>(set_.slam.live.size()); }
  std::vector<std::string> Warnings() const override { return {}; }

 private:
  const ScanSet& set_;
  int next_ = 0;
  SlamPlayback playback_;
};

}  // namespace depthgrid
