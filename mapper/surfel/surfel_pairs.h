// Associations of a scan's pieces with map surfels, kept between iterations of a match.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "mapper/core/reference_map.h"
#include "mapper/surfel/debias.h"
#include "mapper/surfel/surfel_store.h"

namespace depthgrid {

struct PairGates {
  AssociationGate association;      // plus two sigmas of the piece along the normal
  double huber_sigmas = 0.0;        // larger residuals count linearly
  double normal_floor_rad = 0.0;    // least sigma of a normal
  double normal_floor_share = 0.0;  // least variance, as share of the piece's own
};

struct PairEvaluation {
  NormalEquations equations;
  int used = 0;
  int explained = 0;             // with residuals within three standard deviations
  double variance_factor = 1.0;  // Misfit of the pairs
};

class SurfelPairs {
 public:
  // Sets new pieces, without associations. They must outlive the evaluations. `correlation`: of the
  // errors of companions among them (shared_errors.h).
  void Assign(const std::vector<Surfel>& pieces, double correlation = 0.0);
  // Updates the association of each piece for which it can have changed since the previous pose.
  // The map must not change between Assign() and the last of these calls.
  void Associate(const SurfelStore& map, const PairGates& gates, const Pose2& map_from_base);
  PairEvaluation Evaluate(const PairGates& gates, const Pose2& map_from_base);
  // Statistics, at a pose, of the pairs whose surfel's mean frame (SurfelStore::FrameOf) is after
  // `frame`.
  struct YoungPairs {
    int count = 0;
    int others = 0;
    double chi2 = 0.0;  // mean, each limited to 25
  };
  YoungPairs YoungAt(double frame, const Pose2& map_from_base) const;
  // The pieces of the young pairs that are more than three sigmas off at a pose, less those that no
  // other of them lies near to.
  // Valid until the next call.
  const std::vector<std::size_t>& MisfitsAt(double frame, const Pose2& map_from_base);
  // The pieces of the young pairs within reach of a person from any of the last MisfitsAt(). Valid
  // as long.
  const std::vector<std::size_t>& YoungNear(double frame);
  // Sum of the squared residuals in sigmas, each limited to 25 and divided by what companions
  // share.
  double Chi2At(const Pose2& map_from_base) const;
  // Removes the young pairs from evaluations until the next association, or TakeInAll() restores
  // them.
  void LeaveOutYoung(double frame);
  // The same with the pairs of these pieces.
  void LeaveOut(const std::vector<std::size_t>& pieces);
  void TakeInAll();
  // The contribution of each matched surfel at this pose.
  void PartsOf(const PairGates& gates, const Pose2& map_from_base,
               std::vector<MapPart>& parts) const;

 private:
  static constexpr std::size_t kLanes = 4;
  using Lanes = std::array<double, kLanes>;
  // Pieces in SIMD lanes. A piece without a surfel has zero information.
  struct Block {
    Lanes x_m{}, y_m{};                // the pieces, base axes
    Lanes at_x_m{}, at_y_m{};          // where they were in the map when associated
    Lanes firm_m2{};                   // squared motion up to which that holds
    Lanes surfel_x_m{}, surfel_y_m{};  // their surfels, map axes
    Lanes normal_x{}, normal_y{};
    Lanes counted_over{};  // divisor of their information, CountedOver()
    Lanes information{};   // of the distance along the normal
    Lanes per_sigma{};     // 1 / sigma of that distance
    Lanes normal_variance{};
    Lanes mapped{}, noise_share{};  // as MapPart
    Lanes left_out{};               // information of pairs left out
  };
  // The distance of a piece from its surfel along the normal, in standard deviations.
  static double SigmasOff(const Block& block, std::size_t lane, const Motion2& motion);
  bool IsYoung(std::size_t piece, double frame) const;
  bool IsNearOneOf(const std::vector<std::size_t>& pieces, std::size_t piece,
                   double within_m) const;
  void AssociateOne(const SurfelStore& map, const PairGates& gates, const Motion2& motion,
                    std::size_t piece);

  const std::vector<Surfel>* pieces_ = nullptr;
  std::vector<Block> blocks_;
  // Members only to reuse their memory.
  std::vector<int> companies_;
  std::vector<std::size_t> off_, misfits_, near_;
  bool associated_ = false;
  double associated_yaw_rad_ = 0.0;
};

}  // namespace depthgrid
