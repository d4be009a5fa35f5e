#include "mapper/io/damage.h"

#include <fmt/format.h>

namespace depthgrid {

void Tally::Add(const std::string& what) {
  if (count++ == 0) first = what;
}

void Tally::AppendTo(std::vector<std::string>& warnings, const std::string& name,
                     std::string_view kind) const {
  if (count > 0) warnings.push_back(fmt::format("{}: {} {} (first: {})", name, count, kind, first));
}

void RowDamage::RequireMostGood(std::string_view text) {
  if (damaged_.count >= good_) RequireAllGood();
  // A number that lost its last digits is still a number.
  may_be_cut_ = last_is_good_ && !text.ends_with('\n');
}

void RowDamage::RequireAllGood() const {
  if (damaged_.count > 0) throw InputError("", damaged_.first);
}

void RowDamage::AppendTo(std::vector<std::string>& warnings, const std::string& place) const {
  damaged_.AppendTo(warnings, place, "damaged rows left out");
  if (may_be_cut_) {
    warnings.push_back(place + ": the last line has no line end; it is used, but may be cut");
  }
}

}  // namespace depthgrid
