#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "mapper/core/level.h"
#include "mapper/io/trajectory_file.h"
#include "mapper/surfel/joint_adjustment.h"
#include "mapper/surfel/surfel_map.h"
#include "sim/laser_world.h"
#include "sim/odometry_noise.h"

using namespace depthgrid;

namespace {

double NowUs() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

struct Scores {
  double mean = 0, ate = 0, max = 0;
};
Scores Score(const std::vector<Pose2>& truth, const std::vector<Pose2>& est) {
  Scores s;
  const double n = static_cast<double>(truth.size());
  Eigen::Vector2d mt(0, 0), me(0, 0);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double e = (truth[i].translation() - est[i].translation()).norm();
    s.mean += e / n;
    s.max = std::max(s.max, e);
    mt += truth[i].translation() / n;
    me += est[i].translation() / n;
  }
  double a = 0, b = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Eigen::Vector2d p = est[i].translation() - me, q = truth[i].translation() - mt;
    a += p.dot(q);
    b += p.x() * q.y() - p.y() * q.x();
  }
  const Pose2 r{0, 0, std::atan2(b, a)};
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Eigen::Vector2d p = est[i].translation() - me, q = truth[i].translation() - mt;
    s.ate += (r * p - q).squaredNorm() / n;
  }
  s.ate = std::sqrt(s.ate);
  return s;
}

Scan ScanFrom(const std::vector<double>& range, const LaserOptions& o) {
  Scan scan;
  scan.max_range_m = o.max_range_m;
  for (std::size_t i = 0; i < range.size(); ++i) {
    Beam b;
    b.bearing_rad =
        static_cast<float>(o.FirstBearingRad() + static_cast<double>(i) * o.BearingStepRad());
    if (range[i] >= o.max_range_m) {
      b.clear_to_m = 5;
    } else if (range[i] > 0.1) {
      b.hit = true;
      b.range_m = static_cast<float>(range[i]);
      b.clear_to_m = b.range_m;
    }
    scan.beams.push_back(b);
  }
  return scan;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app;
  std::vector<std::string> worlds;
  LaserOptions laser;
  OdometryOptions odo;
  SurfelOptions surfel;
  JointOptions joint;
  int first_seed = 1, seeds = 3, stride = 1;
  double qx = 2.5e-3, qy = 1.5e-3, qyaw = 1e-3, qscale = 1;
  bool verbose = false;
  unsigned every = 30;
  app.add_option("--worlds", worlds);
  app.add_option("--seeds", seeds);
  app.add_option("--first-seed", first_seed);
  app.add_option("--stride", stride);
  app.add_option("--beams", laser.beams);
  app.add_option("--fov", laser.field_of_view_deg);
  app.add_option("--noise", laser.noise_relative);
  app.add_option("--noise2", laser.noise_quadratic_per_m);
  app.add_option("--noise-corr", laser.noise_correlation);
  app.add_option("--outliers", laser.outlier_share);
  app.add_option("--drift", odo.mean_error_m);
  app.add_option("--jitter", odo.jitter_m);
  app.add_option("--jitter-deg", odo.jitter_deg);
  app.add_option("--qscale", qscale);
  app.add_option("--correlation", surfel.correlation);
  app.add_option("--debias", surfel.debias);
  app.add_option("--spacing", surfel.spacing_m);
  app.add_option("--gate", surfel.gate_m);
  app.add_option("--split", surfel.scan.split_chi2);
  app.add_option("--beams-per", surfel.scan.beams);
  app.add_option("--nfloor", surfel.normal_floor_rad);
  app.add_option("--bnoise", surfel.scan.bearing_noise_steps);
  app.add_option("--group-m", joint.group_m);
  app.add_option("--group-deg", joint.group_deg);
  app.add_option("--landmark", joint.landmark_m);
  app.add_option("--rounds", joint.rounds);
  app.add_option("--gate0", joint.first_gate_m);
  app.add_option("--gate1", joint.last_gate_m);
  app.add_option("--jhuber", joint.huber_sigmas);
  app.add_option("--jfloor", joint.surfel_floor_m);
  app.add_flag("-v", verbose);
  app.add_option("--every", every);
  CLI11_PARSE(app, argc, argv);
  if (worlds.empty())
    worlds = {"/work/shared/data/laser/living_s1", "/work/shared/data/laser/office_s1"};
  for (const std::string& name : worlds) {
    const LaserWorld world = ReadLaserWorld(name + ".world.txt");
    std::vector<Pose2> truth;
    for (const StampedPose& p : ReadTrajectory(name + ".truth.txt")) {
      const auto& q = p.world_from_camera.rotation;
      truth.push_back({p.world_from_camera.translation.x(), p.world_from_camera.translation.y(),
                       2 * std::atan2(q.z(), q.w())});
      truth.back().yaw_rad = WrapAngle(truth.back().yaw_rad);
    }
    double sum = 0, sum_ate = 0, worst = 0, fsum = 0, fate = 0, fworst = 0;
    for (int seed = first_seed; seed < first_seed + seeds; ++seed) {
      const auto odometry = DisturbOdometry(truth, odo, seed);
      SurfelMapCore map(surfel);
      std::vector<Pose2> est;
      Pose2 pose = odometry[0];
      GroupBuilder builder(joint);
      Eigen::Matrix3d cov = Eigen::Matrix3d::Zero();
      Eigen::Matrix3d q = Eigen::Vector3d(qx * qx, qy * qy, qyaw * qyaw).asDiagonal();
      q *= qscale * qscale;
      double t_extract = 0, t_match = 0, t_insert = 0, t_group = 0, its = 0, npieces = 0;
      for (std::size_t k = 0; k < truth.size(); ++k) {
        const Scan scan = ScanFrom(
            DisturbScan(CastScan(world, truth[k], laser), laser, seed, static_cast<int>(k)), laser);
        if (k > 0) {
          const Pose2 u = Between(odometry[k - 1], odometry[k]);
          pose = pose * u;
          const Pose2 ui = Inverse(u);
          Eigen::Matrix3d ad;  // motion in old base axes to new base axes
          const double c = std::cos(ui.yaw_rad), s = std::sin(ui.yaw_rad);
          ad << c, -s, ui.y_m, s, c, -ui.x_m, 0, 0, 1;
          cov = ad * cov * ad.transpose() + q;
        }
        double t0 = NowUs();
        const auto& pieces = map.Extract(scan);
        double t1 = NowUs();
        t_extract += t1 - t0;
        npieces += static_cast<double>(pieces.size());
        if (k > 0) {
          const SurfelMatch m = map.Match(pieces, pose, cov + 1e-12 * Eigen::Matrix3d::Identity());
          its += m.iterations;
          if (m.found) {
            cov = ((cov + 1e-12 * Eigen::Matrix3d::Identity()).inverse() + m.information).inverse();
            pose = m.map_from_base;
          }
          if (verbose && k % every == 0) {
            const Pose2 e = Between(truth[k], pose);
            std::printf(
                "%4zu err %.4f %.4f %.2fdeg  sig %.4f %.4f %.3f expl %.2f used %d of %zu chi2 %.2f "
                "it %d surfels %zu\n",
                k, e.x_m, e.y_m, DegFromRad(e.yaw_rad), std::sqrt(cov(0, 0)), std::sqrt(cov(1, 1)),
                DegFromRad(std::sqrt(cov(2, 2))), m.explained, m.used, pieces.size(),
                m.chi2 / m.used, m.iterations, map.store().surfels().size());
          }
        }
        double t2 = NowUs();
        t_match += t2 - t1;
        map.Insert(pieces, pose, static_cast<int>(k));
        t_insert += NowUs() - t2;
        t2 = NowUs();
        builder.Add(pieces, pose, odometry[k], true);
        t_group += NowUs() - t2;
        est.push_back(pose);
      }
      const double tj = NowUs();
      const auto& groups = builder.Groups();
      const JointResult jr = AdjustJointly(groups, joint);
      const double t_joint = NowUs() - tj;
      std::vector<Pose2> fin;
      for (std::size_t k = 0; k < est.size(); ++k) {
        fin.push_back(jr.map_from_group[builder.group_of_frame()[k]] *
                      builder.group_from_frame()[k]);
      }
      const Scores fi = Score(truth, fin);
      const Scores on = Score(truth, est);
      const Scores pr = Score(truth, odometry);
      const double n = static_cast<double>(truth.size());
      std::printf(
          "%-10s seed %d prior %.3f/%.3f online %.4f/%.4f max %.3f final %.4f/%.4f max %.3f odo "
          "%.2f %.2f %.3f | groups %zu lm %d obs %d joint us %.0f group %.0f | us extract %.1f "
          "match %.1f insert %.1f its %.1f pieces %.1f surfels %zu\n",
          name.substr(name.rfind('/') + 1).c_str(), seed, pr.mean, pr.ate, on.mean, on.ate, on.max,
          fi.mean, fi.ate, fi.max, 1e3 * jr.odometry_sigma[0], 1e3 * jr.odometry_sigma[1],
          DegFromRad(jr.odometry_sigma[2]), groups.size(), jr.landmarks, jr.observations,
          t_joint / n, t_group / n, t_extract / n, t_match / n, t_insert / n, its / n, npieces / n,
          map.store().surfels().size());
      sum += on.mean / seeds;
      sum_ate += on.ate / seeds;
      worst = std::max(worst, on.mean);
      fsum += fi.mean / seeds;
      fate += fi.ate / seeds;
      fworst = std::max(fworst, fi.mean);
    }
    std::printf("%-10s MEAN online %.4f/%.4f worst %.4f final %.4f/%.4f worst %.4f\n",
                name.substr(name.rfind('/') + 1).c_str(), sum, sum_ate, worst, fsum, fate, fworst);
  }
}
