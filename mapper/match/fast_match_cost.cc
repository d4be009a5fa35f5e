#include "mapper/match/fast_match_cost.h"

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "mapper/core/error.h"
#include "mapper/match/reached_cells.h"

namespace depthgrid {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
// At most eight lanes, so that the order of the sums is the same on wider machines.
using FloatLanes = hn::CappedTag<float, 8>;
using IntLanes = hn::RebindToSigned<FloatLanes>;
using Floats = hn::Vec<FloatLanes>;
using Ints = hn::Vec<IntLanes>;
constexpr FloatLanes kFloats;
constexpr IntLanes kInts;

// How far points may move before the map is copied again, and the border of unknown cells around
// the map, so wide that the 4 x 4 cells of a clamped point are outside the map.
constexpr int kReachCells = 6;
constexpr int kBorderCells = 5;

constexpr int kCoefficients = 16;  // of a bicubic polynomial

struct Cubic {
  Floats c0, c1, c2, c3;
};

// Coefficients of the Catmull-Rom cubic between the second and third of four neighbours.
HWY_INLINE Cubic CatmullRom(Floats p0, Floats p1, Floats p2, Floats p3) {
  const Floats half = hn::Set(kFloats, 0.5F);
  const Floats inner = hn::Sub(p1, p2);
  const Floats c1 = hn::Mul(half, hn::Sub(p2, p0));
  // c3 = (3 (p1 - p2) + p3 - p0) / 2 and c2 = p2 - p1 - c1 - c3, so that the cubic is p2 at 1.
  const Floats c3 = hn::Mul(half, hn::MulAdd(hn::Set(kFloats, 3.0F), inner, hn::Sub(p3, p0)));
  const Floats c2 = hn::Neg(hn::Add(inner, hn::Add(c1, c3)));
  return {p1, c1, c2, c3};
}

// Value, first derivative and half the second derivative by Horner's scheme.
struct CubicValue {
  Floats value, first, half_second;
};

HWY_INLINE CubicValue Evaluate(Floats c0, Floats c1, Floats c2, Floats c3, Floats t) {
  Floats value = hn::MulAdd(c3, t, c2);
  Floats first = hn::MulAdd(c3, t, value);
  const Floats half_second = hn::MulAdd(c3, t, first);
  value = hn::MulAdd(value, t, c1);
  first = hn::MulAdd(first, t, value);
  value = hn::MulAdd(value, t, c0);
  return {value, first, half_second};
}

struct Neighbours {
  Floats p0, p1, p2, p3;
};

// Four cells in a row from each point's first one, by loads and a transposition: gathers are slow
// on many machines (with them the whole solver took 3.4 times as long).
HWY_INLINE Neighbours LoadRow(const float* probs, const std::int32_t* square) {
  using Four = hn::CappedTag<float, 4>;
  const auto from = [&](std::size_t lane) {
    const auto low = hn::LoadU(Four(), probs + square[lane]);
    if constexpr (hn::MaxLanes(kFloats) == 8) {
      return hn::Combine(kFloats, hn::LoadU(Four(), probs + square[lane + 4]), low);
    } else {
      return low;
    }
  };
  const Floats a = from(0);
  const Floats b = from(1);
  const Floats c = from(2);
  const Floats d = from(3);
  const Floats ac_low = hn::InterleaveLower(kFloats, a, c);  // a0 c0 a1 c1
  const Floats bd_low = hn::InterleaveLower(kFloats, b, d);
  const Floats ac_high = hn::InterleaveUpper(kFloats, a, c);
  const Floats bd_high = hn::InterleaveUpper(kFloats, b, d);
  return {hn::InterleaveLower(kFloats, ac_low, bd_low),
          hn::InterleaveUpper(kFloats, ac_low, bd_low),
          hn::InterleaveLower(kFloats, ac_high, bd_high),
          hn::InterleaveUpper(kFloats, ac_high, bd_high)};
}

// The coefficient of x^i y^j is at [(4 i + j) lanes].
void FitPolynomials(const float* probs, int row, const std::int32_t* square, float* polynomial) {
  const std::size_t lanes = hn::Lanes(kFloats);
  Cubic along_x[4];
  for (int j = 0; j < 4; ++j) {
    const Neighbours p = LoadRow(probs + j * row, square);
    along_x[j] = CatmullRom(p.p0, p.p1, p.p2, p.p3);
  }
  const auto fit_y = [&](Floats Cubic::*power, std::size_t i) {
    const Cubic along_y =
        CatmullRom(along_x[0].*power, along_x[1].*power, along_x[2].*power, along_x[3].*power);
    float* to = polynomial + 4 * i * lanes;
    hn::Store(along_y.c0, kFloats, to);
    hn::Store(along_y.c1, kFloats, to + lanes);
    hn::Store(along_y.c2, kFloats, to + 2 * lanes);
    hn::Store(along_y.c3, kFloats, to + 3 * lanes);
  };
  fit_y(&Cubic::c0, 0);
  fit_y(&Cubic::c1, 1);
  fit_y(&Cubic::c2, 2);
  fit_y(&Cubic::c3, 3);
}

// M and its derivatives, with lengths in cells.
struct Sample {
  Floats value, dx, dy, dxx, dxy, dyy;
};

HWY_INLINE Sample EvaluatePolynomials(const float* polynomial, Floats tx, Floats ty) {
  const std::size_t lanes = hn::Lanes(kFloats);
  CubicValue in_y[4];
  for (std::size_t i = 0; i < 4; ++i) {
    const float* from = polynomial + 4 * i * lanes;
    in_y[i] =
        Evaluate(hn::Load(kFloats, from), hn::Load(kFloats, from + lanes),
                 hn::Load(kFloats, from + 2 * lanes), hn::Load(kFloats, from + 3 * lanes), ty);
  }
  const CubicValue value = Evaluate(in_y[0].value, in_y[1].value, in_y[2].value, in_y[3].value, tx);
  const CubicValue dy = Evaluate(in_y[0].first, in_y[1].first, in_y[2].first, in_y[3].first, tx);
  const CubicValue dyy = Evaluate(in_y[0].half_second, in_y[1].half_second, in_y[2].half_second,
                                  in_y[3].half_second, tx);
  const Floats two = hn::Set(kFloats, 2.0F);
  return {value.value, value.first,
          dy.value,    hn::Mul(two, value.half_second),
          dy.first,    hn::Mul(two, dyy.value)};
}

// Pairwise, always in the same order.
double SumOf(Floats lanes) { return hn::GetLane(hn::SumOfLanes(kFloats, lanes)); }

// The terms of one point, with lengths in cells; E is the derivative of its position by (x, y,
// yaw).
struct PointTerms {
  Floats residual;                   // 1 - M
  Floats slope_x, slope_y;           // gradient of M
  Floats slope_yaw;                  // E^T grad M
  Floats wall_xx, wall_xy, wall_yy;  // C = grad M grad M^T - (1 - M) D^2 M
  Floats x_yaw, y_yaw, yaw_yaw;      // of E^T C E; yaw_yaw with the curvature of the point's path

  HWY_INLINE PointTerms(const Sample& m, Floats arm_x, Floats arm_y, Floats weight) {
    residual = hn::Mul(weight, hn::Sub(hn::Set(kFloats, 1.0F), m.value));
    slope_x = hn::Mul(weight, m.dx);
    slope_y = hn::Mul(weight, m.dy);
    slope_yaw = hn::NegMulAdd(arm_y, slope_x, hn::Mul(arm_x, slope_y));
    wall_xx = hn::NegMulAdd(residual, m.dxx, hn::Mul(slope_x, slope_x));
    wall_xy = hn::NegMulAdd(residual, m.dxy, hn::Mul(slope_x, slope_y));
    wall_yy = hn::NegMulAdd(residual, m.dyy, hn::Mul(slope_y, slope_y));
    x_yaw = hn::NegMulAdd(arm_y, wall_xx, hn::Mul(arm_x, wall_xy));
    y_yaw = hn::NegMulAdd(arm_y, wall_xy, hn::Mul(arm_x, wall_yy));
    const Floats turn = hn::NegMulAdd(arm_y, x_yaw, hn::Mul(arm_x, y_yaw));
    // The second derivative of the point by yaw is minus the arm.
    const Floats bend = hn::MulAdd(arm_x, slope_x, hn::Mul(arm_y, slope_y));
    yaw_yaw = hn::MulAdd(residual, bend, turn);
  }
};

// A gradient or second derivative from sums with lengths in cells.
Eigen::Vector3d GradientOf(double x, double y, double yaw, double resolution_m) {
  return {x / resolution_m, y / resolution_m, yaw};
}

Eigen::Matrix3d HessianOf(double xx, double xy, double yy, double x_yaw, double y_yaw,
                          double yaw_yaw, double resolution_m) {
  const Eigen::Vector3d per_unit{1.0 / resolution_m, 1.0 / resolution_m, 1.0};
  Eigen::Matrix3d hessian;
  hessian << xx, xy, x_yaw, xy, yy, y_yaw, x_yaw, y_yaw, yaw_yaw;
  return per_unit.asDiagonal() * hessian * per_unit.asDiagonal();
}

struct CostSums {
  Floats value = hn::Zero(kFloats);
  Floats x = hn::Zero(kFloats), y = hn::Zero(kFloats), yaw = hn::Zero(kFloats);
  Floats xx = hn::Zero(kFloats), xy = hn::Zero(kFloats), yy = hn::Zero(kFloats);
  Floats x_yaw = hn::Zero(kFloats), y_yaw = hn::Zero(kFloats), yaw_yaw = hn::Zero(kFloats);

  HWY_INLINE void Add(const PointTerms& point) {
    value = hn::MulAdd(point.residual, point.residual, value);
    x = hn::NegMulAdd(point.residual, point.slope_x, x);
    y = hn::NegMulAdd(point.residual, point.slope_y, y);
    yaw = hn::NegMulAdd(point.residual, point.slope_yaw, yaw);
    xx = hn::Add(xx, point.wall_xx);
    xy = hn::Add(xy, point.wall_xy);
    yy = hn::Add(yy, point.wall_yy);
    x_yaw = hn::Add(x_yaw, point.x_yaw);
    y_yaw = hn::Add(y_yaw, point.y_yaw);
    yaw_yaw = hn::Add(yaw_yaw, point.yaw_yaw);
  }
  Eigen::Vector3d Gradient(double resolution_m) const {
    return GradientOf(SumOf(x), SumOf(y), SumOf(yaw), resolution_m);
  }
  Eigen::Matrix3d Hessian(double resolution_m) const {
    return HessianOf(SumOf(xx), SumOf(xy), SumOf(yy), SumOf(x_yaw), SumOf(y_yaw), SumOf(yaw_yaw),
                     resolution_m);
  }
  // Second derivatives with respect to the pose and to a shift of the points.
  Eigen::Matrix<double, 3, 2> ShiftCurvature(double resolution_m) const {
    const double xy_sum = SumOf(xy);
    Eigen::Matrix<double, 3, 2> curvature;
    curvature << SumOf(xx), xy_sum, xy_sum, SumOf(yy), SumOf(x_yaw), SumOf(y_yaw);
    curvature /= resolution_m;
    curvature.topRows<2>() /= resolution_m;
    return curvature;
  }
};

// The curvature of walls turned by 90 degrees: C becomes (yy, -xy, xx).
struct AlongSums {
  Floats x_yaw = hn::Zero(kFloats), y_yaw = hn::Zero(kFloats), yaw_yaw = hn::Zero(kFloats);

  HWY_INLINE void Add(const PointTerms& point, Floats arm_x, Floats arm_y) {
    const Floats along_x = hn::Neg(hn::MulAdd(arm_y, point.wall_yy, hn::Mul(arm_x, point.wall_xy)));
    const Floats along_y = hn::MulAdd(arm_y, point.wall_xy, hn::Mul(arm_x, point.wall_xx));
    x_yaw = hn::Add(x_yaw, along_x);
    y_yaw = hn::Add(y_yaw, along_y);
    yaw_yaw = hn::Add(yaw_yaw, hn::NegMulAdd(arm_y, along_x, hn::Mul(arm_x, along_y)));
  }
};

// Replaces NaN by the probability of unknown cells.
void CopyRow(const float* probs, int count, float unknown_prob, float* copy) {
  for (int i = 0; i < count; ++i) copy[i] = probs[i] == probs[i] ? probs[i] : unknown_prob;
}

}  // namespace

void FastMatchCost::Prepare(const MatchPoints& points, const ProbabilityView& view,
                            const Pose2& map_from_base) {
  Require(points.size() > 0, "a match cost has points");
  points_ = &points;
  view_ = view;
  const std::size_t lanes = hn::Lanes(kFloats);
  const std::size_t size = points.x_m.size();
  const std::size_t filled = (size + lanes - 1) / lanes * lanes;
  x_m_.assign(filled, 0.0F);
  y_m_.assign(filled, 0.0F);
  weight_.assign(filled, 0.0F);
  std::copy(points.x_m.begin(), points.x_m.end(), x_m_.begin());
  std::copy(points.y_m.begin(), points.y_m.end(), y_m_.begin());
  std::fill(weight_.begin(), weight_.begin() + static_cast<std::ptrdiff_t>(size), 1.0F);
  square_.resize(filled);
  // One vector more, so that the coefficients can start aligned.
  polynomial_.resize(kCoefficients * filled + lanes);
  CopyMap(map_from_base);
}

void FastMatchCost::CopyMap(const Pose2& map_from_base) {
  middle_ = map_from_base;
  const GridGeometry& map = view_.geometry;
  copied_ = ReachedCells(*points_, PointCells(map_from_base, map.resolution_m), kReachCells + 3,
                         map, kBorderCells);
  const auto width = static_cast<std::size_t>(copied_.width_cells);
  probs_.resize(copied_.size());
  const int from_x = std::clamp(map.min_cell.x - copied_.min_cell.x, 0, copied_.width_cells);
  const int to_x = std::clamp(map.min_cell.x + map.width_cells - copied_.min_cell.x, from_x,
                              copied_.width_cells);
  for (int y = 0; y < copied_.height_cells; ++y) {
    float* row = probs_.data() + width * static_cast<std::size_t>(y);
    const Cell first{copied_.min_cell.x + from_x, copied_.min_cell.y + y};
    if (to_x > from_x && map.Contains(first)) {
      std::fill(row, row + from_x, view_.unknown_prob);
      CopyRow(view_.occupied_prob + map.Index(first), to_x - from_x, view_.unknown_prob,
              row + from_x);
      std::fill(row + to_x, row + width, view_.unknown_prob);
    } else {
      std::fill(row, row + width, view_.unknown_prob);
    }
  }
  std::fill(square_.begin(), square_.end(), -1);
}

bool FastMatchCost::Reaches(const Pose2& map_from_base) const {
  const double moved_m =
      (map_from_base.translation() - middle_.translation()).norm() +
      points_->farthest_m * std::abs(WrapAngle(map_from_base.yaw_rad - middle_.yaw_rad));
  return moved_m <= kReachCells * copied_.resolution_m;
}

template <typename Visitor>
void FastMatchCost::ForEachVector(const Pose2& map_from_base, Visitor visit) {
  if (!Reaches(map_from_base)) CopyMap(map_from_base);
  const double r = copied_.resolution_m;
  const Floats c = hn::Set(kFloats, static_cast<float>(std::cos(map_from_base.yaw_rad) / r));
  const Floats s = hn::Set(kFloats, static_cast<float>(std::sin(map_from_base.yaw_rad) / r));
  // Position of base in the copied rectangle, from the centre of its first cell.
  const auto offset = [&](double position_m, int first) {
    return hn::Set(kFloats, static_cast<float>(position_m / r - first - 0.5));
  };
  const Floats base_x = offset(map_from_base.x_m, copied_.min_cell.x);
  const Floats base_y = offset(map_from_base.y_m, copied_.min_cell.y);
  // The lowest and highest positions whose 4 x 4 cells are in the rectangle.
  const Floats low = hn::Set(kFloats, 1.0F);
  const Floats high_x = hn::Set(kFloats, static_cast<float>(copied_.width_cells - 3));
  const Floats high_y = hn::Set(kFloats, static_cast<float>(copied_.height_cells - 3));
  const Ints row = hn::Set(kInts, copied_.width_cells);
  const Ints one = hn::Set(kInts, 1);
  const std::size_t lanes = hn::Lanes(kFloats);
  float* polynomial = AlignedPolynomials();
  for (std::size_t i = 0; i < x_m_.size(); i += lanes, polynomial += kCoefficients * lanes) {
    const Floats x_m = hn::LoadU(kFloats, x_m_.data() + i);
    const Floats y_m = hn::LoadU(kFloats, y_m_.data() + i);
    const Floats arm_x = hn::NegMulAdd(s, y_m, hn::Mul(c, x_m));
    const Floats arm_y = hn::MulAdd(s, x_m, hn::Mul(c, y_m));
    const Floats u = hn::Min(hn::Max(hn::Add(arm_x, base_x), low), high_x);
    const Floats v = hn::Min(hn::Max(hn::Add(arm_y, base_y), low), high_y);
    const Floats u0 = hn::Floor(u);
    const Floats v0 = hn::Floor(v);
    // The first of the 4 x 4 cells is one before in x and y.
    const Ints square = hn::Add(hn::Mul(hn::Sub(hn::ConvertTo(kInts, v0), one), row),
                                hn::Sub(hn::ConvertTo(kInts, u0), one));
    if (!hn::AllTrue(kInts, hn::Eq(square, hn::LoadU(kInts, square_.data() + i)))) {
      hn::StoreU(square, kInts, square_.data() + i);
      FitPolynomials(probs_.data(), copied_.width_cells, square_.data() + i, polynomial);
    }
    const Sample sample = EvaluatePolynomials(polynomial, hn::Sub(u, u0), hn::Sub(v, v0));
    const Floats weight = hn::LoadU(kFloats, weight_.data() + i);
    visit(i, sample, PointTerms(sample, arm_x, arm_y, weight), arm_x, arm_y, weight);
  }
}

float* FastMatchCost::AlignedPolynomials() {
  const std::size_t vector_bytes = hn::Lanes(kFloats) * sizeof(float);
  const auto address = reinterpret_cast<std::uintptr_t>(polynomial_.data());
  return polynomial_.data() +
         (vector_bytes - address % vector_bytes) % vector_bytes / sizeof(float);
}

MatchCost FastMatchCost::Evaluate(const Pose2& map_from_base) {
  CostSums sums;
  ForEachVector(map_from_base, [&](std::size_t, const Sample&, const PointTerms& point, Floats,
                                   Floats, Floats) { sums.Add(point); });
  const double count = points_->size();
  const double r = copied_.resolution_m;
  return {0.5 * SumOf(sums.value) / count, sums.Gradient(r) / count, sums.Hessian(r) / count};
}

InformationSums FastMatchCost::SumUp(const Pose2& map_from_base,
                                     const MatchInformationOptions& options) {
  const double r = copied_.resolution_m;
  InformationSums sums;
  CostSums total;
  CostSums patch;
  AlongSums along;
  Floats explained = hn::Zero(kFloats);
  const Floats threshold = hn::Set(kFloats, static_cast<float>(kExplainedProb));
  const auto end_patch = [&] {
    const Eigen::Matrix<double, 3, 2> shift_curvature = patch.ShiftCurvature(r);
    AddPatch(patch.Gradient(r), shift_curvature, options.map_sigma_m, sums.gradient_covariance);
    patch = CostSums();
  };
  const float patch_m2 = static_cast<float>(options.patch_m * options.patch_m);
  std::size_t start = 0;
  ForEachVector(map_from_base, [&](std::size_t i, const Sample& sample, const PointTerms& point,
                                   Floats arm_x, Floats arm_y, Floats weight) {
    const float dx_m = x_m_[i] - x_m_[start];
    const float dy_m = y_m_[i] - y_m_[start];
    if (i % kPatchStep == 0 && dx_m * dx_m + dy_m * dy_m > patch_m2) {
      end_patch();
      start = i;
    }
    total.Add(point);
    patch.Add(point);
    along.Add(point, arm_x, arm_y);
    explained = hn::Add(explained, hn::IfThenElseZero(hn::Gt(sample.value, threshold), weight));
  });
  end_patch();
  sums.curvature = total.Hessian(r);
  sums.curvature_along_walls =
      HessianOf(SumOf(total.yy), -SumOf(total.xy), SumOf(total.xx), SumOf(along.x_yaw),
                SumOf(along.y_yaw), SumOf(along.yaw_yaw), r);
  sums.explained = static_cast<int>(SumOf(explained));
  return sums;
}

}  // namespace depthgrid
