// Which index has a key. A flat table: look-ups are the surfel matcher's inner loop, and emptying
// it keeps its memory. It is never walked through, so its order cannot show.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace depthgrid {

class KeyIndex {
 public:
  // -1 when there is none.
  int Find(std::uint64_t key) const {
    if (entries_.empty()) return -1;
    for (std::size_t i = PlaceOf(key);; i = (i + 1) & (entries_.size() - 1)) {
      if (entries_[i].index < 0 || entries_[i].key == key) return entries_[i].index;
    }
  }
  // A key that is not there yet; `index` is not negative.
  void Add(std::uint64_t key, int index) {
    if (2 * (size_ + 1) > entries_.size()) Grow();
    std::size_t i = PlaceOf(key);
    while (entries_[i].index >= 0) i = (i + 1) & (entries_.size() - 1);
    entries_[i] = {key, index};
    ++size_;
  }
  void Clear() {
    entries_.assign(entries_.size(), {});
    size_ = 0;
  }

 private:
  struct Entry {
    std::uint64_t key = 0;
    int index = -1;
  };
  static constexpr std::size_t kFirstSize = 16;  // always a power of two

  // Multiplicative hashing (Knuth, TAOCP 3, 6.4); the upper bits mix best.
  std::size_t PlaceOf(std::uint64_t key) const {
    return static_cast<std::size_t>((key * 0x9E3779B97F4A7C15U) >> 32) & (entries_.size() - 1);
  }
  void Grow() {
    std::vector<Entry> before = std::move(entries_);
    entries_.assign(before.empty() ? kFirstSize : 2 * before.size(), {});
    size_ = 0;
    for (const Entry& entry : before) {
      if (entry.index >= 0) Add(entry.key, entry.index);
    }
  }

  std::vector<Entry> entries_;
  std::size_t size_ = 0;
};

}  // namespace depthgrid
