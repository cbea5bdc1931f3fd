// Checksums of files, as sha256sum and md5sum print them.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "base/rooms.h"

namespace papilla::base {

// 64 hexadecimal digits (FIPS 180-4).
std::string sha256(const std::string& bytes);

// RFC 1321, of bytes that come in pieces.
class Md5 {
 public:
  Md5();
  ~Md5();
  void add(const void* bytes, std::size_t size);
  std::string finish();  // 32 hexadecimal digits

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace papilla::base
