#include "mapper/io/camera_mount.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/io/camera_values.h"
#include "mapper/io/file.h"
#include "mapper/io/matrix_poses.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

// Larger than any robot for such maps; exceeded by values in millimetres.
constexpr double kFarthestCameraM = 10.0;

struct MountKey {
  const char* name;
  bool camera_from_body;
};
constexpr MountKey kMountKeys[] = {{"T_BS", false},       {"T_cam_imu", true},
                                   {"T_imu_cam", false},  {"body_T_cam0", false},
                                   {"IMU.T_b_c1", false}, {"Tbc", false}};

struct StatedMount {
  MountKey key;
  ConfigEntry entry;
  std::string group = {};  // "cam0.", of the first of several cameras
};

std::optional<StatedMount> MountAmong(const Config& config) {
  const std::vector<ConfigEntry> entries = config.Entries();
  for (const MountKey& key : kMountKeys) {
    const auto found = std::find_if(entries.begin(), entries.end(), [&](const ConfigEntry& entry) {
      return entry.key == key.name;
    });
    if (found != entries.end()) return StatedMount{key, *found};
  }
  return {};
}

// A chain of cameras has a group for each.
std::optional<StatedMount> FindMount(Config& config) {
  if (!config.Has("cam0")) return MountAmong(config);
  auto stated = MountAmong(config.Take("cam0"));
  if (stated) stated->group = "cam0.";
  return stated;
}

// Rows of numbers, [[1, 0, 0, 0], ...], as one list.
std::vector<std::string> Flattened(const std::vector<std::string>& items) {
  std::vector<std::string> numbers;
  for (std::string item : items) {
    std::replace_if(
        item.begin(), item.end(), [](char c) { return c == '[' || c == ']' || c == ','; }, ' ');
    for (const TextRow& row : SplitRows(item)) {
      numbers.insert(numbers.end(), row.fields.begin(), row.fields.end());
    }
  }
  return numbers;
}

// A list of rows, or OpenCV's and EuRoC's group of `rows`, `cols` and `data`.
std::vector<double> MatrixIn(const ConfigEntry& entry) {
  if (entry.map && !entry.map->Has("data")) {
    throw InputError(entry.place, fmt::format("key '{}.data' is missing", entry.key));
  }
  const std::vector<std::string> items =
      entry.map ? entry.map->List("data") : entry.items.value_or(std::vector{entry.text});
  const std::vector<double> numbers = NumbersOf(Flattened(items), entry.key, entry.place);
  if (numbers.size() == 12 || numbers.size() == 16) return numbers;
  throw InputError(entry.place, fmt::format("'{}' has {}, must have the 16 of a 4x4 matrix",
                                            entry.key, Counted(numbers.size(), "number")));
}

Pose3 Checked(const Pose3& body_from_camera, const std::string& place) {
  const double away_m = body_from_camera.translation.norm();
  if (away_m <= kFarthestCameraM) return body_from_camera;
  throw InputError(place, fmt::format("the camera is {:g} m from the body, must be at most {:g}: "
                                      "positions are in metres",
                                      away_m, kFarthestCameraM));
}

CameraMount MountOfMatrix(const std::string& text, const std::string& place) {
  const auto pose = ParseMatrixPose(text, place);
  if (!pose) throw InputError(place, "the matrix must be finite and a rigid motion");
  return {Checked(*pose, place), place};
}

}  // namespace

CameraMount ParseCameraMount(const std::string& text, const std::string& place) {
  if (BeginsWithNumber(text)) return MountOfMatrix(text, place);
  Config config = ConfigOfOthers(text, place);
  const std::string sensor = config.Text("sensor_type", "camera");
  if (sensor != "camera") {  // EuRoC's file of each sensor has a T_BS
    throw InputError(config.PlaceOfKey("sensor_type"),
                     fmt::format("sensor_type is {}, must be camera", sensor));
  }
  const auto stated = FindMount(config);
  if (!stated) {
    throw InputError(place,
                     "does not say where the camera is on the body, must hold a 4x4 matrix: alone "
                     "or as T_BS, T_cam_imu, T_imu_cam, body_T_cam0, IMU.T_b_c1 or Tbc");
  }
  const Pose3 pose = RigidMotionOf(MatrixIn(stated->entry), stated->entry.place);
  return {Checked(stated->key.camera_from_body ? Inverse(pose) : pose, stated->entry.place),
          fmt::format("{} ({}{})", place, stated->group, stated->key.name)};
}

CameraMount ReadCameraMount(const std::string& path) {
  return ParseCameraMount(ReadTextFile(path), path);
}

std::string MountKeyIn(Config config) {
  const auto stated = FindMount(config);
  return stated ? stated->group + stated->key.name : "";
}

std::string Said(const CameraMount& mount) {
  const Eigen::Vector3d& at_m = mount.body_from_camera.translation;
  const Eigen::Vector3d ahead = mount.body_from_camera.rotation * Eigen::Vector3d::UnitZ();
  return fmt::format(
      "poses are a body's, the camera is at ({:.3f}, {:.3f}, {:.3f}) m in its axes, looking along "
      "({:.2f}, {:.2f}, {:.2f}), as {} says",
      at_m.x(), at_m.y(), at_m.z(), ahead.x(), ahead.y(), ahead.z(), mount.stated_as);
}

Pose3 OnBody(const Pose3& world_from_body, const CameraMount& mount) {
  return world_from_body * mount.body_from_camera;
}

Trajectory OnBody(Trajectory poses, const CameraMount& mount) {
  for (StampedPose& pose : poses) pose.world_from_camera = OnBody(pose.world_from_camera, mount);
  return poses;
}

SlamOutput OnBody(SlamOutput slam, const CameraMount& mount) {
  for (SlamPose& pose : slam.live) {
    if (pose.slam_from_camera) pose.slam_from_camera = OnBody(*pose.slam_from_camera, mount);
  }
  slam.final = OnBody(std::move(slam.final), mount);
  for (LoopClosure& loop : slam.loops) {
    loop.first_from_second =
        Inverse(mount.body_from_camera) * OnBody(loop.first_from_second, mount);
  }
  return slam;
}

}  // namespace depthgrid
