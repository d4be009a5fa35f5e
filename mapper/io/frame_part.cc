#include "mapper/io/frame_part.h"

#include <fmt/format.h>

#include <cmath>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// Stamps are printed with six decimals, and doubles resolve those since 1970 to 2.4e-7 s.
constexpr double kStampRoundingS = 1e-6;

constexpr double kLongestS = 1e10;

void RequireWithin(const PartOptions& part, double length_s, const std::string& recording) {
  const auto refuse = [&](const char* key, double value_s, const char* rule, double limit_s,
                          const char* more) {
    throw SettingError(std::string("sequence.") + key,
                       fmt::format("is {}, must be {} {:.3f}: {} is {:.3f} s long{}", value_s, rule,
                                   limit_s, recording, length_s, more));
  };
  if (part.from_s > length_s + kStampRoundingS) {
    refuse("from_s", part.from_s, "at most", length_s, "");
  }
  // A recording of 30 s at 30 Hz ends one frame before 30 s.
  const double next_second_s = std::floor(length_s) + 1.0;
  if (part.to_s > next_second_s) {
    refuse("to_s", part.to_s, "at most", next_second_s, "; 0 is its end");
  }
}

}  // namespace

bool PartOptions::Has(double since_first_s) const {
  const double at_s = since_first_s + kStampRoundingS;
  return at_s >= from_s && (to_s == 0.0 || at_s < to_s);
}

void PartOptions::Visit(OptionsVisitor& v) {
  v.Number("from_s", from_s, {0.0, kLongestS},
           "where the part that is read begins, seconds since the recording's first frame");
  v.Number("to_s", to_s, {0.0, kLongestS},
           "where the part that is read ends, exclusive, seconds since the recording's first "
           "frame; 0: at its end");
  if (to_s > 0.0) v.Less("from_s", from_s, "to_s", to_s);
}

bool FramePart::Has(const LoopClosure& loop) const {
  const auto has = [&](int frame) { return Has(static_cast<std::size_t>(frame)); };
  return has(loop.first_frame) && has(loop.second_frame) && has(loop.reported_at_frame);
}

FramePart FindPart(const PartOptions& part, const std::vector<double>& stamps_s,
                   const std::string& recording) {
  RequireInRange(part, "sequence");
  if (part.IsWhole() || stamps_s.empty()) return {};
  RequireWithin(part, stamps_s.back() - stamps_s.front(), recording);
  const auto has = [&](double stamp_s) { return part.Has(stamp_s - stamps_s.front()); };
  const auto begin = std::find_if(stamps_s.begin(), stamps_s.end(), has);
  const auto end = std::find_if_not(begin, stamps_s.end(), has);
  if (begin == end) {
    throw SettingError("sequence.from_s",
                       fmt::format("is {}, but {} has no frame from there to {} s", part.from_s,
                                   recording, part.to_s));
  }
  return {static_cast<std::size_t>(begin - stamps_s.begin()),
          static_cast<std::size_t>(end - stamps_s.begin())};
}

}  // namespace depthgrid
