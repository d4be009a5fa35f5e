// Reads the depth images of a recording in order; the next ones are read and decoded on other
// threads while the caller processes the current one. Internal to mapper/io.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <string>

#include "mapper/core/depth_image.h"

namespace depthgrid::internal {

// An image, or the reason why there is none, which is reported in the images' order.
struct ReadImage {
  std::shared_ptr<const DepthImage> depth;
  std::string unreadable;  // why there is none
  std::string wrong_size;  // the reason, if the size is wrong
};

class ImagesAhead {
 public:
  // Reads the images [begin, end) with at most `most` threads and waiting images; 0 starts no
  // thread. `read` is called once per image, with its index, on several threads at once.
  ImagesAhead(std::size_t begin, std::size_t end, std::size_t most,
              std::function<ReadImage(std::size_t)> read);

  // The next image, of which there must be one; starts reading those after it. Throws what `read`
  // threw for it.
  ReadImage Next();

 private:
  void Begin();

  std::size_t next_, end_, most_;
  std::function<ReadImage(std::size_t)> read_;
  // Destroying a future waits for its thread; declared last, so destroyed before what the threads
  // use.
  std::deque<std::future<ReadImage>> coming_;
};

// The number of images to read ahead when reading takes longer than processing: one per core, none
// with a single core.
std::size_t UsualImagesAhead();

}  // namespace depthgrid::internal
