#include "mapper/graph/part_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace depthgrid {
namespace {

// Half the window and its steps. A step is what SeenPlace widens walls by.
constexpr double kPartStepM = 0.1;
constexpr double kPartStepRad = RadFromDeg(2.0);
constexpr int kPartSteps = 20;
constexpr int kPartTurns = 6;
// Refined down to this step.
constexpr double kLeastStepM = 0.01;
constexpr double kTurnPerM = 0.3;
// Points of each part that are laid over the other one, at most.
constexpr std::size_t kMostLaid = 600;
// Fewest of them that both parts must have seen, and least share that must agree.
constexpr int kFewestCompared = 100;
constexpr double kLaidAgreement = 0.9;
// A point in free space weighs as much as this many on walls: noise hardly puts one there.
constexpr int kContradiction = 4;
// Poses this far off are others. None may score more than this share of the best one's.
constexpr int kElsewhereSteps = 4;
constexpr int kElsewhereTurns = 2;
constexpr double kScoreElsewhere = 0.9;

struct PartOffset {
  int x = 0, y = 0, turn = 0;

  bool IsElsewhere(const PartOffset& other) const {
    const double steps = std::hypot(x - other.x, y - other.y);
    return steps > kElsewhereSteps || std::abs(turn - other.turn) > kElsewhereTurns;
  }
};

struct ScoredOffset {
  PartOffset offset;
  int score = 0;
};

std::vector<Eigen::Vector2d> EvenlyThinned(const std::vector<Eigen::Vector2d>& points) {
  std::vector<Eigen::Vector2d> thin;
  const std::size_t stride = points.size() / kMostLaid + 1;
  for (std::size_t i = 0; i < points.size(); i += stride) thin.push_back(points[i]);
  return thin;
}

class PartSearch {
 public:
  PartSearch(const SeenPlace& first, const SeenPlace& second, const Pose2& around)
      : first_(first),
        second_(second),
        of_first_(EvenlyThinned(first.points)),
        of_second_(EvenlyThinned(second.points)),
        around_(around) {
    for (const Eigen::Vector2d& point : of_second_) {
      middle_ += point / static_cast<double>(of_second_.size());
    }
  }

  std::optional<Pose2> Best() const {
    const std::vector<ScoredOffset> all = All();
    const auto less = [](const ScoredOffset& a, const ScoredOffset& b) {
      return a.score < b.score;
    };
    const ScoredOffset best = *std::max_element(all.begin(), all.end(), less);
    for (const ScoredOffset& other : all) {
      const bool nearly = other.score > kScoreElsewhere * best.score;
      if (nearly && other.offset.IsElsewhere(best.offset)) return std::nullopt;
    }
    const Pose2 pose = Refined(At(best.offset), best.score);
    const Overlap overlap = Laid(pose);
    if (overlap.compared < kFewestCompared || overlap.agreement() < kLaidAgreement)
      return std::nullopt;
    return pose;
  }

 private:
  // `pose` with the second part turned about its middle and moved.
  Pose2 Moved(const Pose2& pose, double x_m, double y_m, double turn_rad) const {
    const double yaw_rad = pose.yaw_rad + turn_rad;
    const Eigen::Vector2d at =
        pose * middle_ + Eigen::Vector2d(x_m, y_m) - Eigen::Rotation2Dd(yaw_rad) * middle_;
    return {at.x(), at.y(), WrapAngle(yaw_rad)};
  }
  Pose2 At(const PartOffset& offset) const {
    return Moved(around_, offset.x * kPartStepM, offset.y * kPartStepM, offset.turn * kPartStepRad);
  }

  Overlap Laid(const Pose2& first_from_second) const {
    const Overlap of_second = PointsIn(first_, of_second_, first_from_second);
    const Overlap of_first = PointsIn(second_, of_first_, Inverse(first_from_second));
    return OverlapEachWay{of_first, of_second}.both();
  }
  int ScoreOf(const Pose2& pose) const {
    const Overlap overlap = Laid(pose);
    return overlap.agreeing - kContradiction * (overlap.compared - overlap.agreeing);
  }

  std::vector<ScoredOffset> All() const {
    std::vector<ScoredOffset> all;
    for (int turn = -kPartTurns; turn <= kPartTurns; ++turn) {
      for (int x = -kPartSteps; x <= kPartSteps; ++x) {
        for (int y = -kPartSteps; y <= kPartSteps; ++y) {
          const PartOffset offset{x, y, turn};
          all.push_back({offset, ScoreOf(At(offset))});
        }
      }
    }
    return all;
  }

  // Steps uphill, ever smaller ones.
  Pose2 Refined(Pose2 pose, int score) const {
    for (double step_m = kPartStepM / 2.0; step_m > kLeastStepM; step_m /= 2.0) {
      const double turn_rad = kTurnPerM * step_m;
      bool higher = true;
      while (higher) {
        higher = false;
        for (const Eigen::Vector3d& step :
             {Eigen::Vector3d(step_m, 0, 0), Eigen::Vector3d(-step_m, 0, 0),
              Eigen::Vector3d(0, step_m, 0), Eigen::Vector3d(0, -step_m, 0),
              Eigen::Vector3d(0, 0, turn_rad), Eigen::Vector3d(0, 0, -turn_rad)}) {
          const Pose2 next = Moved(pose, step.x(), step.y(), step.z());
          const int next_score = ScoreOf(next);
          if (next_score <= score) continue;
          pose = next;
          score = next_score;
          higher = true;
        }
      }
    }
    return pose;
  }

  const SeenPlace& first_;
  const SeenPlace& second_;
  std::vector<Eigen::Vector2d> of_first_, of_second_;  // thinned
  Pose2 around_;
  Eigen::Vector2d middle_ = Eigen::Vector2d::Zero();  // of the second part's points
};

}  // namespace

std::optional<Pose2> SearchPart(const SeenPlace& first, const SeenPlace& second,
                                const Pose2& around) {
  if (first.points.empty() || second.points.empty()) return std::nullopt;
  return PartSearch(first, second, around).Best();
}

}  // namespace depthgrid
