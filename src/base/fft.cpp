#include "base/fft.h"

#include <map>
#include <mutex>
#include <utility>

namespace papilla::base {

std::shared_ptr<const Fft2d> Fft2d::shared(int nx, int ny) {
  static std::mutex mutex;
  static std::map<std::pair<int, int>, std::shared_ptr<const Fft2d>> plans;
  std::lock_guard lock(mutex);
  auto& plan = plans[{nx, ny}];
  if (!plan) plan = std::make_shared<const Fft2d>(nx, ny);
  return plan;
}

}  // namespace papilla::base
