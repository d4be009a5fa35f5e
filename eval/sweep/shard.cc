#include "eval/sweep/shard.h"

#include <fmt/format.h>

#include <charconv>

namespace depthgrid {
namespace {

bool ReadWhole(std::string_view text, int& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

std::string ShardText(const Shard& shard) { return fmt::format("{}/{}", shard.index, shard.count); }

std::optional<Shard> ParseShard(std::string_view text) {
  const std::size_t slash = text.find('/');
  Shard shard;
  const bool is_read = slash != std::string_view::npos &&
                       ReadWhole(text.substr(0, slash), shard.index) &&
                       ReadWhole(text.substr(slash + 1), shard.count);
  if (!is_read || shard.index < 1 || shard.index > shard.count) return std::nullopt;
  return shard;
}

}  // namespace depthgrid
