// Checks that time per frame stays constant and memory grows with the area seen. A laser walks
// through floors of 5 m to 200 m (square rooms of 5 m with doors and a cupboard each), up and down
// the rows and back. Also checks whether the mapper confuses these similar rooms.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <string>
#include <thread>

#include "bench/command_line.h"
#include "bench/guarded_main.h"
#include "bench/mapper_settings.h"
#include "mapper/core/cpu_clock.h"
#include "mapper/core/level.h"
#include "mapper/core/median.h"
#include "mapper/incremental_mapper.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

constexpr double kRoomM = 5.0;
constexpr double kDoorM = 1.2;
constexpr double kStepM = 0.04;            // per frame: 1.2 m/s at 30 Hz
constexpr double kWrongM = 0.5;            // a loop that is off by more is false
constexpr double kTurnRad = kPi / 2 / 30;  // a frame
constexpr double kPhaseOfSeed = 2.4;       // initial phase of the odometry's bias, radians

// Current resident memory, not the peak, which may be from the previous floor.
double ResidentMib() {
  std::ifstream file("/proc/self/statm");
  double pages = 0.0;
  file >> pages >> pages;
  return pages * 4096.0 / (1 << 20);
}

// A side of a room: two parts with a door between them, or one wall at the border.
void AddSide(const Eigen::Vector2d& from, const Eigen::Vector2d& to, bool whole,
             PlanarWorld& world) {
  if (whole) {
    world.push_back({from, to});
    return;
  }
  const Eigen::Vector2d half_door = 0.5 * kDoorM * (to - from).normalized();
  const Eigen::Vector2d middle = 0.5 * (from + to);
  world.push_back({from, middle - half_door});
  world.push_back({middle + half_door, to});
}

struct Floor {
  int columns = 1;
  int rows = 1;
  std::uint32_t seed = 1;
};

// The walls of the rooms around a place: 10 m in every direction.
PlanarWorld WallsAround(const Eigen::Vector2d& place_m, const Floor& floor) {
  PlanarWorld world;
  const Cell here = CellOf(place_m, kRoomM);
  for (int y = std::max(here.y - 2, 0); y <= std::min(here.y + 2, floor.rows - 1); ++y) {
    for (int x = std::max(here.x - 2, 0); x <= std::min(here.x + 2, floor.columns - 1); ++x) {
      const Eigen::Vector2d low(kRoomM * x, kRoomM * y), high(low.x() + kRoomM, low.y() + kRoomM);
      AddSide(low, {high.x(), low.y()}, y == 0, world);
      AddSide(low, {low.x(), high.y()}, x == 0, world);
      if (y == floor.rows - 1) AddSide({low.x(), high.y()}, high, true, world);
      if (x == floor.columns - 1) AddSide({high.x(), low.y()}, high, true, world);
      // A cupboard in a corner that differs from room to room.
      RandomStream random(floor.seed, RandomStage::kTest,
                          static_cast<std::uint32_t>(y * floor.columns + x));
      const double side = random.Uniform() < 0.5 ? 0.2 : 3.4;
      const Eigen::Vector2d corner = low + Eigen::Vector2d(side, random.Uniform(0.2, 1.0));
      const Eigen::Vector2d size(random.Uniform(0.4, 1.3), random.Uniform(0.3, 0.7));
      const PlanarWorld cupboard =
          RectangleWorld(corner.x(), corner.y(), corner.x() + size.x(), corner.y() + size.y());
      world.insert(world.end(), cupboard.begin(), cupboard.end());
    }
  }
  return world;
}

// Walks from room to room; turns on the spot.
class Walker {
 public:
  explicit Walker(const Floor& floor) {
    for (int y = 0; y < floor.rows; ++y) {
      for (int x = 0; x < floor.columns; ++x) {
        const int column = y % 2 == 0 ? x : floor.columns - 1 - x;
        stops_.emplace_back(kRoomM * (column + 0.5), kRoomM * (y + 0.5));
      }
    }
    for (std::size_t i = stops_.size(); i-- > 1;) stops_.push_back(stops_[i - 1]);
    pose_ = {stops_[0].x(), stops_[0].y(), 0.0};
  }
  Pose2 Next() {
    if (stops_.size() == 2) {  // turns on the spot endlessly
      pose_.yaw_rad = WrapAngle(pose_.yaw_rad + kTurnRad);
      return pose_;
    }
    const Eigen::Vector2d way = stops_[goal_] - pose_.translation();
    const double turn_rad = WrapAngle(std::atan2(way.y(), way.x()) - pose_.yaw_rad);
    if (way.norm() < kStepM) {
      pose_ = {stops_[goal_].x(), stops_[goal_].y(), pose_.yaw_rad};
      goal_ = (goal_ + 1) % stops_.size();
    } else if (std::abs(turn_rad) > kTurnRad) {
      pose_.yaw_rad = WrapAngle(pose_.yaw_rad + std::copysign(kTurnRad, turn_rad));
    } else {
      pose_ = {pose_.x_m + kStepM * way.normalized().x(), pose_.y_m + kStepM * way.normalized().y(),
               pose_.yaw_rad + turn_rad};
    }
    return pose_;
  }

 private:
  std::vector<Eigen::Vector2d> stops_;
  std::size_t goal_ = 1;
  Pose2 pose_;
};

struct Settings {
  MapperOptions mapper;
  bool finish = true;
  bool loops = false;  // list them
  int rows = 0;        // of rooms; 0: as many as columns
  std::uint32_t seed = 1;
  double drift = 1.0;
  double rate_hz = 0.0;  // at which frames come; 0: as fast as they are mapped
  PlanarLaser laser{
      .beams = 640, .field_of_view_rad = 0.0, .max_range_m = 6.0, .sigma_of_range = 0.01};
  double field_of_view_deg = 58.0;
};

double ErrorM(const Pose3& map_from_camera, const Pose2& truth) {
  return (BaseOf(map_from_camera).translation() - truth.translation()).norm();
}

struct JudgedLoop {
  int first = 0;  // frames
  int second = 0;
  double error_m = 0.0;
};

std::vector<JudgedLoop> JudgedLoops(const MapperResult& result, const std::vector<Pose2>& truths) {
  const auto frame_of = [&](int mapped) {
    return result.mapped[static_cast<std::size_t>(mapped)].frame;
  };
  std::vector<JudgedLoop> judged;
  for (const PlanarLoop& loop : result.loops) {
    const int first = frame_of(loop.first);
    const int second = frame_of(loop.second);
    const Pose2 truth =
        Between(truths[static_cast<std::size_t>(first)], truths[static_cast<std::size_t>(second)]);
    judged.push_back({first, second, Between(truth, loop.first_from_second).translation().norm()});
  }
  return judged;
}

// Peak resident memory.
double PeakMib() {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;) {
    double kib = 0.0;
    if (word == "VmHWM:" && file >> kib) return kib / 1024.0;
  }
  return 0.0;
}

// Sleeps until a sensor of this rate would have the k-th frame ready.
class Pace {
 public:
  explicit Pace(double rate_hz) : rate_hz_(rate_hz) {}
  void WaitFor(int k) const {
    if (rate_hz_ > 0.0) {
      std::this_thread::sleep_until(start_ + std::chrono::duration<double>(k / rate_hz_));
    }
  }

 private:
  double rate_hz_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

struct Walked {
  std::vector<Pose2> truths;
  std::vector<double> times_us;  // of each frame
  double mean_us = 0.0;
  double error_m = 0.0;  // of the online estimate, the mean
};

Walked Walk(const Floor& floor, int frames, const Settings& settings, IncrementalMapper& mapper) {
  Walker walker(floor);
  PlanarLaser laser = settings.laser;
  laser.field_of_view_rad = RadFromDeg(settings.field_of_view_deg);
  Walked walked;
  Pose2 odometry, last;
  const Pace pace(settings.rate_hz);
  for (int k = 0; k < frames; ++k) {
    const Pose2 truth = walker.Next();
    // Odometry with a slowly varying bias: 1 % of the distance, 0.1 degree per metre.
    const double swing = settings.drift * std::sin(k / 200.0 + kPhaseOfSeed * (floor.seed - 1));
    odometry =
        k == 0 ? truth
               : odometry * Between(last, truth) * Pose2{4e-4 * swing, 2e-4 * swing, 7e-5 * swing};
    last = truth;
    walked.truths.push_back(truth);
    Frame frame;
    frame.index = k;
    frame.stamp_s = k / 30.0;
    frame.scan =
        std::make_shared<const Scan>(ScanOf(WallsAround(truth.translation(), floor), truth, laser,
                                            floor.seed + 1, static_cast<std::uint32_t>(k)));
    frame.slam_from_camera = CameraOf(odometry, 0.0);
    pace.WaitFor(k);
    const FrameReport report = mapper.AddFrame(frame);
    walked.times_us.push_back(report.times.total_us);
    walked.mean_us += report.times.total_us;
    walked.error_m += ErrorM(*report.map_from_camera, truth);
  }
  walked.mean_us /= frames;
  walked.error_m /= frames;
  return walked;
}

void PrintWalk(double floor_m, const Walked& walked, double mib) {
  const auto frames = static_cast<double>(walked.times_us.size());
  const auto median_us = [&](double from, double to) {
    const auto at = [&](double share) {
      return walked.times_us.begin() + static_cast<std::ptrdiff_t>(share * frames);
    };
    return UpperMedian({at(from), at(to)});
  };
  std::printf("| %4.0f m | %6d | %5.0f | %5.0f | %5.0f | %6.0f | %6.1f | %7.1f | %7.3f |", floor_m,
              static_cast<int>(walked.times_us.size()), median_us(0.05, 0.15),
              median_us(0.45, 0.55), median_us(0.9, 1.0), walked.mean_us,
              *std::max_element(walked.times_us.begin(), walked.times_us.end()) * 1e-3, mib,
              walked.error_m);
  std::fflush(stdout);
}

// Returns the accepted loops.
std::vector<JudgedLoop> FinishAndPrint(const std::vector<Pose2>& truths, double before_mib,
                                       IncrementalMapper& mapper) {
  const double start_us = ThreadCpuUs();
  const MapperResult result = mapper.Finish();
  const double finish_us = ThreadCpuUs() - start_us;
  const auto frames = static_cast<double>(truths.size());
  double error_m = 0.0, scan_bytes = 0.0;
  for (std::size_t k = 0; k < truths.size(); ++k) {
    error_m += ErrorM(*result.map_from_camera[k], truths[k]);
  }
  for (const MappedFrame& frame : result.mapped) {
    const PackedScan packed = frame.scan.packed();
    scan_bytes += static_cast<double>(packed.values.size_bytes() + packed.codes.size_bytes());
  }
  std::vector<JudgedLoop> loops = JudgedLoops(result, truths);
  const auto wrong = std::count_if(loops.begin(), loops.end(),
                                   [](const JudgedLoop& loop) { return loop.error_m > kWrongM; });
  const auto kept = static_cast<double>(result.mapped.size());
  std::printf(" %7.0f | %7.3f | %6.0f | %6.0f | %7.1f | %d, %d |", finish_us / frames,
              error_m / frames, kept, scan_bytes / kept, PeakMib() - before_mib,
              static_cast<int>(loops.size()), static_cast<int>(wrong));
  return loops;
}

// Prints a row of the table.
void MeasureFloor(double floor_m, int frames, const Settings& settings) {
  const int columns = static_cast<int>(std::lround(floor_m / kRoomM));
  const Floor floor{columns, settings.rows > 0 ? settings.rows : columns, settings.seed};
  const double before_mib = ResidentMib();
  IncrementalMapper mapper(settings.mapper, std::nullopt, {ThreadCpuUs, SteadyUs});
  const Walked walked = Walk(floor, frames, settings, mapper);
  PrintWalk(floor_m, walked, ResidentMib() - before_mib);
  std::vector<JudgedLoop> loops;
  if (settings.finish) loops = FinishAndPrint(walked.truths, before_mib, mapper);
  std::printf("\n");
  if (settings.loops) {
    for (const JudgedLoop& loop : loops) {
      std::printf("frame %d seen from %d: off by %.2f m\n", loop.first, loop.second, loop.error_m);
    }
  }
  std::fflush(stdout);
}

}  // namespace
}  // namespace depthgrid

namespace {
using depthgrid::FromTo;

// If only one of them is given, the first defaults of the other are used.
void RequireAsMany(const CLI::App& app, std::size_t floors, std::size_t frames) {
  const bool too_few = app.count("--floors") > 0 && frames < floors;
  const bool too_many = app.count("--frames") > 0 && frames > floors;
  if (!too_few && !too_many) return;
  throw depthgrid::InputError(
      "--frames", "are " + std::to_string(frames) + ", for " + std::to_string(floors) + " floors");
}

int Measure(int argc, char** argv) {
  depthgrid::Settings settings;
  bool no_finish = false;
  std::vector<std::string> sets;
  std::vector<double> floors = {5, 20, 50, 100, 200};
  std::vector<int> frames = {1000, 5000, 20000, 50000, 100000};
  CLI::App app("Time a frame and memory over floors of growing size");
  app.add_option("--floors", floors, "side lengths, metres")->check(FromTo(5, 5000));
  app.add_option("--frames", frames, "of each")->check(FromTo(10, 1e7));
  app.add_flag("--no-finish", no_finish, "without the final adjustment and map");
  app.add_flag("--loops", settings.loops, "list the loops that were taken");
  app.add_option("--rows", settings.rows, "of rooms; 0: a square floor")->check(FromTo(0, 1000));
  app.add_option("--seed", settings.seed, "of cupboards, noise and odometry")
      ->check(FromTo(1, 1e9));
  app.add_option("--drift", settings.drift, "of the odometry: 1 is 1 % and 0.1 degree a metre")
      ->check(FromTo(0, 100));
  app.add_option("--rate", settings.rate_hz, "frames a second; 0: as fast as they are mapped")
      ->check(FromTo(0, 1e4));
  app.add_option("--noise", settings.laser.sigma_of_range, "of ranges, as a share")
      ->check(FromTo(0, 1));
  app.add_option("--beams", settings.laser.beams, "of a scan")->check(FromTo(2, 100000));
  app.add_option("--fov", settings.field_of_view_deg, "degrees that they spread over")
      ->check(FromTo(1, 360));
  app.add_option("--max-range", settings.laser.max_range_m, "metres")->check(FromTo(0.5, 10));
  app.add_option("--set", sets, "KEY=VALUE of the mapper's settings, such as method=paper");
  if (!depthgrid::ReadCommandLine(app, argc, argv)) return 0;
  RequireAsMany(app, floors.size(), frames.size());
  settings.mapper = depthgrid::MapperWith(sets);
  settings.finish = !no_finish;
  std::printf(
      "| floor | frames | us/frame, first | middle | last tenth | mean | worst ms | MiB | online "
      "error m |%s\n",
      settings.finish
          ? " finish us/frame | final error m | scans kept | bytes/scan | peak MiB | loops, wrong |"
          : "");
  std::printf("|--:|--:|--:|--:|--:|--:|--:|--:|--:|%s\n",
              settings.finish ? "--:|--:|--:|--:|--:|--:|" : "");
  for (std::size_t i = 0; i < std::min(floors.size(), frames.size()); ++i) {
    depthgrid::MeasureFloor(floors[i], frames[i], settings);
  }
  return 0;
}
}  // namespace

int main(int argc, char** argv) { return depthgrid::GuardedMain(Measure, argc, argv); }
