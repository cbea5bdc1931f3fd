// Google Benchmark of the contact pieces: time of a transform pair by FFTW and by the fused
// convolution, of a cold and a warm solve and of an area, with pairs and certificate as counters.
//     contact_micro_bench [--benchmark_filter=...] [--benchmark_format=csv]
#include <benchmark/benchmark.h>

#include <cmath>

#include "base/memory.h"
#include "geometry/roughness.h"
#include "physics/contact/contact.h"
#include "scene/finger.h"

namespace papilla::tests {
namespace {

struct Scene {
  Grid grid;
  std::shared_ptr<const ContactKernel> kernel;
  Heightmap height;
  double pressure, tolerance;
};

// The reference finger's skin on a flat surface at its patch pressure.
Scene loaded(int n) {
  const Finger finger;
  const Skin& skin = finger.skin;
  const Grid grid{n, n, 12e-6, 12e-6};
  return {grid,
          make_contact_kernel(grid, {skin.layer_modulus, skin.layer_poisson, skin.layer_thickness,
                                     skin.bulk_modulus, skin.bulk_poisson}),
          random_surface({skin.rms, skin.roll_off, skin.hurst, skin.cutoff}, grid, 1, 0),
          finger.patch_pressure(0.15), 1e-5};
}

// The paper's uniform preload.
Scene light(int n) {
  const Grid grid{n, n, 12e-6, 12e-6};
  return {grid, make_contact_kernel(grid, {200e6, 0.5, 1e-6, 25e6, 0.5}),
          random_surface({330e-9, 12e-6, 0.8, 50e-9}, grid, 3, 0), 15e3, 1e-8};
}

void pair_by_fftw(benchmark::State& state) {
  const Scene scene = light(static_cast<int>(state.range(0)));
  const ContactKernel& kernel = *scene.kernel;
  RealArray field(scene.grid.size(), 1.0), image(field.size());
  SpectrumArray spectrum(kernel.fft().spectrum_size());
  for (auto step : state) {
    kernel.fft().forward(field.data(), spectrum.data());
    for (std::size_t i = 0; i < spectrum.size(); ++i) spectrum[i] *= kernel.symbol()[i];
    kernel.fft().inverse(spectrum.data(), image.data());
  }
}
BENCHMARK(pair_by_fftw)->RangeMultiplier(2)->Range(64, 1024)->Unit(benchmark::kMicrosecond);

void pair_fused(benchmark::State& state) {
  const Scene scene = light(static_cast<int>(state.range(0)));
  RealArray field(scene.grid.size(), 1.0), image(field.size());
  SpectrumArray scratch(scene.kernel->scratch_size());
  for (auto step : state) scene.kernel->displace(field, image, scratch);
}
BENCHMARK(pair_fused)->RangeMultiplier(2)->Range(64, 1024)->Unit(benchmark::kMicrosecond);

template <Scene (*kMake)(int)>
void cold(benchmark::State& state) {
  const Scene scene = kMake(static_cast<int>(state.range(0)));
  ContactSolution s;
  for (auto step : state) {
    s = solve_contact(*scene.kernel, scene.height.z, scene.pressure, {},
                      {.tolerance = scene.tolerance});
  }
  state.counters["pairs"] = s.fft_pairs;
  state.counters["certificate"] = s.certificate;
}
BENCHMARK(cold<loaded>)->RangeMultiplier(2)->Range(128, 512)->Unit(benchmark::kMillisecond);
BENCHMARK(cold<light>)->RangeMultiplier(2)->Range(128, 512)->Unit(benchmark::kMillisecond);

template <Scene (*kMake)(int)>
void warm(benchmark::State& state) {
  const Scene scene = kMake(static_cast<int>(state.range(0)));
  const ContactOptions options{.tolerance = scene.tolerance};
  const ContactSolution base =
      solve_contact(*scene.kernel, scene.height.z, scene.pressure, {}, options);
  ContactSolution s;
  for (auto step : state) {
    s = solve_contact(*scene.kernel, scene.height.z, 1.1 * scene.pressure, {}, options, &base);
  }
  state.counters["pairs"] = s.fft_pairs;
  state.counters["certificate"] = s.certificate;
}
BENCHMARK(warm<loaded>)->RangeMultiplier(2)->Range(128, 512)->Unit(benchmark::kMillisecond);
BENCHMARK(warm<light>)->RangeMultiplier(2)->Range(128, 512)->Unit(benchmark::kMillisecond);

void area(benchmark::State& state) {
  const Scene scene = loaded(static_cast<int>(state.range(0)));
  const ContactSolution s = solve_contact(*scene.kernel, scene.height.z, scene.pressure, {},
                                          {.tolerance = scene.tolerance});
  for (auto step : state) benchmark::DoNotOptimize(measure_area(*scene.kernel, s));
}
BENCHMARK(area)->RangeMultiplier(2)->Range(128, 512)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace papilla::tests

int main(int argc, char** argv) {
  papilla::tests::keep_freed_memory();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
