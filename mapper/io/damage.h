// Damage inside a long file or sequence: the first case is named, all are counted, the rest is
// used.
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
  // "name: 3 things what (first: ...)", nothing when there was none.
  void AppendTo(std::vector<std::string>& warnings, const std::string& name, std::string_view thing,
                std::string_view what) const;
};

// "name: 3 things what", nothing when there was none.
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
  // Once all rows of `text` are read. Throws the first damage unless good rows outnumber the
  // damaged: the file is something else then, or too short to say.
  void RequireMostGood(std::string_view text);
  // Throws the first damage, if there is any.
  void RequireAllGood() const;
  int damaged() const { return damaged_.count; }
  // A row that is sound, but nothing that can be used; `what` says where and why.
  void LeaveOut(const std::string& what) { left_out_.Add(what); }
  const Tally& left_out() const { return left_out_; }
  // The error of a text of which no row is left: each is left out, or there is none.
  InputError NothingIn(const std::string& place, std::string_view thing) const;
  void AppendTo(std::vector<std::string>& warnings, const std::string& place) const;

 private:
  Tally damaged_;
  Tally left_out_;
  int good_ = 0;
  bool last_is_good_ = false;
  bool may_be_cut_ = false;
};

// A last line without line end is used, but said: a number that lost its last digits is a number.
void WarnOfCut(const std::string& place, std::string_view text, std::vector<std::string>& warnings);

}  // namespace depthgrid
