#include "sim/path/cubic_spline.h"

#include <algorithm>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// The tridiagonal system of the second derivatives m (Press et al., Numerical Recipes, 3.3):
// h_l m_(k-1) + 2 (h_l + h_r) m_k + h_r m_(k+1) = 6 (slope_r - slope_l), m = 0 at both ends.
Eigen::MatrixXd SecondDerivatives(const std::vector<double>& knots, const Eigen::MatrixXd& values) {
  const Eigen::Index count = values.cols();
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(values.rows(), count);
  std::vector<double> upper(static_cast<std::size_t>(count), 0.0);
  for (Eigen::Index k = 1; k + 1 < count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double left_step = knots[i] - knots[i - 1];
    const double right_step = knots[i + 1] - knots[i];
    const double pivot = 2.0 * (left_step + right_step) - left_step * upper[i - 1];
    upper[i] = right_step / pivot;
    right.col(k) = (6.0 * ((values.col(k + 1) - values.col(k)) / right_step -
                           (values.col(k) - values.col(k - 1)) / left_step) -
                    left_step * right.col(k - 1)) /
                   pivot;
  }
  for (Eigen::Index k = count - 2; k >= 1; --k) {
    right.col(k) -= upper[static_cast<std::size_t>(k)] * right.col(k + 1);
  }
  return right;
}

}  // namespace

CubicSpline::CubicSpline(std::vector<double> knots, Eigen::MatrixXd values)
    : knots_(std::move(knots)), values_(std::move(values)) {
  Require(knots_.size() >= 2 && values_.cols() == static_cast<Eigen::Index>(knots_.size()),
          "a spline has two or more knots and a value at each");
  for (std::size_t k = 1; k < knots_.size(); ++k) {
    Require(knots_[k] > knots_[k - 1], "the knots of a spline increase");
  }
  second_derivatives_ = SecondDerivatives(knots_, values_);
}

CubicSpline::Segment CubicSpline::SegmentAt(double u) const {
  const auto after = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, u);
  const double knot = *(after - 1);
  const double step = *after - knot;
  const double right = (u - knot) / step;
  return {after - knots_.begin() - 1, step, 1.0 - right, right};
}

Eigen::VectorXd CubicSpline::Value(double u) const {
  const auto [k, step, a, b] = SegmentAt(u);
  return a * values_.col(k) + b * values_.col(k + 1) +
         ((a * a * a - a) * second_derivatives_.col(k) +
          (b * b * b - b) * second_derivatives_.col(k + 1)) *
             (step * step / 6.0);
}

Eigen::VectorXd CubicSpline::Slope(double u) const {
  const auto [k, step, a, b] = SegmentAt(u);
  return (values_.col(k + 1) - values_.col(k)) / step +
         ((3.0 * b * b - 1.0) * second_derivatives_.col(k + 1) -
          (3.0 * a * a - 1.0) * second_derivatives_.col(k)) *
             (step / 6.0);
}

Eigen::VectorXd CubicSpline::Bend(double u) const {
  const auto [k, step, a, b] = SegmentAt(u);
  return a * second_derivatives_.col(k) + b * second_derivatives_.col(k + 1);
}

}  // namespace depthgrid
