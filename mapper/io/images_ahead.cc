#include "mapper/io/images_ahead.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "mapper/core/usable_threads.h"

namespace depthgrid::internal {
namespace {

// More do not help, as the caller is then the bottleneck: decoding a 640x480 PNG takes 3 ms,
// mapping it 1 ms.
constexpr std::size_t kMostAhead = 4;

}  // namespace

ImagesAhead::ImagesAhead(std::size_t begin, std::size_t end, std::size_t most,
                         std::function<ReadImage(std::size_t)> read)
    : next_(begin), end_(end), most_(most), read_(std::move(read)) {}

ReadImage ImagesAhead::Next() {
  if (most_ == 0) return read_(next_++);
  if (coming_.empty()) Begin();
  std::future<ReadImage> first = std::move(coming_.front());
  coming_.pop_front();
  while (coming_.size() < most_ && next_ != end_) Begin();
  return first.get();
}

void ImagesAhead::Begin() {
  const std::size_t image = next_;
  try {
    coming_.push_back(std::async(std::launch::async, std::cref(read_), image));
  } catch (const std::system_error&) {  // no thread available: read when asked for
    coming_.push_back(std::async(std::launch::deferred, std::cref(read_), image));
  }
  ++next_;
}

std::size_t UsualImagesAhead() {
  const auto cores = static_cast<std::size_t>(UsableThreads());
  return cores < 2 ? 0 : std::min(cores, kMostAhead);
}

}  // namespace depthgrid::internal
