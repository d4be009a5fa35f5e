#include "mapper/io/damage.h"

#include <fmt/format.h>

#include "mapper/core/counted.h"

namespace depthgrid {
namespace {

std::string MayBeCut(const std::string& place) {
  return place + ": the last line has no line end; it is used, but may be cut";
}

}  // namespace

void Tally::Add(const std::string& what) {
  if (count++ == 0) first = what;
}

void Tally::AppendTo(std::vector<std::string>& warnings, const std::string& name,
                     std::string_view thing, std::string_view what) const {
  if (count == 0) return;
  warnings.push_back(
      fmt::format("{}: {} {} (first: {})", name, Counted(count, thing), what, first));
}

void WarnOfCount(std::vector<std::string>& warnings, const std::string& name, int count,
                 std::string_view thing, std::string_view what) {
  if (count > 0) warnings.push_back(fmt::format("{}: {} {}", name, Counted(count, thing), what));
}

void RowDamage::RequireMostGood(std::string_view text) {
  if (damaged_.count >= good_) RequireAllGood();
  may_be_cut_ = last_is_good_ && !text.ends_with('\n');
}

void RowDamage::RequireAllGood() const {
  if (damaged_.count > 0) throw InputError("", damaged_.first);
}

InputError RowDamage::NothingIn(const std::string& place, std::string_view thing) const {
  const int rows = left_out_.count + damaged_.count;
  if (rows == 0) return {place, fmt::format("holds no {}", thing)};
  return {place, fmt::format("holds no {} that can be used, {} left out; first: {}", thing,
                             rows == 1 ? "the only one is" : fmt::format("all {} are", rows),
                             left_out_.first)};
}

void RowDamage::AppendTo(std::vector<std::string>& warnings, const std::string& place) const {
  damaged_.AppendTo(warnings, place, "damaged row", "left out");
  if (may_be_cut_) warnings.push_back(MayBeCut(place));
}

void WarnOfCut(const std::string& place, std::string_view text,
               std::vector<std::string>& warnings) {
  if (text.empty() || text.ends_with('\n')) return;
  warnings.push_back(MayBeCut(place));
}

}  // namespace depthgrid
