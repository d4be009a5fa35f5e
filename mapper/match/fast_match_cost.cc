#include "mapper/match/fast_match_cost.h"

// Highway asks for AES with AVX2, which x86-64-v3 does not promise and nothing here uses.
#define HWY_DISABLE_PCLMUL_AES
#include <hwy/highway.h>

#include <algorithm>
#include <array>
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

// How far points may move before the map is copied again, and the unknown around the map: a
// clamped point's 4 x 4 cells lie outside of the map.
constexpr int kReachCells = 6;
constexpr int kBorderCells = 5;

constexpr int kCoefficients = 16;  // of a bicubic polynomial

struct Cubic {
  Floats c0, c1, c2, c3;
};

// Catmull-Rom through four neighbours, between the second and the third, as powers of the fraction.
Cubic CatmullRom(Floats p0, Floats p1, Floats p2, Floats p3) {
  const Floats half = hn::Set(kFloats, 0.5F);
  const Floats inner = hn::Sub(p1, p2);
  const Floats c1 = hn::Mul(half, hn::Sub(p2, p0));
  // c3 = (3 (p1 - p2) + p3 - p0) / 2 and c2 = p2 - p1 - c1 - c3, so that the cubic meets p2 at 1.
  const Floats c3 = hn::Mul(half, hn::MulAdd(hn::Set(kFloats, 3.0F), inner, hn::Sub(p3, p0)));
  const Floats c2 = hn::Neg(hn::Add(inner, hn::Add(c1, c3)));
  return {p1, c1, c2, c3};
}

// Value, first and half the second derivative by repeated Horner.
struct CubicValue {
  Floats value, first, half_second;
};

CubicValue Evaluate(Floats c0, Floats c1, Floats c2, Floats c3, Floats t) {
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

// Four cells in a row from each point's first one: loads and a transposition, since gathers are
// slow on many machines (12 times on the one measured).
Neighbours LoadRow(const float* probs, const std::int32_t* square) {
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

// Coefficient j of y to the power and i of x is at [(4 i + j) lanes].
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

// M and its derivatives per cell.
struct Sample {
  Floats value, dx, dy, dxx, dxy, dyy;
};

Sample EvaluatePolynomials(const float* polynomial, Floats tx, Floats ty) {
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

double SumOf(Floats lanes) {
  alignas(64) std::array<float, 8> values{};
  hn::Store(lanes, kFloats, values.data());
  double sum = 0.0;
  for (const float value : values) sum += value;
  return sum;
}

// With lengths in cells: cost, gradient and second derivative of 1/2 sum (1 - M)^2.
struct CostSums {
  Floats value = hn::Zero(kFloats);
  Floats x = hn::Zero(kFloats), y = hn::Zero(kFloats), yaw = hn::Zero(kFloats);
  Floats xx = hn::Zero(kFloats), xy = hn::Zero(kFloats), yy = hn::Zero(kFloats);
  Floats x_yaw = hn::Zero(kFloats), y_yaw = hn::Zero(kFloats), yaw_yaw = hn::Zero(kFloats);

  // A point's sample, with its arm from base in map axes.
  void Add(const Sample& m, Floats arm_x, Floats arm_y, Floats weight) {
    const Floats r = hn::Mul(weight, hn::Sub(hn::Set(kFloats, 1.0F), m.value));
    const Floats slope_x = hn::Mul(weight, m.dx);
    const Floats slope_y = hn::Mul(weight, m.dy);
    value = hn::MulAdd(r, r, value);
    const Floats slope_yaw = hn::NegMulAdd(arm_y, slope_x, hn::Mul(arm_x, slope_y));
    x = hn::NegMulAdd(r, slope_x, x);
    y = hn::NegMulAdd(r, slope_y, y);
    yaw = hn::NegMulAdd(r, slope_yaw, yaw);
    // Per point: C = grad M grad M^T - r D^2 M, then E^T C E with E the point's motion.
    const Floats c_xx = hn::NegMulAdd(r, m.dxx, hn::Mul(slope_x, slope_x));
    const Floats c_xy = hn::NegMulAdd(r, m.dxy, hn::Mul(slope_x, slope_y));
    const Floats c_yy = hn::NegMulAdd(r, m.dyy, hn::Mul(slope_y, slope_y));
    const Floats c_x_yaw = hn::NegMulAdd(arm_y, c_xx, hn::Mul(arm_x, c_xy));
    const Floats c_y_yaw = hn::NegMulAdd(arm_y, c_xy, hn::Mul(arm_x, c_yy));
    xx = hn::Add(xx, c_xx);
    xy = hn::Add(xy, c_xy);
    yy = hn::Add(yy, c_yy);
    x_yaw = hn::Add(x_yaw, c_x_yaw);
    y_yaw = hn::Add(y_yaw, c_y_yaw);
    const Floats turn = hn::NegMulAdd(arm_y, c_x_yaw, hn::Mul(arm_x, c_y_yaw));
    // The arm's own second derivative is minus the arm.
    const Floats bend = hn::MulAdd(arm_x, slope_x, hn::Mul(arm_y, slope_y));
    yaw_yaw = hn::Add(yaw_yaw, hn::MulAdd(r, bend, turn));
  }

  MatchCost Cost(double resolution_m, double count) const {
    const double per_m = 1.0 / resolution_m;
    MatchCost cost;
    cost.value = 0.5 * SumOf(value) / count;
    cost.gradient = Eigen::Vector3d(SumOf(x) * per_m, SumOf(y) * per_m, SumOf(yaw)) / count;
    const double h_xy = SumOf(xy) * per_m * per_m;
    const double h_x_yaw = SumOf(x_yaw) * per_m;
    const double h_y_yaw = SumOf(y_yaw) * per_m;
    cost.hessian << SumOf(xx) * per_m * per_m, h_xy, h_x_yaw,  //
        h_xy, SumOf(yy) * per_m * per_m, h_y_yaw,              //
        h_x_yaw, h_y_yaw, SumOf(yaw_yaw);
    cost.hessian /= count;
    return cost;
  }
};

// NaN becomes the constant of unknown cells.
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
  // One vector more, so that the coefficients can begin at a multiple of a vector's size.
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

MatchCost FastMatchCost::Evaluate(const Pose2& map_from_base) {
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
  const std::size_t lanes = hn::Lanes(kFloats);
  const auto address = reinterpret_cast<std::uintptr_t>(polynomial_.data());
  const std::size_t vector_bytes = lanes * sizeof(float);
  float* polynomial =
      polynomial_.data() + (vector_bytes - address % vector_bytes) % vector_bytes / sizeof(float);

  CostSums sums;
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
    const Ints one = hn::Set(kInts, 1);
    const Ints square = hn::Add(hn::Mul(hn::Sub(hn::ConvertTo(kInts, v0), one), row),
                                hn::Sub(hn::ConvertTo(kInts, u0), one));
    if (!hn::AllTrue(kInts, hn::Eq(square, hn::LoadU(kInts, square_.data() + i)))) {
      hn::StoreU(square, kInts, square_.data() + i);
      FitPolynomials(probs_.data(), copied_.width_cells, square_.data() + i, polynomial);
    }
    const Sample sample = EvaluatePolynomials(polynomial, hn::Sub(u, u0), hn::Sub(v, v0));
    sums.Add(sample, arm_x, arm_y, hn::LoadU(kFloats, weight_.data() + i));
  }
  return sums.Cost(r, points_->size());
}

}  // namespace depthgrid
