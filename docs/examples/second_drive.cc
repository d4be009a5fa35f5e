// Maps what a laser's driver gives with a robot's odometry and saves the map; a second drive, begun
// somewhere else, finds its place in it and goes on, and so does the program when it is started
// again on the way. Usage: second_drive FOLDER (to write)
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <limits>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "mapper/io/carmen_log.h"
#include "mapper/io/file.h"
#include "mapper/io/mapped_files.h"
#include "mapper/map_start.h"

using namespace depthgrid;

constexpr Pose2 kBaseFromLaser{.x_m = 0.2};  // 20 cm before the robot's axle
constexpr int kFrames = 250;
constexpr int kFramesToFindPlace = 120;  // 6 m of way
constexpr int kStopped = 180;            // frames of the second drive before the program stops

// Where the robot really is: it goes round an oval. A robot knows its odometry only.
Pose2 Truth(int step) {
  const double turn = 0.025 * step;
  return {2.6 * std::cos(turn), 1.8 * std::sin(turn),
          std::atan2(1.8 * std::cos(turn), -2.6 * std::sin(turn))};
}

struct Box {
  double left, bottom, right, top;
};
constexpr Box kRoom{-4.5, -3.5, 4.5, 3.5};
constexpr Box kFurniture[] = {
    {-1, -0.6, 0.8, 0.5}, {-4.5, 2, -3, 3.5}, {3.6, -3.5, 4.5, -1.5}, {1, 2.4, 4.5, 3.5}};

// How far along a ray one side of a box is, beyond which nothing of it is seen.
double ToSide(double from, double along, double side, double other_from, double other_along,
              double low, double high) {
  const double range = (side - from) / along;
  const double at = other_from + range * other_along;
  return range > 0.0 && at >= low && at <= high ? range : std::numeric_limits<double>::infinity();
}

double ToBox(const Pose2& from, double heading, const Box& box) {
  const double x = std::cos(heading), y = std::sin(heading);
  return std::min({ToSide(from.x_m, x, box.left, from.y_m, y, box.bottom, box.top),
                   ToSide(from.x_m, x, box.right, from.y_m, y, box.bottom, box.top),
                   ToSide(from.y_m, y, box.bottom, from.x_m, x, box.left, box.right),
                   ToSide(from.y_m, y, box.top, from.x_m, x, box.left, box.right)});
}

// What a driver gives, such as a LaserScan of ROS: ranges from right to left.
CarmenScan Readings(const Pose2& world_from_laser) {
  CarmenScan readings;
  readings.first_bearing_rad = -RadFromDeg(120.0);
  readings.bearing_step_rad = RadFromDeg(1.0);
  readings.max_range_m = 8.0;  // beyond it, nothing comes back
  for (int i = 0; i <= 240; ++i) {
    const double heading = world_from_laser.yaw_rad + RadFromDeg(i - 120.0);
    double range = ToBox(world_from_laser, heading, kRoom);
    for (const Box& box : kFurniture)
      range = std::min(range, ToBox(world_from_laser, heading, box));
    readings.range_m.push_back(range);
  }
  return readings;
}

// A drive of the robot: it begins at this step, and counts its odometry from there.
std::vector<Frame> Drive(int first_step) {
  std::vector<Frame> frames;
  Pose2 odom_from_base;
  for (int i = 0; i < kFrames; ++i) {
    if (i > 0) {
      const Pose2 driven = Between(Truth(first_step + i - 1), Truth(first_step + i));
      odom_from_base = odom_from_base * Pose2{1.02 * driven.x_m, driven.y_m, 0.99 * driven.yaw_rad};
    }
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 10.0;
    // ScanOf() knows what readings of nothing, glass and faults mean.
    frame.scan =
        std::make_shared<Scan>(ScanOf(Readings(Truth(first_step + i) * kBaseFromLaser), {}));
    // The mapper's `base` is where the scans are taken from: the laser. CameraOf() gives its pose
    // the axes of a camera, BaseOf() takes them off again.
    frame.slam_from_camera = CameraOf(odom_from_base * kBaseFromLaser);
    frames.push_back(frame);
  }
  return frames;
}

// What a program needs to go on with after a restart, if the odometry (or SLAM) ran on meanwhile.
void Save(const std::string& folder, const IncrementalMapper& mapper, const FrameReport& newest) {
  WriteMapped(folder, mapper.CurrentMapped());
  const Pose2& pose = newest.map_from_slam;  // of the same frame as the map
  // Whole or not at all, as the map: a power cut must not leave half a file.
  WriteFileToDisk(folder + "/map_from_slam.txt", [&pose](std::ostream& file) {
    file << std::setprecision(17) << pose.x_m << ' ' << pose.y_m << ' ' << pose.yaw_rad << '\n';
  });
}

// A full disk must not end a drive: the map that was saved before is still whole.
void SaveOrGoOn(const std::string& folder, const IncrementalMapper& mapper) {
  try {
    WriteMapped(folder, mapper.CurrentMapped());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "not saved: %s\n", error.what());
  }
}

PriorMap Saved(const std::string& folder) {
  PriorMap prior;
  prior.frames = ReadMapped(folder);
  std::ifstream file(folder + "/map_from_slam.txt");
  file >> prior.map_from_slam.x_m >> prior.map_from_slam.y_m >> prior.map_from_slam.yaw_rad;
  if (!file) throw InputError(folder + "/map_from_slam.txt", "must have three numbers");
  return prior;
}

int MapTwice(const std::string& folder) {
  const MapperOptions options;

  IncrementalMapper first(options, std::nullopt);
  for (const Frame& frame : Drive(0)) {
    first.AddFrame(frame);
    // Now and then, so that a flat battery does not cost the map.
    if (frame.index % 100 == 99) SaveOrGoOn(folder, first);
  }
  WriteMapped(folder, first.Finish().mapped);

  constexpr int kSecondBegin = 60;
  const std::vector<Frame> frames = Drive(kSecondBegin);
  PriorMap prior;
  prior.frames = ReadMapped(folder);
  const std::vector<Frame> seen(frames.begin(), frames.begin() + kFramesToFindPlace);
  const auto start = FindStart(prior, seen, std::nullopt, options);
  // Go on collecting, or ask somebody: FindStartNear() takes their word for it.
  if (!start || start->uncertain() || start->contradicted()) return 1;
  prior.map_from_slam = start->place.map_from_slam;
  IncrementalMapper second(options, std::nullopt);
  second.StartFrom(std::move(prior));
  FrameReport report;
  const auto stopped = frames.begin() + kStopped;
  for (auto frame = frames.begin(); frame != stopped; ++frame) report = second.AddFrame(*frame);
  Save(folder, second, report);

  // The program is started again. Were the odometry begun anew meanwhile, or the robot carried
  // off, its place would have to be found as above, or by FindStartNear() with its last pose.
  IncrementalMapper third(options, std::nullopt);
  third.StartFrom(Saved(folder));
  // Numbers of frames go on, as SLAM's loops may refer to those from before, which are left out.
  for (auto frame = stopped; frame != frames.end(); ++frame) report = third.AddFrame(*frame);

  // The map's frame is the first drive's odometry, which began at Truth(0).
  const Pose2 estimate = BaseOf(*report.map_from_camera) * Inverse(kBaseFromLaser);
  const Pose2 truth = Between(Truth(0), Truth(kSecondBegin + kFrames - 1));
  const double error_m = (estimate.translation() - truth.translation()).norm();
  std::printf("%s: %d scans; the second drive's last pose is %.1f mm off\n", folder.c_str(),
              static_cast<int>(third.Finish().mapped.size()), 1e3 * error_m);
  return error_m < 0.03 ? 0 : 1;
}

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : "";
  const bool asks = folder == "--help" || folder == "-h";
  if (argc != 2 || asks) {
    std::fprintf(asks ? stdout : stderr, "usage: second_drive FOLDER   (to write)\n");
    return asks ? 0 : 2;
  }
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) {
    std::fprintf(stderr, "%s: %s\n", folder.c_str(), failure.message().c_str());
    return 2;
  }
  try {
    return MapTwice(folder);
  } catch (const std::exception& error) {  // such as a full disk
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
