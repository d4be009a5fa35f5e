// One of the equal parts of a sweep, each for one machine.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace depthgrid {

struct Shard {
  int index = 1;  // from 1 to count
  int count = 1;
};

// "I/N", and its reading; nothing unless I is from 1 to N.
std::string ShardText(const Shard& shard);
std::optional<Shard> ParseShard(std::string_view text);
// What a text that is none must be, for error messages.
constexpr const char* kShardRule = "must be I/N with I from 1 to N";

}  // namespace depthgrid
