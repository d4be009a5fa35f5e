#include "mapper/io/event_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/core/frame.h"
#include "mapper/core/trajectory.h"
#include "mapper/io/matrix_poses.h"

namespace depthgrid::internal {
namespace {

void RequirePossible(LoopClosure& loop, const std::string& place) {
  const double norm = loop.first_from_second.rotation.norm();
  if (!(std::abs(norm - 1.0) <= kMaxNormError)) {
    throw InputError(place, fmt::format("quaternion has norm {:.6g}, must be 1", norm));
  }
  if (std::abs(norm - 1.0) > kExactNormError) loop.first_from_second.rotation.normalize();
  if (!IsWithinReach(loop.first_from_second.translation)) {
    throw InputError(place, "a loop's ends must lie within 10,000 km");
  }
  if (std::max(loop.first_frame, loop.second_frame) > loop.reported_at_frame) {
    throw InputError(place, "a loop cannot be reported before the frames it joins");
  }
  if (!(loop.sigma_translation_m > 0.0) || !(loop.sigma_rotation_rad > 0.0)) {
    throw InputError(place, "the sigmas of a loop must be above 0");
  }
}

// Fields of one row of loops.csv, each error naming the line.
class CsvRow {
 public:
  CsvRow(std::string_view row, const std::string& place)
      : fields_(SplitAtCommas(row)), place_(place) {
    if (fields_.size() != kCsvColumns && fields_.size() != kCsvColumnsWithStamps) {
      throw InputError(place_,
                       fmt::format("has {}, must have {} or {}", Counted(fields_.size(), "column"),
                                   kCsvColumns, kCsvColumnsWithStamps));
    }
  }
  CsvEvent Parse() const {
    if (fields_[0] != "loop" && fields_[0] != "relocalisation") {
      throw InputError(place_,
                       fmt::format("kind is '{}', must be loop or relocalisation", fields_[0]));
    }
    CsvEvent row;
    row.event.frame = Whole(1);
    row.event.epoch = Whole(2);
    const bool is_loop = fields_[0] == "loop";
    if (is_loop) row.event.loop = Loop(row.event.frame);
    if (fields_.size() == kCsvColumns) return row;
    row.stamp_s = Value(14);
    if (is_loop) row.first_stamp_s = Value(15);
    if (is_loop) row.second_stamp_s = Value(16);
    return row;
  }

 private:
  LoopClosure Loop(int reported_at_frame) const {
    LoopClosure loop;
    loop.reported_at_frame = reported_at_frame;
    loop.first_frame = Whole(3);
    loop.second_frame = Whole(4);
    loop.first_from_second = {Eigen::Quaterniond(Value(11), Value(8), Value(9), Value(10)),
                              {Value(5), Value(6), Value(7)}};
    loop.sigma_translation_m = Value(12);
    loop.sigma_rotation_rad = Value(13);
    RequirePossible(loop, place_);
    return loop;
  }
  double Value(std::size_t column) const {
    const std::optional<double> value = ParseNumber(fields_[column]);
    if (!value || !std::isfinite(*value)) {
      throw InputError(place_, fmt::format("column {} is '{}', must be a finite number", column + 1,
                                           fields_[column].substr(0, 40)));
    }
    return *value;
  }
  int Whole(std::size_t column) const {
    const double value = Value(column);
    if (value != std::floor(value) || value < 0.0 || value > 1e9) {
      throw InputError(place_, fmt::format("column {} is '{}', must be a whole number", column + 1,
                                           fields_[column].substr(0, 40)));
    }
    return static_cast<int>(value);
  }

  std::vector<std::string_view> fields_;
  const std::string& place_;
};

double FieldNumber(const TextRow& row, std::size_t field, const std::string& path) {
  const auto number =
      field < row.fields.size() ? ParseNumber(row.fields[field]) : std::optional<double>{};
  if (!number || !std::isfinite(*number)) {
    throw InputError(PlaceOfLine(path, row.line),
                     fmt::format("field {} must be a finite number", field + 1));
  }
  return *number;
}

// The 3x4 matrix behind `Tcm`: current_from_matched.
Pose3 CurrentFromMatched(const TextRow& row, const std::string& path) {
  const std::string place = PlaceOfLine(path, row.line);
  const auto name = std::find(row.fields.begin(), row.fields.end(), "Tcm");
  if (row.fields.end() - name != 13) {
    throw InputError(place, "a LOOP must end with Tcm and the 12 numbers of a 3x4 matrix");
  }
  std::string matrix;
  for (auto field = name + 1; field != row.fields.end(); ++field) {
    matrix += std::string(*field) + " ";
  }
  const auto pose = ParseMatrixPose(matrix, place);
  if (!pose) throw InputError(place, "the matrix must be finite");
  return *pose;
}

FoundEvent Found(SlamEvent event) { return {std::move(event), false}; }
FoundEvent Missing() { return {std::nullopt, true}; }

}  // namespace

std::optional<int> FrameFinder::At(double stamp_s) const {
  const auto nearest = NearestStamp(stamps_s_, stamp_s, max_difference_s_);
  return nearest ? std::optional(static_cast<int>(*nearest)) : std::nullopt;
}

CsvEvent ParseCsvEvent(std::string_view row, const std::string& place) {
  return CsvRow(row, place).Parse();
}

FoundEvent ParseOrbEvent(const TextRow& row, const std::string& path, const FrameFinder& frames) {
  const std::string_view name = row.fields.front();
  if (name == "GBA_DONE") return {};
  SlamEvent event;
  if (name == "RELOC") {  // RELOC frame 530 t 1017.666667
    const auto frame = frames.At(FieldNumber(row, 4, path));
    if (!frame) return Missing();
    event.frame = *frame;
    event.new_epoch = true;
    return Found(event);
  }
  if (name != "LOOP") {
    throw InputError(
        PlaceOfLine(path, row.line),
        fmt::format("'{}' must be LOOP, RELOC or GBA_DONE", std::string(name.substr(0, 40))));
  }
  // LOOP 788 1026.27 2 1000.07 jump_m 0.24 nmatch 1003 Tcm ...
  const auto current = frames.At(FieldNumber(row, 2, path));
  const auto matched = frames.At(FieldNumber(row, 4, path));
  const Pose3 matched_from_current = Inverse(CurrentFromMatched(row, path));
  if (!current || !matched) return Missing();
  LoopClosure loop;
  loop.reported_at_frame = std::max(*current, *matched);
  loop.first_frame = *matched;
  loop.second_frame = *current;
  loop.first_from_second = matched_from_current;
  event.frame = loop.reported_at_frame;
  event.loop = loop;
  return Found(event);
}

FoundEvent ParseStampedLoop(const TextRow& row, const std::string& path,
                            const FrameFinder& frames) {
  constexpr std::size_t kPlain = 9;
  const std::string place = PlaceOfLine(path, row.line);
  const bool with_sigmas = row.fields.size() == kPlain + 2;
  const std::vector<double> n = NumbersIn(row, with_sigmas ? kPlain + 2 : kPlain, path);
  if (!std::all_of(n.begin(), n.end(), [](double value) { return std::isfinite(value); })) {
    throw InputError(place, "a loop's numbers must be finite");
  }
  LoopClosure loop;
  loop.first_from_second = {Eigen::Quaterniond(n[8], n[5], n[6], n[7]), {n[2], n[3], n[4]}};
  if (with_sigmas) {
    loop.sigma_translation_m = n[kPlain];
    loop.sigma_rotation_rad = n[kPlain + 1];
  }
  const auto first = frames.At(n[0]);
  const auto second = frames.At(n[1]);
  if (first && second) {
    loop.first_frame = *first;
    loop.second_frame = *second;
    loop.reported_at_frame = std::max(*first, *second);
  }
  RequirePossible(loop, place);
  if (!first || !second) return Missing();
  SlamEvent event;
  event.frame = loop.reported_at_frame;
  event.loop = loop;
  return Found(event);
}

}  // namespace depthgrid::internal
