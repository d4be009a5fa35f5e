// Distributions for tests of means.
#pragma once

namespace depthgrid {

double NormalCdf(double z);

// P(T <= t) for Student's t with `degrees` of freedom, shifted by `noncentrality`: T = (Z + shift)
// / S with S^2 a chi-square over its degrees. Integrated numerically over S; accurate to 1e-9.
double StudentTCdf(double t, double degrees, double noncentrality = 0.0);

// The t with P(T <= t) = probability, central; probability in (0, 1).
double StudentTQuantile(double probability, double degrees);

}  // namespace depthgrid
