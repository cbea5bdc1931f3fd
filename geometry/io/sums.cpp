#include "geometry/io/sums.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace papilla::geometry {

std::string little(std::uint64_t value, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; ++i) out += static_cast<char>((value >> (8 * i)) & 0xff);
  return out;
}

void Crc32::add(const void* bytes, std::size_t size) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> out{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t c = i;
      for (int k = 0; k < 8; ++k) c = c & 1 ? 0xedb88320u ^ (c >> 1) : c >> 1;
      out[i] = c;
    }
    return out;
  }();
  const auto* b = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i < size; ++i) sum_ = table[(sum_ ^ b[i]) & 0xff] ^ (sum_ >> 8);
}

Md5::Md5() {
  for (std::size_t i = 0; i < 64; ++i) {
    sines_[i] = static_cast<std::uint32_t>(
        std::floor(4294967296.0 * std::abs(std::sin(static_cast<double>(i + 1)))));
  }
}

void Md5::add(const void* bytes, std::size_t size) {
  const char* at = static_cast<const char*>(bytes);
  size_ += size;
  while (size > 0) {
    const std::size_t n = std::min(size, block_.size() - held_);
    std::memcpy(block_.data() + held_, at, n);
    held_ += n, at += n, size -= n;
    if (held_ == block_.size()) turn();
  }
}

std::string Md5::finish() {
  const std::string bits = little(8 * size_, 8);
  add("\x80", 1);
  while (held_ != 56) add("", 1);
  add(bits.data(), bits.size());
  std::string out;
  for (const std::uint32_t v : sum_) {
    for (const char b : little(v, 4)) out += fmt::format("{:02x}", static_cast<unsigned char>(b));
  }
  return out;
}

void Md5::turn() {
  static constexpr std::array<int, 16> kTurns{7, 12, 17, 22, 5, 9,  14, 20,
                                              4, 11, 16, 23, 6, 10, 15, 21};
  held_ = 0;
  std::array<std::uint32_t, 16> word{};
  std::memcpy(word.data(), block_.data(), 64);
  auto [a, b, c, d] = sum_;
  for (std::uint32_t i = 0; i < 64; ++i) {
    std::uint32_t f = 0, g = 0;
    if (i < 16) {
      f = (b & c) | (~b & d), g = i;
    } else if (i < 32) {
      f = (d & b) | (~d & c), g = (5 * i + 1) % 16;
    } else if (i < 48) {
      f = b ^ c ^ d, g = (3 * i + 5) % 16;
    } else {
      f = c ^ (b | ~d), g = 7 * i % 16;
    }
    const std::uint32_t x = a + f + sines_[i] + word[g];
    const int turns = kTurns[4 * (i / 16) + i % 4];
    a = d, d = c, c = b;
    b += (x << turns) | (x >> (32 - turns));
  }
  sum_[0] += a, sum_[1] += b, sum_[2] += c, sum_[3] += d;
}

}  // namespace papilla::geometry
