#include "base/digest.h"

#include <md5.h>
#include <sha2.h>

#include <cstdint>

namespace papilla::base {

std::string sha256(const std::string& bytes) {
  std::string digits(SHA256_DIGEST_STRING_LENGTH, '\0');
  SHA256Data(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), digits.data());
  digits.pop_back();  // the end of the C string
  return digits;
}

struct Md5::State {
  MD5_CTX context;
};

Md5::Md5() : state_(std::make_unique<State>()) { MD5Init(&state_->context); }
Md5::~Md5() = default;

void Md5::add(const void* bytes, std::size_t size) {
  MD5Update(&state_->context, static_cast<const std::uint8_t*>(bytes), size);
}

std::string Md5::finish() {
  std::string digits(MD5_DIGEST_STRING_LENGTH, '\0');
  MD5End(&state_->context, digits.data());
  digits.pop_back();
  return digits;
}

}  // namespace papilla::base
