#include "eval/run/depth_cache.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <set>
#include <string_view>
#include <thread>
#include <tuple>
#include <vector>

#include "eval/files/hash.h"
#include "mapper/core/error.h"
#include "mapper/io/end_task.h"
#include "mapper/io/file.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

// Incremented whenever the depth camera may give different bits for the same input, or the layout
// below changes.
constexpr std::uint32_t kFormat = 1;
constexpr std::uint32_t kMagic = 0x43474444;  // "DDGC"
constexpr const char* kExtension = ".depth";
constexpr std::string_view kWithIncidence = "-incidence";

struct Header {
  std::uint32_t magic = kMagic;
  std::uint32_t format = kFormat;
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  std::uint64_t with_incidence = 0;
  std::uint64_t checksum = 0;
};

std::uint64_t ChecksumOf(const DepthFrame& frame) {
  ContentHash hash;
  hash.Array(std::span<const float>(frame.depth.z_m));
  hash.Array(std::span<const float>(frame.incidence_cos));
  return hash.value();
}

std::string KeyOf(const std::string& scene_hash, const PinholeCamera& camera, RayIsa isa) {
  ContentHash hash;
  hash.Text(DEPTHGRID_VERSION);
  hash.Text(DEPTHGRID_ARCH);
  hash.Value(kFormat);
  hash.Value(static_cast<int>(isa));
  hash.Text(scene_hash);
  hash.Value(camera.width_px);
  hash.Value(camera.height_px);
  for (const double v : {camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px}) hash.Value(v);
  return hash.Hex();
}

bool ReadInto(std::ifstream& file, void* data, std::size_t size) {
  return static_cast<bool>(file.read(static_cast<char*>(data), static_cast<std::streamsize>(size)));
}

template <typename T>
bool ReadInto(std::ifstream& file, std::vector<T>& values) {
  return ReadInto(file, values.data(), values.size() * sizeof(T));
}

struct Entry {
  fs::path path;
  fs::file_time_type used;
  std::uint64_t bytes = 0;
};

bool IsEntry(const fs::path& path) {
  if (path.extension() != kExtension) return false;
  std::string name = path.stem().string();
  if (name.ends_with(kWithIncidence)) name.resize(name.size() - kWithIncidence.size());
  return ContentHash::IsHex(name);
}

// PID-THREAD after an entry's name: an entry that is being written.
std::string EndingOfHalf() {
  const std::size_t thread = std::hash<std::thread::id>{}(std::this_thread::get_id());
  return "." + std::to_string(::getpid()) + "-" + std::to_string(thread);
}

bool IsHalf(const fs::path& path) {
  const std::string ending = path.extension().string();
  return ending.find('-') != std::string::npos &&
         ending.find_first_not_of("-0123456789", 1) == std::string::npos && IsEntry(path.stem());
}

// The files in the cache's folders. A folder that cannot be read is not this user's, and hides no
// other.
std::vector<fs::directory_entry> FilesIn(const fs::path& root) {
  std::vector<fs::directory_entry> files;
  std::error_code error;
  for (auto folder = fs::directory_iterator(root, error);
       !error && folder != fs::directory_iterator(); folder.increment(error)) {
    std::error_code unreadable;
    const bool is_own = ContentHash::IsHex(folder->path().filename().string()) &&
                        fs::is_directory(folder->symlink_status(unreadable));
    if (!is_own) continue;
    for (auto file = fs::directory_iterator(folder->path(), unreadable);
         !unreadable && file != fs::directory_iterator(); file.increment(unreadable)) {
      files.push_back(*file);
    }
  }
  return files;
}

// The user chose the folder and may keep other files with this extension in it (ICL-NUIM's have
// it): only files that a cache wrote may be removed.
std::vector<Entry> EntriesOf(const std::vector<fs::directory_entry>& files) {
  std::vector<Entry> entries;
  for (const fs::directory_entry& file : files) {
    if (!IsEntry(file.path())) continue;
    std::error_code vanished;  // another program may have removed it
    Entry entry{file.path(), file.last_write_time(vanished), file.file_size(vanished)};
    if (!vanished) entries.push_back(entry);
  }
  return entries;
}

// Files that killed programs did not finish. A program that is stopped for so long and continues
// does not find its file again and stores nothing.
void RemoveOldHalves(const std::vector<fs::directory_entry>& files) {
  constexpr auto kLongestWrite = std::chrono::hours(1);
  const auto latest = fs::file_time_type::clock::now() - kLongestWrite;
  for (const fs::directory_entry& file : files) {
    if (!IsHalf(file.path())) continue;
    std::error_code ignored;
    const auto written = file.last_write_time(ignored);
    if (!ignored && written < latest) fs::remove(file.path(), ignored);
  }
}

}  // namespace

void RefuseCache(const std::string& folder, const std::error_code& error) {
  const std::string why = "cannot be used as a cache: " + error.message();
  if (IsDiskFull(error.value())) throw DiskFullError(folder + ": " + why);
  throw InputError(folder, why);
}

DepthCache::DepthCache(const std::string& folder, const std::string& scene_hash,
                       const PinholeCamera& camera, RayIsa isa, std::uint64_t size_limit_bytes)
    : root_(folder),
      folder_(root_ / KeyOf(scene_hash, camera, isa)),
      width_px_(camera.width_px),
      height_px_(camera.height_px),
      size_limit_bytes_(size_limit_bytes) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) RefuseCache(folder, error);
  const std::vector<fs::directory_entry> files = FilesIn(root_);
  RemoveOldHalves(files);
  for (const Entry& entry : EntriesOf(files)) used_bytes_ += entry.bytes;
}

std::uint64_t DepthCache::BytesOf(bool with_incidence) const {
  const auto pixels =
      static_cast<std::uint64_t>(width_px_) * static_cast<std::uint64_t>(height_px_);
  return sizeof(Header) + sizeof(float) * pixels * (with_incidence ? 2 : 1);
}

fs::path DepthCache::EntryOf(const Pose3& world_from_camera, bool with_incidence) const {
  ContentHash hash;
  for (const double v : world_from_camera.rotation.coeffs()) hash.Value(v);
  for (const double v : world_from_camera.translation) hash.Value(v);
  return folder_ /
         fmt::format("{}{}{}", hash.Hex(), with_incidence ? kWithIncidence : "", kExtension);
}

void DepthCache::MakeRoomFor(const Trajectory& world_from_camera, bool with_incidence) {
  std::set<fs::path> missing;
  for (const StampedPose& pose : world_from_camera) {
    missing.insert(EntryOf(pose.world_from_camera, with_incidence));
  }
  // Frames that are already stored are neither removed nor need room.
  std::vector<Entry> entries = EntriesOf(FilesIn(root_));
  std::erase_if(entries, [&](const Entry& entry) { return missing.erase(entry.path) > 0; });
  const std::uint64_t wanted = missing.size() * BytesOf(with_incidence);
  // Entries of this scene and camera are removed last, because the next run likely needs them.
  std::sort(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) {
    const bool a_here = a.path.parent_path() == folder_;
    const bool b_here = b.path.parent_path() == folder_;
    return std::tie(a_here, a.used, a.path) < std::tie(b_here, b.used, b.path);
  });
  for (const Entry& entry : entries) {
    if (used_bytes_ + wanted <= size_limit_bytes_) return;
    std::error_code ignored;
    if (fs::remove(entry.path, ignored)) used_bytes_ -= entry.bytes;
    if (entry.path.parent_path() != folder_) fs::remove(entry.path.parent_path(), ignored);
  }
}

std::optional<DepthFrame> DepthCache::Load(const Pose3& world_from_camera,
                                           bool with_incidence) const {
  const fs::path path = EntryOf(world_from_camera, with_incidence);
  std::ifstream file(path, std::ios::binary);
  Header header;
  if (!file || !ReadInto(file, &header, sizeof header)) return std::nullopt;
  const bool fits = header.magic == kMagic && header.format == kFormat &&
                    header.width_px == static_cast<std::uint32_t>(width_px_) &&
                    header.height_px == static_cast<std::uint32_t>(height_px_) &&
                    header.with_incidence == (with_incidence ? 1U : 0U);
  if (!fits) return std::nullopt;
  DepthFrame frame;
  frame.depth = DepthImage(width_px_, height_px_);
  if (!ReadInto(file, frame.depth.z_m)) return std::nullopt;
  if (with_incidence) {
    frame.incidence_cos.resize(frame.depth.z_m.size());
    if (!ReadInto(file, frame.incidence_cos)) return std::nullopt;
  }
  if (ChecksumOf(frame) != header.checksum) return std::nullopt;
  std::error_code ignored;
  fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
  return frame;
}

void DepthCache::Store(const Pose3& world_from_camera, const DepthFrame& frame) const {
  const bool with_incidence = !frame.incidence_cos.empty();
  const std::uint64_t bytes = BytesOf(with_incidence);
  if (used_bytes_ + bytes > size_limit_bytes_) return;
  Header header;
  header.width_px = static_cast<std::uint32_t>(width_px_);
  header.height_px = static_cast<std::uint32_t>(height_px_);
  header.with_incidence = with_incidence ? 1 : 0;
  header.checksum = ChecksumOf(frame);
  const fs::path path = EntryOf(world_from_camera, with_incidence);
  // Written to a temporary file, then renamed, so that readers never see a partial file.
  const fs::path partial = path.string() + EndingOfHalf();
  const EndTask remove_half([&partial] {
    std::error_code ignored;
    fs::remove(partial, ignored);
  });
  std::ofstream file(partial, std::ios::binary);
  const auto write = [&](const void* data, std::size_t size) {
    file.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  };
  write(&header, sizeof header);
  write(frame.depth.z_m.data(), frame.depth.z_m.size() * sizeof(float));
  write(frame.incidence_cos.data(), frame.incidence_cos.size() * sizeof(float));
  file.close();
  std::error_code error;
  if (file) fs::rename(partial, path, error);
  if (file && !error) used_bytes_ += bytes;
}

}  // namespace depthgrid
