#include "eval/sweep/scan_cache.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <tuple>

#include "eval/files/hash.h"
#include "eval/run/depth_cache.h"
#include "mapper/core/error.h"
#include "mapper/io/file.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScansExtension = ".scans";
constexpr std::uint32_t kScansMagic = 0x32534744;  // "DGS2"
constexpr int kNumbersABeam = 5;

// Concatenates values in this machine's own layout; the key contains the instruction set.
class ByteWriter {
 public:
  template <typename T>
  void Put(T value) {
    const auto at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(bytes_.data() + at, &value, sizeof value);
  }
  void Put(const std::shared_ptr<const Scan>& scan) {
    Put<std::int32_t>(scan ? static_cast<std::int32_t>(scan->beams.size()) : -1);
    if (!scan) return;
    Put(scan->max_range_m);
    for (const Beam& beam : scan->beams) {
      Put(std::array<float, kNumbersABeam>{beam.bearing_rad, beam.range_m, beam.clear_from_m,
                                           beam.clear_to_m, beam.hit ? 1.0F : 0.0F});
    }
  }
  void Put(const std::optional<CameraStand>& stand) {
    Put<std::uint8_t>(stand ? 1 : 0);
    if (!stand) return;
    for (const double v : stand->level_from_camera.coeffs()) Put(v);
    Put(stand->height_m);
  }
  std::string Take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

// Throws InputError at the end of the bytes.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <typename T>
  T Get() {
    if (bytes_.size() < sizeof(T)) throw InputError("", "truncated");
    T value;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_.remove_prefix(sizeof value);
    return value;
  }
  std::shared_ptr<const Scan> GetScan() {
    const auto count = Get<std::int32_t>();
    if (count < 0) return nullptr;
    auto scan = std::make_shared<Scan>();
    scan->max_range_m = Get<double>();
    scan->beams.resize(static_cast<std::size_t>(count));
    for (Beam& beam : scan->beams) {
      const auto numbers = Get<std::array<float, kNumbersABeam>>();
      beam = {numbers[0], numbers[1], numbers[2], numbers[3], numbers[4] != 0.0F};
    }
    return scan;
  }
  std::optional<CameraStand> GetStand() {
    if (Get<std::uint8_t>() == 0) return std::nullopt;
    CameraStand stand;
    for (double& v : stand.level_from_camera.coeffs()) v = Get<double>();
    stand.height_m = Get<double>();
    return stand;
  }

 private:
  std::string_view bytes_;
};

std::uint64_t ChecksumOf(std::string_view bytes) {
  ContentHash hash;
  hash.Text(bytes);
  return hash.value();
}

bool IsScans(const fs::path& file) {
  return file.extension() == kScansExtension && ContentHash::IsHex(file.stem().string());
}

}  // namespace

ScanCache::ScanCache(const std::string& folder, std::uint64_t size_limit_bytes)
    : folder_(folder), size_limit_bytes_(size_limit_bytes) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) RefuseCache(folder, error);
  RemoveHalves(folder, IsScans);
}

fs::path ScanCache::PathOf(const std::string& key) const {
  return folder_ / (key + kScansExtension);
}

std::optional<std::vector<FrameScans>> ScanCache::Load(const std::string& key) const {
  const fs::path path = PathOf(key);
  if (!fs::exists(path)) return std::nullopt;
  try {
    const std::string bytes = ReadFile(path.string(), size_limit_bytes_);
    ByteReader header(bytes);
    if (header.Get<std::uint32_t>() != kScansMagic) return std::nullopt;
    const auto checksum = header.Get<std::uint64_t>();
    const auto content = std::string_view(bytes).substr(sizeof(std::uint32_t) + sizeof checksum);
    if (ChecksumOf(content) != checksum) return std::nullopt;
    ByteReader reader(content);
    std::vector<FrameScans> scans;
    for (auto count = reader.Get<std::uint64_t>(); count > 0; --count) {
      FrameScans& frame = scans.emplace_back();
      frame.obstacles = reader.GetScan();
      const bool same = reader.Get<std::uint8_t>() != 0;
      frame.matched = same ? frame.obstacles : reader.GetScan();
      frame.stand = reader.GetStand();
    }
    std::error_code ignored;
    fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
    return scans;
  } catch (const InputError&) {  // truncated, or removed meanwhile
    return std::nullopt;
  }
}

void ScanCache::Store(const std::string& key, const std::vector<FrameScans>& scans) const {
  ByteWriter content;
  content.Put<std::uint64_t>(scans.size());
  for (const FrameScans& frame : scans) {
    const bool same = frame.matched == frame.obstacles;
    content.Put(frame.obstacles);
    content.Put<std::uint8_t>(same ? 1 : 0);
    if (!same) content.Put(frame.matched);
    content.Put(frame.stand);
  }
  const std::string bytes = content.Take();
  ByteWriter file;
  file.Put(kScansMagic);
  file.Put(ChecksumOf(bytes));
  const std::string whole = file.Take() + bytes;
  if (whole.size() > size_limit_bytes_) return;
  MakeRoom(whole.size());
  try {
    WriteFile(PathOf(key).string(), whole);
  } catch (const std::runtime_error&) {  // the disk is full or read-only
  }
}

void ScanCache::MakeRoom(std::uint64_t bytes) const {
  struct Entry {
    fs::file_time_type used;
    fs::path path;
    std::uint64_t bytes = 0;
  };
  std::vector<Entry> entries;
  std::error_code error;
  std::uint64_t total = bytes;
  for (auto it = fs::directory_iterator(folder_, error); !error && it != fs::directory_iterator();
       it.increment(error)) {
    std::error_code vanished;            // another program may have removed it
    if (!IsScans(it->path())) continue;  // not written by a cache
    Entry entry{it->last_write_time(vanished), it->path(), it->file_size(vanished)};
    if (vanished) continue;
    total += entry.bytes;
    entries.push_back(std::move(entry));
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.used, a.path) < std::tie(b.used, b.path);
  });
  for (const Entry& entry : entries) {
    if (total <= size_limit_bytes_) return;
    std::error_code ignored;
    if (fs::remove(entry.path, ignored)) total -= entry.bytes;
  }
}

}  // namespace depthgrid
