#include "numerics/fft.h"

#include <fftw3.h>

#include <map>
#include <mutex>
#include <utility>

namespace papilla::numerics {
namespace {
std::mutex& planner_mutex() {  // FFTW's planner is not thread safe; execution is
  static std::mutex mutex;
  return mutex;
}
}  // namespace

struct Fft2d::Plans {
  fftw_plan forward, inverse;
};

Fft2d::Fft2d(int nx, int ny) : nx_(nx), ny_(ny), plans_(new Plans) {
  RealArray real(real_size());
  SpectrumArray spectrum(spectrum_size());
  auto* complex = reinterpret_cast<fftw_complex*>(spectrum.data());
  std::lock_guard lock(planner_mutex());
  plans_->forward =
      fftw_plan_dft_r2c_2d(ny, nx, real.data(), complex, FFTW_ESTIMATE | FFTW_PRESERVE_INPUT);
  plans_->inverse =
      fftw_plan_dft_c2r_2d(ny, nx, complex, real.data(), FFTW_ESTIMATE | FFTW_DESTROY_INPUT);
}

Fft2d::~Fft2d() {
  std::lock_guard lock(planner_mutex());
  fftw_destroy_plan(plans_->forward);
  fftw_destroy_plan(plans_->inverse);
}

void Fft2d::forward(const double* real, std::complex<double>* spectrum) const {
  fftw_execute_dft_r2c(plans_->forward, const_cast<double*>(real),
                       reinterpret_cast<fftw_complex*>(spectrum));
}

void Fft2d::inverse(std::complex<double>* spectrum, double* real) const {
  fftw_execute_dft_c2r(plans_->inverse, reinterpret_cast<fftw_complex*>(spectrum), real);
}

std::shared_ptr<const Fft2d> Fft2d::shared(int nx, int ny) {
  static std::mutex mutex;
  static std::map<std::pair<int, int>, std::shared_ptr<const Fft2d>> plans;
  std::lock_guard lock(mutex);
  auto& plan = plans[{nx, ny}];
  if (!plan) plan = std::make_shared<const Fft2d>(nx, ny);
  return plan;
}

}  // namespace papilla::numerics
