// The scans of one sequence as one depth sensor and one SLAM system see it: all that a run needs of
// its frames. Runs that differ in the mapper alone share one.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eval/run/synthetic_source.h"
#include "mapper/scan/frame_scans.h"

namespace depthgrid {

struct ScanSet {
  ExperimentOptions options;  // of any of its runs, completed; the mapper's own differ
  std::shared_ptr<const World> world;
  SlamOutput slam;
  std::vector<FrameScans> scans;  // one a frame; null where SLAM is lost
  std::string failure;            // why there are none; empty when there are
};

// A set without its scans.
ScanSet MakeSet(const ExperimentOptions& options, std::shared_ptr<const World> world);

// Names the content of the scans: everything that shapes it, and nothing else.
std::string ContentKey(const ScanSet& set);
// Names the depth images they are made from.
std::string DepthKey(const ScanSet& set);

// How much memory the scans take, about.
std::size_t BytesOf(const ScanSet& set);

// The frames of a set from front to back.
class ScannedSource final : public FrameSource {
 public:
  // The set outlives the source.
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
