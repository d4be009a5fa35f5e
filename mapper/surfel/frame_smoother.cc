#include "mapper/surfel/frame_smoother.h"

#include <algorithm>
#include <utility>

#include "mapper/fuse/fusion.h"
#include "mapper/surfel/skyline_matrix.h"

namespace depthgrid {
namespace {

// The problem is nearly linear: guesses are within centimetres.
constexpr int kIterations = 2;
// Unknowns of a frame: small motion of SLAM's pose in the map (forward, left, yaw), its bias.
constexpr int kUnknowns = 6;
// Holds frames without match and motion in place; far below any real information.
constexpr double kStayInformation = 1e-3;
// Standard deviation of yaw per metre of `stay_m`, rad.
constexpr double kStayTurn = 0.1;
// Least noise of SLAM per frame; keeps weights finite for perfect SLAM.
const Eigen::Vector3d kLeastWalk(1e-5, 1e-5, 2e-6);
const Eigen::Vector3d kLeastBias(1e-6, 1e-6, 2e-7);

struct State {
  std::vector<Pose2> map_from_base;  // SLAM's poses, jitter included, in the map
  std::vector<Eigen::Vector3d> bias;
};

Eigen::Vector3d Inverted(const Eigen::Vector3d& sigma) {
  return sigma.cwiseProduct(sigma).cwiseInverse();
}

class Equations {
 public:
  explicit Equations(std::size_t frames)
      : h_(Envelope(frames)), g_(Eigen::VectorXd::Zero(h_.size())) {}

  void AddMatch(int frame, const Pose2& map_from_base, const MatchResult& match,
                const Eigen::Matrix3d& information) {
    AddBlock(kUnknowns * frame, information);
    g_.segment<3>(kUnknowns * frame) +=
        information * InnovationOf(map_from_base, match.map_from_base);
  }

  void AddStay(int frame, const Pose2& map_from_base, const Pose2& stay,
               const Eigen::Vector3d& weight) {
    AddBlock(kUnknowns * frame, weight.asDiagonal());
    g_.segment<3>(kUnknowns * frame) += weight.cwiseProduct(InnovationOf(map_from_base, stay));
  }

  // error = relative pose against motion * bias; weight is diagonal. Where SLAM stands, its motion
  // has no bias.
  void AddMotion(int frame, const State& state, const Pose2& motion, bool stands,
                 const Eigen::Vector3d& weight) {
    const auto k = static_cast<std::size_t>(frame);
    const Pose2 relative = Between(state.map_from_base[k - 1], state.map_from_base[k]);
    Eigen::Vector3d error = InnovationOf(motion, relative);
    if (!stands) error -= state.bias[k];
    const Eigen::Matrix3d by_before = -AdjointOf(Inverse(relative));
    const int before = kUnknowns * (frame - 1);
    const int pose = kUnknowns * frame;
    const int bias = pose + 3;
    const Eigen::Matrix3d w = weight.asDiagonal();
    const Eigen::Matrix3d w_before = w * by_before;
    AddBlock(before, by_before.transpose() * w_before);
    AddBlock(pose, w);
    AddOff(pose, before, w_before);
    g_.segment<3>(before) -= w_before.transpose() * error;
    g_.segment<3>(pose) -= weight.cwiseProduct(error);
    if (stands) return;
    AddBlock(bias, w);
    AddOff(bias, before, -w_before);
    AddOff(bias, pose, -w);
    g_.segment<3>(bias) += weight.cwiseProduct(error);
  }

  // bias = kept * previous bias + renewed, each over its standard deviation; constant while SLAM
  // stands. `more`: the standard deviation over the previous one.
  void AddBias(int frame, const State& state, const MotionNoise& noise, const SmootherFrame& here,
               const Eigen::Vector3d& more) {
    const auto k = static_cast<std::size_t>(frame);
    const bool stands = here.stands;
    const Eigen::Vector3d sigma = noise.bias.cwiseProduct(here.growth).cwiseMax(kLeastBias);
    const int bias = kUnknowns * frame + 3;
    if (frame == 0) {
      const Eigen::Vector3d weight = Inverted(sigma);
      AddBlock(bias, weight.asDiagonal());
      g_.segment<3>(bias) -= weight.cwiseProduct(state.bias[k]);
      return;
    }
    const Eigen::Vector3d kept =
        stands ? Eigen::Vector3d(Eigen::Vector3d::Ones()) : noise.bias_kept.cwiseProduct(more);
    const Eigen::Vector3d renewed = (1.0 - noise.bias_kept.array().square()).sqrt().matrix();
    const Eigen::Vector3d weight =
        Inverted(stands ? kLeastBias : Eigen::Vector3d(renewed.cwiseProduct(sigma)));
    const Eigen::Vector3d error = state.bias[k] - kept.cwiseProduct(state.bias[k - 1]);
    const Eigen::Vector3d weighted = weight.cwiseProduct(error);
    AddBlock(bias, weight.asDiagonal());
    AddBlock(bias - kUnknowns, kept.cwiseProduct(kept).cwiseProduct(weight).asDiagonal());
    AddOff(bias, bias - kUnknowns, (-kept.cwiseProduct(weight)).asDiagonal());
    g_.segment<3>(bias) -= weighted;
    g_.segment<3>(bias - kUnknowns) += kept.cwiseProduct(weighted);
  }

  // Applies the step; false when nothing could be solved.
  bool SolveInto(State& state) {
    for (int i = 0; i < h_.size(); ++i) *h_.At(i, i) += kStayInformation;
    if (!h_.Factor()) return false;
    const Eigen::VectorXd step = h_.Solve(std::move(g_));
    for (std::size_t k = 0; k < state.map_from_base.size(); ++k) {
      const auto row = kUnknowns * static_cast<Eigen::Index>(k);
      state.map_from_base[k] = state.map_from_base[k] * Pose2::FromVector(step.segment<3>(row));
      state.bias[k] += step.segment<3>(row + 3);
    }
    return true;
  }

 private:
  static std::vector<int> Envelope(std::size_t frames) {
    std::vector<int> first;
    for (int k = 0; k < static_cast<int>(frames); ++k) {
      first.insert(first.end(), kUnknowns, kUnknowns * std::max(k - 1, 0));
    }
    return first;
  }
  void AddBlock(int place, const Eigen::Matrix3d& block) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column <= row; ++column) {
        *h_.At(place + row, place + column) += block(row, column);
      }
    }
  }
  void AddOff(int row_place, int column_place, const Eigen::Matrix3d& block) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        *h_.At(row_place + row, column_place + column) += block(row, column);
      }
    }
  }

  SkylineMatrix h_;
  Eigen::VectorXd g_;
};

}  // namespace

MotionNoise NoiseOf(const std::vector<SmootherFrame>& frames) {
  MotionNoiseLearner learner;
  for (std::size_t k = 1; k < frames.size(); ++k) {
    if (frames[k].motion && frames[k].match.found && frames[k - 1].match.found) {
      learner.AddMatches(*frames[k].motion, frames[k].stands, frames[k - 1].match, frames[k].match);
    } else {
      learner.Break();
    }
  }
  return learner.Fit();
}

std::vector<Pose2> Smoothed(const std::vector<SmootherFrame>& frames, const MotionNoise& noise,
                            double stay_m) {
  State state;
  for (const SmootherFrame& frame : frames) state.map_from_base.push_back(frame.map_from_base);
  state.bias.assign(frames.size(), Eigen::Vector3d::Zero());
  const Eigen::Vector3d standing_weight = Inverted(kLeastWalk);
  const Eigen::Matrix3d jitter = Squared(noise.jitter);
  const Eigen::Vector3d stay_weight =
      stay_m > 0.0 ? Inverted({stay_m, stay_m, kStayTurn * stay_m}) : Eigen::Vector3d::Zero();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Equations equations(frames.size());
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const int frame = static_cast<int>(k);
      const MatchResult& match = frames[k].match;
      const Pose2& pose = state.map_from_base[k];
      if (match.found) {
        // The match measures the camera, from which SLAM's pose differs by its jitter.
        equations.AddMatch(frame, pose, match,
                           WithAddedCovariance(InformationIn(pose, match), jitter));
      }
      equations.AddStay(frame, pose, frames[k].map_from_base, stay_weight);
      const Eigen::Vector3d& growth = frames[k].growth;
      equations.AddBias(frame, state, noise, frames[k],
                        growth.cwiseQuotient(frames[k > 0 ? k - 1 : 0].growth));
      if (k > 0 && frames[k].motion) {
        const Eigen::Vector3d walk = noise.walk.cwiseProduct(growth).cwiseMax(kLeastWalk);
        equations.AddMotion(frame, state, *frames[k].motion, frames[k].stands,
                            frames[k].stands ? standing_weight : Inverted(walk));
      }
    }
    if (!equations.SolveInto(state)) break;
  }
  // The camera's pose: fuses SLAM's pose, uncertain by its jitter, with the frame's own match.
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (!frames[k].match.found) continue;
    Prediction prediction;
    prediction.map_from_base = state.map_from_base[k];
    prediction.covariance = jitter;
    MatchResult match = frames[k].match;
    match.information = InformationIn(prediction.map_from_base, match);
    state.map_from_base[k] = FuseKalman(prediction, match).map_from_base;
  }
  return state.map_from_base;
}

}  // namespace depthgrid
