#include "mapper/io/scan_file.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <string_view>

#include "mapper/core/error.h"
#include "mapper/io/file.h"

namespace depthgrid {
namespace {

static_assert(std::endian::native == std::endian::little,
              "scans.bin is written as it lies in memory");

constexpr std::string_view kMagic = "DGSCANS1";

template <typename T>
void Append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

class Reader {
 public:
  Reader(std::string_view bytes, std::string place) : rest_(bytes), place_(std::move(place)) {}

  template <typename T>
  T Take() {
    if (rest_.size() < sizeof(T)) throw InputError(place_, "is truncated");
    T value;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return value;
  }
  void RequireMagic() {
    if (!rest_.starts_with(kMagic)) throw InputError(place_, "holds no stored scans (scans.bin)");
    rest_.remove_prefix(kMagic.size());
  }
  // Before memory is taken for `count` things that need `bytes_each` in the file.
  void RequireRoom(std::uint32_t count, std::size_t bytes_each) const {
    if (rest_.size() / bytes_each < count) throw InputError(place_, "is truncated");
  }
  float TakeFinite() {
    const auto value = Take<float>();
    if (!std::isfinite(value)) throw InputError(place_, "holds a beam that is not finite");
    return value;
  }
  bool empty() const { return rest_.empty(); }

 private:
  std::string_view rest_;
  std::string place_;
};

constexpr std::size_t kBeamBytes = 4 * sizeof(float) + 1;
constexpr std::size_t kScanBytes = 2 * sizeof(std::uint32_t) + 5 * sizeof(double);

StoredScan TakeScan(Reader& reader) {
  StoredScan stored;
  stored.frame = reader.Take<std::int32_t>();
  const auto beams = reader.Take<std::uint32_t>();
  stored.stamp_s = reader.Take<double>();
  stored.map_from_base.x_m = reader.Take<double>();
  stored.map_from_base.y_m = reader.Take<double>();
  stored.map_from_base.yaw_rad = reader.Take<double>();
  stored.scan.max_range_m = reader.Take<double>();
  reader.RequireRoom(beams, kBeamBytes);
  for (std::uint32_t i = 0; i < beams; ++i) {
    Beam beam;
    beam.bearing_rad = reader.TakeFinite();
    beam.range_m = reader.TakeFinite();
    beam.clear_from_m = reader.TakeFinite();
    beam.clear_to_m = reader.TakeFinite();
    beam.hit = reader.Take<std::uint8_t>() != 0;
    stored.scan.beams.push_back(beam);
  }
  return stored;
}

void AppendScan(std::string& bytes, const StoredScan& stored) {
  Append(bytes, static_cast<std::int32_t>(stored.frame));
  Append(bytes, static_cast<std::uint32_t>(stored.scan.beams.size()));
  Append(bytes, stored.stamp_s);
  Append(bytes, stored.map_from_base.x_m);
  Append(bytes, stored.map_from_base.y_m);
  Append(bytes, stored.map_from_base.yaw_rad);
  Append(bytes, stored.scan.max_range_m);
  for (const Beam& beam : stored.scan.beams) {
    Append(bytes, beam.bearing_rad);
    Append(bytes, beam.range_m);
    Append(bytes, beam.clear_from_m);
    Append(bytes, beam.clear_to_m);
    Append(bytes, static_cast<std::uint8_t>(beam.hit ? 1 : 0));
  }
}

}  // namespace

std::vector<StoredScan> ReadScans(const std::string& path) {
  const std::string bytes = ReadFile(path);
  Reader reader(bytes, path);
  reader.RequireMagic();
  const auto count = reader.Take<std::uint32_t>();
  reader.RequireRoom(count, kScanBytes);
  std::vector<StoredScan> scans;
  for (std::uint32_t i = 0; i < count; ++i) scans.push_back(TakeScan(reader));
  if (!reader.empty()) throw InputError(path, "goes on behind its last scan");
  return scans;
}

void WriteScans(const std::string& path, const std::vector<StoredScan>& scans) {
  std::string bytes(kMagic);
  Append(bytes, static_cast<std::uint32_t>(scans.size()));
  for (const StoredScan& scan : scans) AppendScan(bytes, scan);
  WriteFile(path, bytes);
}

}  // namespace depthgrid
