// Maps what a depth camera on a robot sees with the poses that SLAM gives, its corrections and its
// loops, and writes the map for Nav2. Usage: depth_mapper FOLDER (to write)
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "mapper/io/map_file.h"
#include "mapper/io/trajectory_file.h"

using namespace depthgrid;

constexpr int kFrames = 330;  // a turn on the spot and a little more
constexpr int kLoopFrame = 300;
constexpr int kTornFrame = 100;  // of which the driver brings half an image
const PinholeCamera kCamera{
    .width_px = 160, .height_px = 120, .fx_px = 140, .fy_px = 140, .cx_px = 79.5, .cy_px = 59.5};

// SLAM's world is its first camera: x right, y down, z forward. The mapper's has z up, so the
// camera's mounting must be known: here 0.6 m above the floor, looking 10 degrees down. (Where it
// is not, GravityFinder in mapper/io/gravity.h finds the floor in the first images.)
const Pose3 kLookingDown{
    Eigen::Quaterniond(Eigen::AngleAxisd(-RadFromDeg(10.0), Eigen::Vector3d::UnitX())),
    Eigen::Vector3d::Zero()};
const Pose3 kWorldFromFirst = CameraOf(Pose2{}, 0.6) * kLookingDown;

// Where the camera really is. A robot knows only what SLAM says.
Pose3 Truth(int frame) {
  return CameraOf({0.0, 0.0, WrapAngle(RadFromDeg(1.2) * frame)}, 0.6) * kLookingDown;
}

// It drifts, until it sees where it began and corrects itself.
Pose3 PoseOfSlam(int frame) {
  Pose3 first_from_camera = Inverse(kWorldFromFirst) * Truth(frame);
  if (frame < kLoopFrame) first_from_camera.translation.x() += 0.0005 * frame;
  return first_from_camera;
}

// A room of 5 x 4 m: a driver's image, in metres along the optical axis.
DepthImage Look(const Pose3& world_from_camera) {
  DepthImage image(kCamera.width_px, kCamera.height_px);
  const Eigen::Vector3d& at = world_from_camera.translation;
  for (int v = 0; v < image.height_px; ++v) {
    for (int u = 0; u < image.width_px; ++u) {
      const Eigen::Vector3d ray = world_from_camera.rotation * Unproject(kCamera, u, v, 1.0);
      const double to_x = (std::copysign(2.5, ray.x()) - at.x()) / ray.x();
      const double to_y = (std::copysign(2.0, ray.y()) - at.y()) / ray.y();
      const double to_floor =
          ray.z() < 0.0 ? -at.z() / ray.z() : std::numeric_limits<double>::infinity();
      image.Row(v)[u] = static_cast<float>(std::min({to_x, to_y, to_floor}));
    }
  }
  return image;
}

int MapRoom(const std::filesystem::path& folder) {
  MapperOptions options;
  options.scan.beams = kCamera.width_px;  // not more than there are columns
  options.scan.min_range_m = 0.3;
  IncrementalMapper mapper(options, kCamera);
  std::vector<double> stamps_s;  // of the frames that it took: the result has a pose for each
  for (int i = 0; i < kFrames; ++i) {
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    const auto image = std::make_shared<DepthImage>(Look(Truth(i)));
    if (i == kTornFrame) image->z_m.resize(image->z_m.size() / 2);
    frame.depth = image;
    frame.slam_from_camera = kWorldFromFirst * PoseOfSlam(i);
    // Poses before and after a correction of SLAM are no motion: without another number the jump
    // would be taken for one.
    frame.slam_epoch = i < kLoopFrame ? 0 : 1;
    if (i == kLoopFrame) {
      LoopClosure loop;
      loop.reported_at_frame = loop.second_frame = i;
      loop.first_frame = 0;
      loop.first_from_second = Between(PoseOfSlam(0), PoseOfSlam(i));
      frame.loops.push_back(loop);
    }
    try {
      const FrameReport report = mapper.AddFrame(frame);
      stamps_s.push_back(frame.stamp_s);
      if (report.loops_accepted > 0) std::printf("frame %d: loop taken\n", i);
    } catch (const InputError& error) {
      std::fprintf(stderr, "left out: %s\n", error.what());
    }
  }
  const MapperResult result = mapper.Finish();
  Trajectory trajectory;
  for (std::size_t i = 0; i < stamps_s.size(); ++i) {
    const auto& pose = result.map_from_camera.at(i);
    if (pose) trajectory.push_back({stamps_s[i], *pose});
  }
  if (trajectory.empty()) return 1;  // nothing was mapped: no map to write
  WriteMap((folder / "map.yaml").string(), result.map);
  WriteTrajectory((folder / "trajectory.txt").string(), trajectory);
  const double error_m =
      (trajectory.back().world_from_camera.translation - Truth(kFrames - 1).translation).norm();
  std::printf("%s: %d x %d cells; the last pose is %.1f mm off\n", folder.c_str(),
              result.map.geometry.width_cells, result.map.geometry.height_cells, 1e3 * error_m);
  return error_m < 0.02 ? 0 : 1;
}

int main(int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  const bool asks = first == "--help" || first == "-h";
  if (argc != 2 || asks) {
    std::fprintf(asks ? stdout : stderr, "usage: depth_mapper FOLDER   (to write)\n");
    return asks ? 0 : 2;
  }
  const std::filesystem::path folder = first;
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) {
    std::fprintf(stderr, "%s: %s\n", folder.c_str(), failure.message().c_str());
    return 2;
  }
  try {
    return MapRoom(folder);
  } catch (const std::exception& error) {  // such as a full disk
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
