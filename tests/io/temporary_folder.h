// A test with its own folder, which is removed afterwards.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "mapper/io/file.h"
#include "tests/scratch.h"

namespace depthgrid {

class TemporaryFolderTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = ScratchPath();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string Path(const std::string& name) const { return folder_ + "/" + name; }
  void Write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(std::filesystem::path(Path(name)).parent_path());
    WriteFile(Path(name), text);
  }
  // A message with the folder's name taken out.
  std::string Short(const std::string& message) const {
    std::string text;
    for (std::size_t i = 0; i < message.size();) {
      const bool here = message.compare(i, folder_.size(), folder_) == 0;
      text.push_back(here ? '~' : message[i]);
      i += here ? folder_.size() : 1;
    }
    return text;
  }

  std::string folder_;
};

}  // namespace depthgrid
