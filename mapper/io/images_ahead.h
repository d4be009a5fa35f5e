// The depth images of a recording in their order, of which the next ones are read and decoded on
// threads of their own while the caller is at work with those before. Only for this folder's own
// files.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <string>

#include "mapper/core/depth_image.h"

namespace depthgrid::internal {

// As it was read; what is wrong with it is told where it is asked for, so in the images' order.
struct ReadImage {
  std::shared_ptr<const DepthImage> depth;
  std::string unreadable;  // why there is none
  std::string wrong_size;  // likewise
};

class ImagesAhead {
 public:
  // Of the images [begin, end), `most` ahead: so many threads read at once, so many images wait at
  // most. With 0 no thread is started. `read` is called on several threads at once, for each image
  // once, and is given its number.
  ImagesAhead(std::size_t begin, std::size_t end, std::size_t most,
              std::function<ReadImage(std::size_t)> read);

  // The next one, of which there must be one; those after it are begun. Throws what `read` threw
  // for it.
  ReadImage Next();

 private:
  void Begin();

  std::size_t next_, end_, most_;
  std::function<ReadImage(std::size_t)> read_;
  // Each waits for its thread when it is destroyed, so before what the thread reads with.
  std::deque<std::future<ReadImage>> coming_;
};

// How many ahead serve a caller that takes less time for an image than its reading does: one a
// core, none where there is but one.
std::size_t UsualImagesAhead();

}  // namespace depthgrid::internal
