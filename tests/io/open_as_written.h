// Opens a folder of depth images in the world of its poses, without searching for the up direction.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "mapper/io/depth_sequence.h"

namespace depthgrid {

inline std::unique_ptr<FrameSource> OpenAsWritten(const std::string& folder, SequenceFormat format,
                                                  const std::optional<SlamOutput>& slam = {},
                                                  const RecordingOptions& recording = {}) {
  SequenceOptions options;
  options.recording = recording;
  DepthSequence sequence = ReadDepthSequence(folder, format, options, slam);
  return OpenRecording(std::move(sequence.recording), sequence.slam, recording,
                       std::move(sequence.reader));
}

}  // namespace depthgrid
