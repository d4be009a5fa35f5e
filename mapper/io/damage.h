// Tolerated damage in a long file or sequence: the first case is reported, all are counted, and the
// rest of the data is used.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mapper/core/error.h"

namespace depthgrid {

// One kind of damage.
struct Tally {
  int count = 0;
  std::string first;

  void Add(const std::string& what);
  // Appends "name: 3 things what (first: ...)" unless the count is 0.
  void AppendTo(std::vector<std::string>& warnings, const std::string& name, std::string_view thing,
                std::string_view what) const;
};

// Appends "name: 3 things what" unless the count is 0.
void WarnOfCount(std::vector<std::string>& warnings, const std::string& name, int count,
                 std::string_view thing, std::string_view what);

// The rows of a text file, of which some may be damaged.
class RowDamage {
 public:
  // Runs `read` for a row; an InputError it throws is this row's damage. Returns whether it is
  // good.
  template <typename Read>
  bool Try(Read read) {
    try {
      read();
    } catch (const InputError& error) {
      damaged_.Add(error.what());
      last_is_good_ = false;
      return false;
    }
    ++good_;
    last_is_good_ = true;
    return true;
  }
  // Call after all rows of `text`. Throws the first damage unless good rows outnumber the damaged
  // ones: otherwise the file is of another kind, or too short to tell.
  void RequireMostGood(std::string_view text);
  // Throws the first damage, if there is any.
  void RequireAllGood() const;
  int damaged() const { return damaged_.count; }
  // Counts a valid row that cannot be used; `what` says where and why.
  void LeaveOut(const std::string& what) { left_out_.Add(what); }
  const Tally& left_out() const { return left_out_; }
  // The error for a text without usable rows.
  InputError NothingIn(const std::string& place, std::string_view thing) const;
  void AppendTo(std::vector<std::string>& warnings, const std::string& place) const;

 private:
  Tally damaged_;
  Tally left_out_;
  int good_ = 0;
  bool last_is_good_ = false;
  bool may_be_cut_ = false;
};

// Warns if the last line, which is used, has no line end: its last number may be truncated and
// still parse.
void WarnOfCut(const std::string& place, std::string_view text, std::vector<std::string>& warnings);

}  // namespace depthgrid
