// A 64-bit content hash (FNV-1a over words), for cache keys and checksums; not cryptographic.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace depthgrid {

class ContentHash {
 public:
  void Bytes(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (; size >= sizeof(std::uint64_t); size -= sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes, sizeof word);
      bytes += sizeof word;
      Mix(word);
    }
    std::uint64_t tail = size;
    for (std::size_t i = 0; i < size; ++i) tail = tail << 8U | bytes[i];
    Mix(tail);
  }
  void Text(std::string_view text) { Bytes(text.data(), text.size()); }
  template <typename T>
  void Value(const T& value) {
    static_assert(std::is_arithmetic_v<T>, "padding bytes are not content");
    Bytes(&value, sizeof value);
  }
  template <typename T>
  void Array(std::span<const T> values) {
    Value(values.size());
    Bytes(values.data(), values.size_bytes());
  }

  std::uint64_t value() const { return state_; }
  std::string Hex() const;
  // Whether a text has the form of Hex().
  static bool IsHex(std::string_view text);

 private:
  // FNV's prime, then the high half is folded in, because FNV over words never moves high bits
  // down.
  void Mix(std::uint64_t word) {
    state_ = (state_ ^ word) * 0x100000001b3U;
    state_ ^= state_ >> 32U;
  }
  std::uint64_t state_ = 0xcbf29ce484222325U;
};

}  // namespace depthgrid
