// A cache in memory of items that several runs share.
#pragma once

#include <algorithm>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace depthgrid {

template <typename Item>
class Shelf {
 public:
  // Keeps the `capacity` most recently used items; others live on only while callers hold them.
  explicit Shelf(std::size_t capacity) : capacity_(capacity) {}

  // The item of that key, made by `make()` if it is not there. Other callers wait meanwhile.
  std::shared_ptr<const Item> Get(const std::string& key, const std::function<Item()>& make) {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(items_.begin(), items_.end(),
                                    [&](const auto& entry) { return entry.first == key; });
    if (found != items_.end()) {
      items_.splice(items_.begin(), items_, found);
    } else {
      items_.emplace_front(key, std::make_shared<const Item>(make()));
      if (items_.size() > capacity_) items_.pop_back();
    }
    return items_.front().second;
  }

 private:
  std::size_t capacity_;
  std::mutex mutex_;
  // Most recently used first.
  std::list<std::pair<std::string, std::shared_ptr<const Item>>> items_;
};

}  // namespace depthgrid
