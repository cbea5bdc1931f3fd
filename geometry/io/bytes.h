// Numbers out of bytes whose end is watched (internal to geometry/io).
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/rooms.h"

namespace papilla::geometry {

class ByteReader {
 public:
  ByteReader(std::string_view bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  [[noreturn]] void fail(const std::string& why) const {
    throw InputError("cannot read " + path_ + ": " + why);
  }
  std::size_t at() const { return at_; }
  std::size_t left() const { return bytes_.size() - at_; }
  void go(std::size_t to) {
    if (to > bytes_.size()) fail("the data are cut off");
    at_ = to;
  }
  std::string_view take(std::size_t count) {
    if (count > left()) fail("the data are cut off");
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }
  // Little endian.
  template <class T>
  T number() {
    T out{};
    std::memcpy(&out, take(sizeof(T)).data(), sizeof(T));
    return out;
  }
  std::string_view until(char end) {
    const std::size_t stop = bytes_.find(end, at_);
    if (stop == std::string_view::npos) fail("the data are cut off");
    const std::string_view out = bytes_.substr(at_, stop - at_);
    at_ = stop + 1;
    return out;
  }

 private:
  std::string_view bytes_;
  std::string path_;
  std::size_t at_ = 0;
};

}  // namespace papilla::geometry
