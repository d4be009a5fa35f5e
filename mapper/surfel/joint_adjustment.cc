#include "mapper/surfel/joint_adjustment.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "mapper/surfel/skyline_cholesky.h"

namespace depthgrid {
namespace {

Eigen::Vector2d Rotate(double c, double s, const Eigen::Vector2d& v) {
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

Surfel Transformed(const Pose2& a_from_b, const Surfel& in_b) {
  Surfel in_a = in_b;
  const double c = std::cos(a_from_b.yaw_rad);
  const double s = std::sin(a_from_b.yaw_rad);
  in_a.point_m = Rotate(c, s, in_b.point_m) + a_from_b.translation();
  in_a.normal = Rotate(c, s, in_b.normal);
  return in_a;
}

int Nearest(const SurfelStore& store, const Surfel& piece, double reach_m, double gate_m,
            double min_cosine) {
  const Eigen::Vector2d& normal = piece.normal;
  const Eigen::Vector2d half(std::abs(normal.x()) * gate_m + std::abs(normal.y()) * reach_m,
                             std::abs(normal.y()) * gate_m + std::abs(normal.x()) * reach_m);
  int best = -1;
  double best_score = 2.0;
  store.ForEachIn(piece.point_m - half, piece.point_m + half, [&](int i) {
    const Surfel& surfel = store.at(i);
    if (surfel.normal.dot(normal) < min_cosine) return;
    const Eigen::Vector2d d = piece.point_m - surfel.point_m;
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

struct Observation {
  int landmark;
  int group;
  const Surfel* local;
};

}  // namespace

int MergeSurfel(SurfelStore& store, const Surfel& piece, double reach_m, double gate_m,
                double min_cosine) {
  const int index = Nearest(store, piece, reach_m, gate_m, min_cosine);
  if (index < 0) return store.Add(piece);
  Surfel& surfel = store.at(index);
  const double error_m = surfel.normal.dot(piece.point_m - surfel.point_m);
  surfel.information += piece.information;
  surfel.point_m += (piece.information / surfel.information * error_m) * surfel.normal;
  const double turn_rad =
      std::atan2(surfel.normal.x() * piece.normal.y() - surfel.normal.y() * piece.normal.x(),
                 surfel.normal.dot(piece.normal));
  surfel.normal_information += piece.normal_information;
  const double share_rad = piece.normal_information / surfel.normal_information * turn_rad;
  surfel.normal = Rotate(std::cos(share_rad), std::sin(share_rad), surfel.normal);
  return index;
}

void GroupBuilder::Close() {
  if (groups_.empty() || !groups_.back().surfels.empty()) return;
  groups_.back().surfels = store_.surfels();
  store_.Clear();
}

const std::vector<SurfelGroup>& GroupBuilder::Groups() {
  Close();
  return groups_;
}

void GroupBuilder::Add(const std::vector<ScanSurfel>& pieces, const Pose2& map_from_base,
                       const Pose2& prior_from_base, bool linked) {
  bool fresh = groups_.empty() || !linked;
  Pose2 group_from_base;
  if (!fresh) {
    group_from_base = Between(groups_.back().map_from_group, map_from_base);
    fresh = group_from_base.translation().norm() > options_.group_m ||
            std::abs(group_from_base.yaw_rad) > RadFromDeg(options_.group_deg);
  }
  if (fresh) {
    Close();
    SurfelGroup group;
    group.first_frame = static_cast<int>(group_of_frame_.size());
    group.map_from_group = map_from_base;
    group.prior_from_group = prior_from_base;
    group.linked = linked;
    groups_.push_back(group);
    group_from_base = Pose2{};
  }
  ++groups_.back().frames;
  group_of_frame_.push_back(static_cast<int>(groups_.size()) - 1);
  group_from_frame_.push_back(group_from_base);
  const double min_cosine = std::cos(RadFromDeg(options_.max_angle_deg));
  for (const ScanSurfel& piece : pieces) {
    Surfel surfel;
    surfel.point_m = piece.point_m;
    surfel.normal = piece.normal;
    surfel.information = 1.0 / (piece.sigma_m * piece.sigma_m);
    surfel.normal_information = 1.0 / (piece.sigma_normal_rad * piece.sigma_normal_rad);
    MergeSurfel(store_, Transformed(group_from_base, surfel), 0.5 * options_.landmark_m,
                0.02 + 3.0 * piece.sigma_m, min_cosine);
  }
}

JointResult AdjustJointly(const std::vector<SurfelGroup>& groups, const JointOptions& options) {
  JointResult result;
  const int count = static_cast<int>(groups.size());
  std::vector<Pose2>& poses = result.map_from_group;
  for (const SurfelGroup& group : groups) poses.push_back(group.map_from_group);
  if (count < 2) return result;
  const double min_cosine = std::cos(RadFromDeg(options.max_angle_deg));
  const auto link_error = [&](int g) {
    const Pose2 measured = Between(groups[g - 1].prior_from_group, groups[g].prior_from_group);
    return Between(measured, Between(poses[g - 1], poses[g])).vector();
  };
  const auto estimate_sigma = [&] {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double n = 0.0;
    for (int g = 1; g < count; ++g) {
      if (!groups[g].linked) continue;
      const Eigen::Vector3d e = link_error(g) / groups[g - 1].frames;
      sum += e.cwiseProduct(e);
      n += 1.0;
    }
    return Eigen::Vector3d((sum / std::max(n, 1.0)).cwiseSqrt());
  };
  result.odometry_sigma = estimate_sigma();

  for (int round = 0; round < options.rounds; ++round) {
    const double share =
        options.rounds > 1 ? static_cast<double>(round) / (options.rounds - 1) : 1.0;
    const double gate_m =
        options.first_gate_m * std::pow(options.last_gate_m / options.first_gate_m, share);
    // Landmarks at the current poses.
    SurfelStore store;
    std::vector<Observation> observations;
    for (int g = 0; g < count; ++g) {
      for (const Surfel& local : groups[g].surfels) {
        const int landmark = MergeSurfel(store, Transformed(poses[g], local),
                                         0.6 * options.landmark_m, gate_m, min_cosine);
        observations.push_back({landmark, g, &local});
      }
    }
    std::stable_sort(observations.begin(), observations.end(),
                     [](const auto& a, const auto& b) { return a.landmark < b.landmark; });
    // The envelope.
    std::vector<int> first_group(static_cast<std::size_t>(count));
    for (int g = 0; g < count; ++g) first_group[g] = std::max(g - 1, 0);
    for (std::size_t i = 0, j = 0; i < observations.size(); i = j) {
      for (j = i; j < observations.size() && observations[j].landmark == observations[i].landmark;
           ++j) {
        first_group[observations[j].group] =
            std::min(first_group[observations[j].group], observations[i].group);
      }
    }
    std::vector<int> first;
    for (int g = 0; g < count; ++g) {
      for (int k = 0; k < 3; ++k) first.push_back(3 * first_group[g]);
    }
    SkylineMatrix h(first);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(3 * count);
    // Surfels, each landmark's offset eliminated.
    std::vector<double> error, weight;
    std::vector<Eigen::Vector3d> row;
    std::vector<int> of;
    for (std::size_t i = 0, j = 0; i < observations.size(); i = j) {
      j = i;
      while (j < observations.size() && observations[j].landmark == observations[i].landmark) ++j;
      if (j - i < 2 || observations[i].group == observations[j - 1].group) continue;
      const Surfel& landmark = store.at(observations[i].landmark);
      error.clear();
      weight.clear();
      row.clear();
      of.clear();
      double sum_w = 0, sum_we = 0;
      for (std::size_t k = i; k < j; ++k) {
        const Observation& o = observations[k];
        const Pose2& pose = poses[o.group];
        const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
        const Eigen::Vector2d point_m = Rotate(c, s, o.local->point_m) + pose.translation();
        const double e = landmark.normal.dot(point_m - landmark.point_m);
        const double var =
            1.0 / o.local->information + options.surfel_floor_m * options.surfel_floor_m;
        double w = 1.0 / var;
        const double sigmas = std::abs(e) / std::sqrt(var);
        if (sigmas > options.huber_sigmas) w *= options.huber_sigmas / sigmas;
        const Eigen::Vector2d n = Rotate(c, -s, landmark.normal);
        const Eigen::Vector2d& p = o.local->point_m;
        error.push_back(e);
        weight.push_back(w);
        row.emplace_back(n.x(), n.y(), n.y() * p.x() - n.x() * p.y());
        of.push_back(o.group);
        sum_w += w;
        sum_we += w * e;
      }
      const double mean = sum_we / sum_w;
      for (std::size_t k = 0; k < row.size(); ++k) {
        const int gk = 3 * of[k];
        const Eigen::Vector3d wj = weight[k] * row[k];
        b.segment<3>(gk) -= (error[k] - mean) * wj;
        for (int r = 0; r < 3; ++r) {
          for (int q = 0; q <= r; ++q) h.At(gk + r, gk + q) += wj[r] * row[k][q];
        }
        for (std::size_t l = 0; l <= k; ++l) {
          const int gl = 3 * of[l];
          const Eigen::Vector3d wl = (weight[l] / sum_w) * row[l];
          if (gl == gk) {
            const double twice = l == k ? 1.0 : 2.0;
            for (int r = 0; r < 3; ++r) {
              for (int q = 0; q <= r; ++q)
                h.At(gk + r, gk + q) -= 0.5 * twice * (wj[r] * wl[q] + wj[q] * wl[r]);
            }
          } else {
            for (int r = 0; r < 3; ++r) {
              double* out = h.Row(gk + r) + (gl - h.First(gk + r));
              for (int q = 0; q < 3; ++q) out[q] -= wj[r] * wl[q];
            }
          }
        }
      }
    }
    // The prior's motion.
    for (int g = 1; g < count; ++g) {
      if (!groups[g].linked) continue;
      const Eigen::Vector3d sigma =
          groups[g - 1].frames * result.odometry_sigma.cwiseMax(Eigen::Vector3d(1e-5, 1e-5, 1e-6));
      const Eigen::Vector3d info = sigma.cwiseProduct(sigma).cwiseInverse();
      const Eigen::Vector3d e = link_error(g);
      const Pose2 z = Inverse(Between(poses[g - 1], poses[g]));
      Eigen::Matrix3d ji;
      const double c = std::cos(z.yaw_rad), s = std::sin(z.yaw_rad);
      ji << -c, s, -z.y_m, -s, -c, z.x_m, 0, 0, -1;
      const Eigen::Matrix3d wji = info.asDiagonal() * ji;
      const Eigen::Matrix3d hii = ji.transpose() * wji;
      b.segment<3>(3 * g - 3) -= wji.transpose() * e;
      b.segment<3>(3 * g) -= info.cwiseProduct(e);
      for (int r = 0; r < 3; ++r) {
        for (int q = 0; q <= r; ++q) h.At(3 * g - 3 + r, 3 * g - 3 + q) += hii(r, q);
        h.At(3 * g + r, 3 * g + r) += info[r];
        for (int q = 0; q < 3; ++q) h.At(3 * g + r, 3 * g - 3 + q) += wji(r, q);
      }
    }
    for (int k = 0; k < 3; ++k) h.At(k, k) += 1e12;  // the first group stays
    for (int i = 0; i < 3 * count; ++i) h.At(i, i) *= 1.0 + 1e-9;
    result.landmarks = static_cast<int>(store.surfels().size());
    result.observations = static_cast<int>(observations.size());
    if (!h.Factor()) break;
    const Eigen::VectorXd step = h.Solve(b);
    for (int g = 0; g < count; ++g) {
      poses[g] = poses[g] * Pose2{step[3 * g], step[3 * g + 1], step[3 * g + 2]};
    }
    result.odometry_sigma = estimate_sigma();
  }
  return result;
}

}  // namespace depthgrid
