// A scan's pieces and the surfels of the map they belong to, from one iteration of a match to the
// next.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "mapper/core/reference_map.h"
#include "mapper/surfel/debias.h"
#include "mapper/surfel/surfel_store.h"

namespace depthgrid {

struct PairGates {
  AssociationGate association;      // and two sigmas of the piece along the normal
  double huber_sigmas = 0.0;        // larger residuals count linearly
  double normal_floor_rad = 0.0;    // no normal is known better
  double normal_floor_share = 0.0;  // nor than this share of the variance of the piece's own
};

struct PairEvaluation {
  NormalEquations equations;
  int used = 0;
  int explained = 0;             // within three standard deviations
  double variance_factor = 1.0;  // of their Misfit
};

class SurfelPairs {
 public:
  // Begins with other pieces, none of which belongs to a surfel yet. They are to outlive the
  // evaluations. Companions (shared_errors.h) among them err alike to this correlation.
  void Assign(const std::vector<Surfel>& pieces, double correlation = 0.0);
  // Finds the surfel of each piece that could belong to another one than it did at the pose of the
  // call before. The map must not change between Assign() and the last of these calls.
  void Associate(const SurfelStore& map, const PairGates& gates, const Pose2& map_from_base);
  PairEvaluation Evaluate(const PairGates& gates, const Pose2& map_from_base);
  // Those whose surfels were drawn by frames after this one (SurfelStore::FrameOf), at a pose.
  struct YoungPairs {
    int count = 0;
    int others = 0;
    double chi2 = 0.0;  // mean, of which none counts more than 25
  };
  YoungPairs YoungAt(double frame, const Pose2& map_from_base) const;
  // Leaves them out until the next association, or takes them in again.
  void LeaveOutYoung(double frame);
  void TakeInAll();
  // What the map's surfels each contribute there.
  void PartsOf(const PairGates& gates, const Pose2& map_from_base,
               std::vector<MapPart>& parts) const;

 private:
  static constexpr std::size_t kLanes = 4;
  using Lanes = std::array<double, kLanes>;
  // Pieces side by side, so that they are evaluated together. One that belongs to no surfel has no
  // information.
  struct Block {
    Lanes x_m{}, y_m{};                // the pieces, base axes
    Lanes at_x_m{}, at_y_m{};          // where they were in the map when associated
    Lanes firm_m2{};                   // they may move so far from there, squared
    Lanes surfel_x_m{}, surfel_y_m{};  // their surfels, map axes
    Lanes normal_x{}, normal_y{};
    Lanes counted_over{};  // their information, as CountedOver()
    Lanes information{};   // of the offset between both
    Lanes per_sigma{};     // its square root
    Lanes normal_variance{};
    Lanes mapped{}, noise_share{};  // as MapPart
    Lanes left_out{};               // their information, while they are
  };
  // The distance of a piece from its surfel along the normal, in standard deviations.
  static double SigmasOff(const Block& block, std::size_t lane, const Motion2& motion);
  void AssociateOne(const SurfelStore& map, const PairGates& gates, const Motion2& motion,
                    std::size_t piece);

  const std::vector<Surfel>* pieces_ = nullptr;
  std::vector<Block> blocks_;
  std::vector<int> companies_;  // memory only
  bool associated_ = false;
  double associated_yaw_rad_ = 0.0;
};

}  // namespace depthgrid
