// Natural cubic interpolation: twice continuously differentiable curves through given points.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace depthgrid {

// Passes through column k of `values` at knot k; the second derivative is 0 at both ends. Outside
// the knots the first and last polynomials are extrapolated.
class CubicSpline {
 public:
  // Needs at least two strictly increasing knots and one column per knot.
  CubicSpline(std::vector<double> knots, Eigen::MatrixXd values);

  Eigen::VectorXd Value(double u) const;
  Eigen::VectorXd Slope(double u) const;  // first derivative
  Eigen::VectorXd Bend(double u) const;   // second derivative

 private:
  // The segment between knots k and k + 1, `step` apart, and the linear weights of the two knots at
  // u.
  struct Segment {
    Eigen::Index k = 0;
    double step = 1.0;
    double left = 0.0;
    double right = 0.0;
  };
  Segment SegmentAt(double u) const;

  std::vector<double> knots_;
  Eigen::MatrixXd values_;
  Eigen::MatrixXd second_derivatives_;
};

}  // namespace depthgrid
