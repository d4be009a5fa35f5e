#include "mapper/surfel/surfel_pairs.h"

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "mapper/surfel/misfit.h"
#include "mapper/surfel/shared_errors.h"

namespace depthgrid {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
// At most four lanes, so that the order of the sums is the same on wider machines.
using DoubleLanes = hn::CappedTag<double, 4>;
using Doubles = hn::Vec<DoubleLanes>;
constexpr DoubleLanes kDoubles;

// A residual within this many standard deviations is explained.
constexpr double kExplainedSigmas = 3.0;
// As firm_m2: always associate again.
constexpr double kNever = -1.0;
// Five standard deviations: limits the effect of outliers.
constexpr double kMostChi2 = 25.0;

// Two misfits this near to each other may be of one person, who is twice as wide. By chance misfits
// lie anywhere (docs/tried.md, "What moves").
constexpr double kMisfitsApartM = 0.2;
// All that belongs to somebody lies this near to a misfit.
constexpr double kPersonM = 0.4;

double SumOf(Doubles lanes) { return hn::GetLane(hn::SumOfLanes(kDoubles, lanes)); }

// Sum of weight * row * row^T.
struct SquareSums {
  Doubles xx = hn::Zero(kDoubles), xy = hn::Zero(kDoubles), yy = hn::Zero(kDoubles);
  Doubles x_yaw = hn::Zero(kDoubles), y_yaw = hn::Zero(kDoubles), yaw_yaw = hn::Zero(kDoubles);

  HWY_INLINE void Add(Doubles weight, Doubles x, Doubles y, Doubles yaw) {
    const Doubles weighted_x = hn::Mul(weight, x);
    const Doubles weighted_y = hn::Mul(weight, y);
    xx = hn::MulAdd(weighted_x, x, xx);
    xy = hn::MulAdd(weighted_x, y, xy);
    yy = hn::MulAdd(weighted_y, y, yy);
    x_yaw = hn::MulAdd(weighted_x, yaw, x_yaw);
    y_yaw = hn::MulAdd(weighted_y, yaw, y_yaw);
    yaw_yaw = hn::MulAdd(hn::Mul(weight, yaw), yaw, yaw_yaw);
  }
  Eigen::Matrix3d Sum() const {
    Eigen::Matrix3d sum;
    sum << SumOf(xx), SumOf(xy), SumOf(x_yaw), 0.0, SumOf(yy), SumOf(y_yaw), 0.0, 0.0,
        SumOf(yaw_yaw);
    return sum.selfadjointView<Eigen::Upper>();
  }
};

}  // namespace

void SurfelPairs::Assign(const std::vector<Surfel>& pieces, double correlation) {
  pieces_ = &pieces;
  associated_ = false;
  blocks_.assign((pieces.size() + kLanes - 1) / kLanes, {});
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    Block& block = blocks_[i / kLanes];
    const std::size_t lane = i % kLanes;
    block.x_m[lane] = pieces[i].point_m.x();
    block.y_m[lane] = pieces[i].point_m.y();
    block.counted_over[lane] = 1.0;
  }
  if (correlation <= 0.0) return;
  CountCompanions(pieces, companies_);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    blocks_[i / kLanes].counted_over[i % kLanes] = CountedOver(companies_[i], correlation);
  }
}

void SurfelPairs::Associate(const SurfelStore& map, const PairGates& gates,
                            const Pose2& map_from_base) {
  const Motion2 motion(map_from_base);
  // Half, since each piece was associated at a yaw within that of the yaw kept here.
  const double turn_rad = WrapAngle(map_from_base.yaw_rad - associated_yaw_rad_);
  const bool turned = !associated_ || std::abs(turn_rad) >= 0.5 * SurfelStore::kFirmRad;
  associated_ = true;
  if (turned) associated_yaw_rad_ = map_from_base.yaw_rad;
  for (std::size_t i = 0; i < pieces_->size(); ++i) {
    const Block& block = blocks_[i / kLanes];
    const std::size_t lane = i % kLanes;
    const Eigen::Vector2d moved = motion * Eigen::Vector2d(block.x_m[lane], block.y_m[lane]);
    const double dx = moved.x() - block.at_x_m[lane];
    const double dy = moved.y() - block.at_y_m[lane];
    if (turned || dx * dx + dy * dy > block.firm_m2[lane]) AssociateOne(map, gates, motion, i);
  }
}

void SurfelPairs::AssociateOne(const SurfelStore& map, const PairGates& gates,
                               const Motion2& motion, std::size_t index) {
  const Surfel& piece = (*pieces_)[index];
  const Surfel moved = motion * piece;
  const double piece_variance = 1.0 / piece.information;
  AssociationGate gate = gates.association;
  gate.off_m += 2.0 * std::sqrt(piece_variance);
  const Association found = map.NearestFirmly(moved, gate);
  Block& block = blocks_[index / kLanes];
  const std::size_t lane = index % kLanes;
  block.at_x_m[lane] = moved.point_m.x();
  block.at_y_m[lane] = moved.point_m.y();
  if (found.index < 0) {
    block.firm_m2[lane] = kNever;
    block.information[lane] = 0.0;
    block.per_sigma[lane] = 0.0;
    return;
  }
  const Surfel& surfel = map[found.index];
  const double variance = piece_variance + 1.0 / surfel.information;
  block.firm_m2[lane] = found.firm_m * found.firm_m;
  block.surfel_x_m[lane] = surfel.point_m.x();
  block.surfel_y_m[lane] = surfel.point_m.y();
  block.normal_x[lane] = surfel.normal.x();
  block.normal_y[lane] = surfel.normal.y();
  block.information[lane] = 1.0 / (variance * block.counted_over[lane]);
  block.per_sigma[lane] = 1.0 / std::sqrt(variance);
  block.mapped[lane] = map.FrameOf(found.index);
  block.noise_share[lane] = 1.0 / (surfel.information * variance);
  block.normal_variance[lane] =
      std::max({1.0 / surfel.normal_information, gates.normal_floor_rad * gates.normal_floor_rad,
                gates.normal_floor_share / piece.normal_information});
}

double SurfelPairs::SigmasOff(const Block& block, std::size_t lane, const Motion2& motion) {
  const Eigen::Vector2d point_m(block.x_m[lane], block.y_m[lane]);
  const Eigen::Vector2d surfel_m(block.surfel_x_m[lane], block.surfel_y_m[lane]);
  const Eigen::Vector2d normal(block.normal_x[lane], block.normal_y[lane]);
  return normal.dot(motion * point_m - surfel_m) * block.per_sigma[lane];
}

SurfelPairs::YoungPairs SurfelPairs::YoungAt(double frame, const Pose2& map_from_base) const {
  YoungPairs young;
  const Motion2 motion(map_from_base);
  for (const Block& block : blocks_) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (block.information[lane] <= 0.0) continue;
      if (block.mapped[lane] <= frame) {
        ++young.others;
        continue;
      }
      const double sigmas = SigmasOff(block, lane, motion);
      ++young.count;
      young.chi2 += std::min(sigmas * sigmas, kMostChi2);
    }
  }
  if (young.count > 0) young.chi2 /= young.count;
  return young;
}

bool SurfelPairs::IsYoung(std::size_t piece, double frame) const {
  const Block& block = blocks_[piece / kLanes];
  const std::size_t lane = piece % kLanes;
  return block.information[lane] > 0.0 && block.mapped[lane] > frame;
}

// Of the others: a piece is not near to itself.
bool SurfelPairs::IsNearOneOf(const std::vector<std::size_t>& pieces, std::size_t piece,
                              double within_m) const {
  const Eigen::Vector2d& at_m = (*pieces_)[piece].point_m;
  return std::any_of(pieces.begin(), pieces.end(), [&](std::size_t other) {
    return other != piece && ((*pieces_)[other].point_m - at_m).squaredNorm() < within_m * within_m;
  });
}

const std::vector<std::size_t>& SurfelPairs::MisfitsAt(double frame, const Pose2& map_from_base) {
  const Motion2 motion(map_from_base);
  off_.clear();
  for (std::size_t i = 0; i < pieces_->size(); ++i) {
    if (IsYoung(i, frame) &&
        std::abs(SigmasOff(blocks_[i / kLanes], i % kLanes, motion)) > kExplainedSigmas) {
      off_.push_back(i);
    }
  }
  misfits_.clear();
  std::copy_if(off_.begin(), off_.end(), std::back_inserter(misfits_),
               [&](std::size_t i) { return IsNearOneOf(off_, i, kMisfitsApartM); });
  return misfits_;
}

const std::vector<std::size_t>& SurfelPairs::YoungNear(double frame) {
  near_.clear();
  for (std::size_t i = 0; i < pieces_->size(); ++i) {
    if (IsYoung(i, frame) && IsNearOneOf(misfits_, i, kPersonM)) near_.push_back(i);
  }
  return near_;
}

double SurfelPairs::Chi2At(const Pose2& map_from_base) const {
  const Motion2 motion(map_from_base);
  double chi2 = 0.0;
  for (const Block& block : blocks_) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (block.information[lane] <= 0.0) continue;
      const double sigmas = SigmasOff(block, lane, motion);
      chi2 += std::min(sigmas * sigmas, kMostChi2) / block.counted_over[lane];
    }
  }
  return chi2;
}

void SurfelPairs::LeaveOut(const std::vector<std::size_t>& pieces) {
  for (const std::size_t piece : pieces) {
    Block& block = blocks_[piece / kLanes];
    const std::size_t lane = piece % kLanes;
    block.left_out[lane] += std::exchange(block.information[lane], 0.0);
  }
}

void SurfelPairs::LeaveOutYoung(double frame) {
  for (Block& block : blocks_) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (block.mapped[lane] <= frame) continue;
      block.left_out[lane] = std::exchange(block.information[lane], 0.0);
    }
  }
}

void SurfelPairs::TakeInAll() {
  for (Block& block : blocks_) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      block.information[lane] += std::exchange(block.left_out[lane], 0.0);
    }
  }
}

void SurfelPairs::PartsOf(const PairGates& gates, const Pose2& map_from_base,
                          std::vector<MapPart>& parts) const {
  parts.clear();
  const Motion2 motion(map_from_base);
  for (const Block& block : blocks_) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (block.information[lane] <= 0.0) continue;
      const Eigen::Vector2d point_m(block.x_m[lane], block.y_m[lane]);
      const Eigen::Vector2d normal(block.normal_x[lane], block.normal_y[lane]);
      const double sigmas = std::abs(SigmasOff(block, lane, motion));
      const double weight = block.information[lane] * std::min(1.0, gates.huber_sigmas / sigmas);
      const Eigen::Vector3d row = OffsetJacobian(motion.TurnBack(normal), point_m);
      parts.push_back(
          {block.mapped[lane], weight * row * row.transpose(), block.noise_share[lane]});
    }
  }
}

PairEvaluation SurfelPairs::Evaluate(const PairGates& gates, const Pose2& map_from_base) {
  const Motion2 motion(map_from_base);
  const Doubles cosine = hn::Set(kDoubles, motion.cosine);
  const Doubles sine = hn::Set(kDoubles, motion.sine);
  const Doubles shift_x = hn::Set(kDoubles, motion.shift_m.x());
  const Doubles shift_y = hn::Set(kDoubles, motion.shift_m.y());
  const Doubles huber = hn::Set(kDoubles, gates.huber_sigmas);
  const Doubles one = hn::Set(kDoubles, 1.0);
  SquareSums seen;
  SquareSums feigned;
  Doubles g_x = hn::Zero(kDoubles), g_y = hn::Zero(kDoubles), g_yaw = hn::Zero(kDoubles);
  PairEvaluation evaluation;
  Misfit misfit;
  for (const Block& block : blocks_) {
    for (std::size_t lane = 0; lane < kLanes; lane += hn::Lanes(kDoubles)) {
      const auto load = [lane](const Lanes& lanes) { return hn::LoadU(kDoubles, &lanes[lane]); };
      const Doubles x = load(block.x_m);
      const Doubles y = load(block.y_m);
      const Doubles normal_x = load(block.normal_x);
      const Doubles normal_y = load(block.normal_y);
      const Doubles information = load(block.information);
      // The piece in the map, relative to its surfel.
      const Doubles from_x = hn::Add(hn::NegMulAdd(sine, y, hn::Mul(cosine, x)),
                                     hn::Sub(shift_x, load(block.surfel_x_m)));
      const Doubles from_y = hn::Add(hn::MulAdd(sine, x, hn::Mul(cosine, y)),
                                     hn::Sub(shift_y, load(block.surfel_y_m)));
      const Doubles error = hn::MulAdd(normal_x, from_x, hn::Mul(normal_y, from_y));
      const Doubles sigmas = hn::Mul(hn::Abs(error), load(block.per_sigma));
      const Doubles weight = hn::Mul(information, hn::Min(one, hn::Div(huber, sigmas)));
      // The normal in base axes; OffsetJacobian() for it, and for the tangent (-y, x).
      const Doubles row_x = hn::MulAdd(cosine, normal_x, hn::Mul(sine, normal_y));
      const Doubles row_y = hn::NegMulAdd(sine, normal_x, hn::Mul(cosine, normal_y));
      const Doubles row_yaw = hn::NegMulAdd(row_x, y, hn::Mul(row_y, x));
      const Doubles tangent_yaw = hn::MulAdd(row_x, x, hn::Mul(row_y, y));
      seen.Add(weight, row_x, row_y, row_yaw);
      feigned.Add(hn::Mul(weight, load(block.normal_variance)), hn::Neg(row_y), row_x, tangent_yaw);
      const Doubles pull = hn::Mul(weight, error);
      g_x = hn::NegMulAdd(pull, row_x, g_x);
      g_y = hn::NegMulAdd(pull, row_y, g_y);
      g_yaw = hn::NegMulAdd(pull, row_yaw, g_yaw);
      Lanes sigmas_of;
      hn::StoreU(sigmas, kDoubles, &sigmas_of[lane]);
      for (std::size_t i = lane; i < lane + hn::Lanes(kDoubles); ++i) {
        if (block.information[i] <= 0.0) continue;
        misfit.Add(sigmas_of[i]);
        ++evaluation.used;
        evaluation.explained += sigmas_of[i] < kExplainedSigmas ? 1 : 0;
      }
    }
  }
  evaluation.equations.h = seen.Sum();
  evaluation.equations.false_h = feigned.Sum();
  evaluation.equations.g = {SumOf(g_x), SumOf(g_y), SumOf(g_yaw)};
  evaluation.variance_factor = misfit.VarianceFactor();
  return evaluation;
}

}  // namespace depthgrid
