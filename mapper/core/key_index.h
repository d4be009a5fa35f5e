// A hash table from key to index. Open addressing, because look-ups are the surfel matcher's inner
// loop; Clear() keeps the memory. It is never iterated, so its order affects no result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace depthgrid {

class KeyIndex {
 public:
  // -1 when the key is not there.
  int Find(std::uint64_t key) const {
    if (entries_.empty()) return -1;
    for (std::size_t i = PlaceOf(key);; i = (i + 1) & (entries_.size() - 1)) {
      if (entries_[i].index < 0 || entries_[i].key == key) return entries_[i].index;
    }
  }
  // Requires a key that is not there yet and a non-negative index.
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
