#include "mapper/surfel/loop_jury.h"

#include <algorithm>

namespace depthgrid {
namespace {

// Share of the worst loop's sigmas. Chosen; its benefit is in docs/results.md, "False loops".
constexpr double kAlsoBad = 0.5;

}  // namespace

bool LoopJury::ReviseAccepted(const std::vector<Pose2>& map_from_group) {
  std::vector<double> sigmas;
  for (const GroupLink& loop : loops_) sigmas.push_back(LinkSigmas(loop, map_from_group));
  const std::size_t worst = WorstAccepted(sigmas);
  if (worst == loops_.size()) return TakeBack(sigmas);
  accepted_[worst] = false;
  if (loops_[worst].on_trial) return false;
  const double bad = std::max(max_sigmas_, kAlsoBad * sigmas[worst]);
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    if (sigmas[i] > bad && !loops_[i].on_trial) accepted_[i] = false;
  }
  return true;
}

// Index of the worst accepted loop; loops_.size() if all fit.
std::size_t LoopJury::WorstAccepted(const std::vector<double>& sigmas) const {
  double most = max_sigmas_;
  std::size_t worst = loops_.size();
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    if (!accepted_[i] || sigmas[i] <= most) continue;
    most = sigmas[i];
    worst = i;
  }
  return worst;
}

bool LoopJury::TakeBack(const std::vector<double>& sigmas) {
  bool any = false;
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    if (accepted_[i] || came_back_[i] || sigmas[i] > max_sigmas_) continue;
    accepted_[i] = came_back_[i] = any = true;
  }
  return any;
}

}  // namespace depthgrid
