#include "mapper/surfel/frame_smoother.h"

#include <algorithm>
#include <utility>

#include "mapper/surfel/group_links.h"

namespace depthgrid {
namespace {

// The problem is nearly linear: guesses are within centimetres.
constexpr int kIterations = 2;
// Where neither match nor motion says anything, a frame stays: far below any real information.
constexpr double kStayInformation = 1e-3;

void AddMatch(const SmootherFrame& frame, const Pose2& map_from_base, int place, SkylineMatrix& h,
              Eigen::VectorXd& g) {
  const Eigen::Vector3d error = Between(map_from_base, frame.match.map_from_base).vector();
  const Eigen::Matrix3d& information = frame.match.information;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column <= row; ++column) {
      *h.At(place + row, place + column) += information(row, column);
    }
  }
  g.segment<3>(place) += information * error;
}

}  // namespace

std::vector<Pose2> Smoothed(const std::vector<SmootherFrame>& frames,
                            const Eigen::Vector3d& motion_sigma) {
  std::vector<Pose2> poses;
  std::vector<int> first;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    poses.push_back(frames[i].map_from_base);
    first.insert(first.end(), 3, std::max(3 * (static_cast<int>(i) - 1), 0));
  }
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    SkylineMatrix h(first);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(h.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const int index = static_cast<int>(i);
      for (int k = 0; k < 3; ++k) *h.At(3 * index + k, 3 * index + k) += kStayInformation;
      if (frames[i].match.found) AddMatch(frames[i], poses[i], 3 * index, h, g);
      if (i == 0 || !frames[i].motion) continue;
      AddLink({index - 1, index, *frames[i].motion, motion_sigma, 0.0}, poses, h, g);
    }
    if (!h.Factor()) return poses;
    const Eigen::VectorXd step = h.Solve(std::move(g));
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Eigen::Vector3d motion = step.segment<3>(3 * static_cast<Eigen::Index>(i));
      poses[i] = poses[i] * Pose2::FromVector(motion);
    }
  }
  return poses;
}

}  // namespace depthgrid
