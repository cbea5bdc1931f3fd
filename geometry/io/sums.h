// Sums that formats of files ask for (internal to geometry/io).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "base/rooms.h"

namespace papilla::geometry {

// The lowest bytes of a number, the least first.
std::string little(std::uint64_t value, int bytes);

// Of zip and OASIS.
class Crc32 {
 public:
  void add(const void* bytes, std::size_t size);
  std::uint32_t sum() const { return sum_ ^ 0xffffffffu; }

 private:
  std::uint32_t sum_ = 0xffffffffu;
};

// RFC 1321, of X3P.
class Md5 {
 public:
  Md5();
  void add(const void* bytes, std::size_t size);
  std::string finish();  // in hexadecimal

 private:
  void turn();

  std::array<std::uint32_t, 64> sines_{};
  std::array<std::uint32_t, 4> sum_{0x67452301u, 0xefcdab89u, 0x98badcfeu, 0x10325476u};
  std::array<char, 64> block_{};
  std::size_t held_ = 0;
  std::uint64_t size_ = 0;
};

}  // namespace papilla::geometry
