#include "mapper/io/scan_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <span>

#include "mapper/core/error.h"
#include "mapper/core/frame.h"
#include "mapper/io/file.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little,
              "scans.bin is written as it lies in memory");

constexpr std::string_view kMagic = "DGSCANS2";

template <typename T>
void Append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <typename T>
void AppendAll(std::string& bytes, std::span<const T> values) {
  if (values.empty()) return;
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

// Reads a file in pieces, as a long run's scans are many MB.
class Reader {
 public:
  explicit Reader(std::string path) : path_(std::move(path)) {
    RequireFile(path_);
    std::error_code error;
    rest_ = fs::file_size(path_, error);
    if (error) Fail("cannot be read: " + error.message());
    stream_.open(path_, std::ios::binary);
    if (!stream_) Fail("cannot be read");
  }

  template <typename T>
  T Take() {
    T value;
    TakeBytes(&value, sizeof value);
    return value;
  }
  template <typename T>
  void TakeAll(std::uint32_t count, std::vector<T>& values) {
    RequireRoom(count, sizeof(T));
    values.resize(count);
    TakeBytes(values.data(), count * sizeof(T));
  }
  void RequireMagic() {
    std::string magic(std::min<std::uintmax_t>(rest_, kMagic.size()), '\0');
    TakeBytes(magic.data(), magic.size());
    if (magic != kMagic) Fail("holds no stored scans (scans.bin)");
  }
  // Call before allocating `count` items that take at least `bytes_each` in the file.
  void RequireRoom(std::uint32_t count, std::size_t bytes_each) const {
    if (rest_ / bytes_each < count) Fail("is truncated");
  }
  [[noreturn]] void Fail(const std::string& message) const { throw InputError(path_, message); }
  bool empty() const { return rest_ == 0; }

 private:
  void TakeBytes(void* to, std::size_t count) {
    if (rest_ < count) Fail("is truncated");
    if (!stream_.read(static_cast<char*>(to), static_cast<std::streamsize>(count))) {
      Fail("cannot be read");
    }
    rest_ -= count;
  }

  std::string path_;
  std::ifstream stream_;
  std::uintmax_t rest_ = 0;  // bytes
};

// Size of a stored scan without its beams.
constexpr std::size_t kScanBytes = 3 * sizeof(std::uint32_t) + 5 * sizeof(double) + 1;

// Reads scans in order; repeated bearings are shared.
class ScanTaker {
 public:
  StoredScan Take(Reader& reader) {
    StoredScan stored;
    stored.frame = reader.Take<std::int32_t>();
    const auto beams = reader.Take<std::uint32_t>();
    const auto values = reader.Take<std::uint32_t>();
    stored.stamp_s = reader.Take<double>();
    stored.map_from_base.x_m = reader.Take<double>();
    stored.map_from_base.y_m = reader.Take<double>();
    stored.map_from_base.yaw_rad = reader.Take<double>();
    const auto max_range_m = reader.Take<double>();
    if (reader.Take<std::uint8_t>() != 0) reader.TakeAll(beams, bearings_rad_);
    reader.TakeAll(values, values_);
    reader.TakeAll(beams, codes_);
    const PackedScan packed{max_range_m, bearings_rad_, codes_, values_};
    if (!IsWhole(packed)) reader.Fail("holds a damaged scan");
    const Scan scan = Unpacked(packed);
    RequirePossible(reader, stored, scan);
    stored.scan = archive_.Keep(scan);
    return stored;
  }

 private:
  static void RequirePossible(const Reader& reader, const StoredScan& stored, const Scan& scan) {
    const auto require = [&](bool possible, const char* what) {
      if (possible) return;
      reader.Fail(fmt::format("the scan of frame {} has {}", stored.frame, what));
    };
    require(std::abs(stored.stamp_s) <= kLatestStampS, "a stamp that is no time in seconds");
    require(IsOnAMap(stored.map_from_base), "a pose that is not finite or beyond 10,500 km");
    require(scan.max_range_m >= 0.0 && std::isfinite(scan.max_range_m),
            "a range limit that is not finite or below 0");
    require(std::all_of(scan.beams.begin(), scan.beams.end(), CanBeKept),
            "a beam that is not finite or beyond 1 km");
  }

  ScanArchive archive_;
  std::vector<float> bearings_rad_;
  std::vector<float> values_;
  std::vector<std::uint8_t> codes_;
};

void AppendScan(std::string& bytes, const StoredScan& stored, bool own_bearings) {
  const PackedScan packed = stored.scan.packed();
  Append(bytes, static_cast<std::int32_t>(stored.frame));
  Append(bytes, static_cast<std::uint32_t>(packed.codes.size()));
  Append(bytes, static_cast<std::uint32_t>(packed.values.size()));
  Append(bytes, stored.stamp_s);
  Append(bytes, stored.map_from_base.x_m);
  Append(bytes, stored.map_from_base.y_m);
  Append(bytes, stored.map_from_base.yaw_rad);
  Append(bytes, packed.max_range_m);
  Append(bytes, static_cast<std::uint8_t>(own_bearings ? 1 : 0));
  if (own_bearings) AppendAll(bytes, packed.bearings_rad);
  AppendAll(bytes, packed.values);
  AppendAll(bytes, packed.codes);
}

bool SameBearings(const StoredScan& a, const StoredScan& b) {
  const auto left = a.scan.packed().bearings_rad;
  const auto right = b.scan.packed().bearings_rad;
  return std::equal(left.begin(), left.end(), right.begin(), right.end());
}

}  // namespace

std::vector<StoredScan> ReadScans(const std::string& path) {
  Reader reader(path);
  reader.RequireMagic();
  const auto count = reader.Take<std::uint32_t>();
  reader.RequireRoom(count, kScanBytes);
  std::vector<StoredScan> scans;
  ScanTaker taker;
  for (std::uint32_t i = 0; i < count; ++i) scans.push_back(taker.Take(reader));
  if (!reader.empty()) reader.Fail("has more bytes after its last scan");
  return scans;
}

void WriteScans(const std::string& path, const std::vector<StoredScan>& scans) {
  WriteFileToDisk(path, [&scans](std::ostream& stream) {
    std::string bytes(kMagic);
    Append(bytes, static_cast<std::uint32_t>(scans.size()));
    for (std::size_t i = 0; i < scans.size(); ++i) {
      AppendScan(bytes, scans[i], i == 0 || !SameBearings(scans[i - 1], scans[i]));
      stream << bytes;
      bytes.clear();
    }
    stream << bytes;
  });
}

}  // namespace depthgrid
