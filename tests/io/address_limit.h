// A process that may have so many bytes of addresses and no more, as long as this lives.
#pragma once

#include <sys/resource.h>

#include <stdexcept>

#include "base/rooms.h"

namespace papilla::tests {

// The shadow of the address sanitizer is larger than any limit: it could allocate nothing below it.
#ifdef __SANITIZE_ADDRESS__
inline constexpr bool kAddressesAreFree = false;
#else
inline constexpr bool kAddressesAreFree = true;
#endif

class AddressLimit {
 public:
  explicit AddressLimit(double bytes) {
    if (getrlimit(RLIMIT_AS, &before_) != 0) throw std::runtime_error("no limit of addresses");
    rlimit less = before_;
    less.rlim_cur = static_cast<rlim_t>(bytes);
    if (setrlimit(RLIMIT_AS, &less) != 0) throw std::runtime_error("no limit of addresses");
  }
  ~AddressLimit() { setrlimit(RLIMIT_AS, &before_); }
  AddressLimit(const AddressLimit&) = delete;
  AddressLimit& operator=(const AddressLimit&) = delete;

 private:
  rlimit before_{};
};

}  // namespace papilla::tests
