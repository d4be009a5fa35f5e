#include "mapper/surfel/surfel_map.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace depthgrid {
namespace {

Eigen::Vector2d Rotate(double c, double s, const Eigen::Vector2d& v) {
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

// map_from_base moved by a small motion in base axes.
Pose2 Moved(const Pose2& pose, const Eigen::Vector3d& motion) {
  return pose * Pose2{motion.x(), motion.y(), motion.z()};
}

struct Normal {
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double chi2 = 0.0;
  int used = 0;
  int explained = 0;
};

void Debias(double factor, Normal& n) {
  if (factor <= 0.0 || n.used == 0) return;
  // Units differ between metres and radians: a ridge relative to each diagonal.
  Eigen::Matrix3d m = n.m;
  for (int i = 0; i < 3; ++i) m(i, i) += 1e-9 * n.h(i, i) + 1e-12;
  const Eigen::LLT<Eigen::Matrix3d> llt(m);
  const Eigen::Matrix3d l = llt.matrixL();
  // H v = lambda M v with v = L^-T y.
  Eigen::Matrix3d a = l.triangularView<Eigen::Lower>().solve(n.h);
  a = l.triangularView<Eigen::Lower>().solve(a.transpose().eval());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(0.5 * (a + a.transpose()));
  const Eigen::Matrix3d mv = l * eigen.eigenvectors();  // M v
  const Eigen::Matrix3d v =
      l.transpose().triangularView<Eigen::Upper>().solve(eigen.eigenvectors());
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const double lambda = eigen.eigenvalues()[i];
    const double share = lambda > factor ? 1.0 - factor / lambda : 0.0;
    h += share * lambda * mv.col(i) * mv.col(i).transpose();
    b += share * v.col(i).dot(n.b) * mv.col(i);
  }
  n.h = h;
  n.b = b;
}

}  // namespace

void SurfelOptions::Visit(OptionsVisitor& v) { v.Group("scan", scan, "how scans are cut"); }

const std::vector<ScanSurfel>& SurfelMapCore::Extract(const Scan& scan) {
  noise_.Add(scan);
  return extractor_.Extract(scan, noise_);
}

int SurfelMapCore::Associate(const Eigen::Vector2d& point_m, const Eigen::Vector2d& normal,
                             double reach_m, double gate_m) const {
  const double min_cosine = std::cos(RadFromDeg(options_.max_angle_deg));
  const Eigen::Vector2d half(std::abs(normal.x()) * gate_m + std::abs(normal.y()) * reach_m,
                             std::abs(normal.y()) * gate_m + std::abs(normal.x()) * reach_m);
  int best = -1;
  double best_score = 2.0;
  store_.ForEachIn(point_m - half, point_m + half, [&](int i) {
    const Surfel& surfel = store_.at(i);
    if (surfel.normal.dot(normal) < min_cosine) return;
    const Eigen::Vector2d d = point_m - surfel.point_m;
    const double along = (d.x() * surfel.normal.y() - d.y() * surfel.normal.x()) / reach_m;
    const double off = d.dot(surfel.normal) / gate_m;
    if (std::abs(along) > 1.0 || std::abs(off) > 1.0) return;
    const double score = along * along + off * off;
    if (score < best_score) {
      best_score = score;
      best = i;
    }
  });
  return best;
}

SurfelMatch SurfelMapCore::Match(const std::vector<ScanSurfel>& pieces, const Pose2& predicted,
                                 const Eigen::Matrix3d& covariance) const {
  SurfelMatch match;
  match.map_from_base = predicted;
  if (store_.surfels().empty() || pieces.empty()) return match;
  const Eigen::Matrix3d prior = covariance.inverse();
  Pose2 pose = predicted;
  Normal normal;
  const double reach_m = 1.5 * options_.spacing_m;
  const double floor2 = options_.normal_floor_rad * options_.normal_floor_rad;
  for (int iteration = 0; iteration < options_.max_iterations; ++iteration) {
    const double c = std::cos(pose.yaw_rad);
    const double s = std::sin(pose.yaw_rad);
    normal = Normal{};
    for (const ScanSurfel& piece : pieces) {
      const Eigen::Vector2d point_m = Rotate(c, s, piece.point_m) + pose.translation();
      const Eigen::Vector2d direction = Rotate(c, s, piece.normal);
      const int index =
          Associate(point_m, direction, reach_m, options_.gate_m + 2.0 * piece.sigma_m);
      if (index < 0) continue;
      const Surfel& surfel = store_.at(index);
      const double error_m = surfel.normal.dot(point_m - surfel.point_m);
      const double variance = piece.sigma_m * piece.sigma_m + 1.0 / surfel.information;
      const double sigmas = std::abs(error_m) / std::sqrt(variance);
      double w = 1.0 / variance;
      if (sigmas > options_.huber_sigmas) w *= options_.huber_sigmas / sigmas;
      if (sigmas < 3.0) ++normal.explained;
      const Eigen::Vector2d n = Rotate(c, -s, surfel.normal);
      const Eigen::Vector2d& p = piece.point_m;
      const Eigen::Vector3d j(n.x(), n.y(), n.y() * p.x() - n.x() * p.y());
      const Eigen::Vector3d jt(-n.y(), n.x(), n.x() * p.x() + n.y() * p.y());
      normal.h += w * j * j.transpose();
      normal.b -= w * error_m * j;
      normal.m += w * std::max(1.0 / surfel.normal_information, floor2) * jt * jt.transpose();
      normal.chi2 += w * error_m * error_m;
      ++normal.used;
    }
    match.iterations = iteration + 1;
    if (normal.used < 3) break;
    Debias(options_.debias, normal);
    normal.h /= options_.correlation;
    normal.b /= options_.correlation;
    const Eigen::Vector3d back = Between(pose, predicted).vector();
    const Eigen::Vector3d step = (normal.h + prior).ldlt().solve(normal.b + prior * back);
    pose = Moved(pose, step);
    if (step.head<2>().norm() < 1e-5 && std::abs(step.z()) < 1e-6) break;
  }
  match.found = normal.used >= 3;
  match.map_from_base = pose;
  match.information = normal.h;
  match.gradient = normal.b;
  match.used = normal.used;
  match.chi2 = normal.chi2;
  match.explained = static_cast<double>(normal.explained) / static_cast<double>(pieces.size());
  return match;
}

void SurfelMapCore::Insert(const std::vector<ScanSurfel>& pieces, const Pose2& map_from_base,
                           int frame) {
  const double c = std::cos(map_from_base.yaw_rad);
  const double s = std::sin(map_from_base.yaw_rad);
  for (const ScanSurfel& piece : pieces) {
    const Eigen::Vector2d point_m = Rotate(c, s, piece.point_m) + map_from_base.translation();
    const Eigen::Vector2d direction = Rotate(c, s, piece.normal);
    const double information = 1.0 / (piece.sigma_m * piece.sigma_m);
    const double normal_information = 1.0 / (piece.sigma_normal_rad * piece.sigma_normal_rad);
    const int index =
        Associate(point_m, direction, 0.6 * options_.spacing_m, 0.02 + 3.0 * piece.sigma_m);
    if (index < 0) {
      Surfel surfel;
      surfel.point_m = point_m;
      surfel.normal = direction;
      surfel.information = information;
      surfel.normal_information = normal_information;
      surfel.first_frame = surfel.last_frame = frame;
      store_.Add(surfel);
      continue;
    }
    Surfel& surfel = store_.at(index);
    const double error_m = surfel.normal.dot(point_m - surfel.point_m);
    surfel.information += information;
    surfel.point_m += (information / surfel.information * error_m) * surfel.normal;
    const double turn_rad =
        std::atan2(surfel.normal.x() * direction.y() - surfel.normal.y() * direction.x(),
                   surfel.normal.dot(direction));
    surfel.normal_information += normal_information;
    const double share_rad = normal_information / surfel.normal_information * turn_rad;
    surfel.normal = Rotate(std::cos(share_rad), std::sin(share_rad), surfel.normal);
    surfel.last_frame = frame;
  }
}

}  // namespace depthgrid
