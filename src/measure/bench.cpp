#include "measure/bench.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>

#include "base/constants.h"
#include "base/parallel.h"
#include "design/design.h"
#include "forward/forward.h"
#include "geometry/roughness.h"
#include "numerics/statistics.h"
#include "physics/capillary/bridge_table.h"
#include "physics/capillary/droplets.h"
#include "physics/contact/contact.h"

namespace papilla::measure {
namespace {

// Processor time of the calling thread, or of all: other work on the machine does not count.
double processor_seconds(clockid_t clock = CLOCK_THREAD_CPUTIME_ID) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

template <class Work>
double seconds(int repeats, Work&& work) {
  const double start = processor_seconds();
  for (int k = 0; k < repeats; ++k) work(k);
  return (processor_seconds() - start) / repeats;
}

double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

class Bench {
 public:
  explicit Bench(const BenchOptions& options) : options_(options) {
    design_ = read_design(find_design("m3_samples/a3h350.toml"));
  }

  std::vector<BenchRow> run() {
    note("contact");
    memory();  // first: the largest patch so far
    for (int grid : {256, 512}) loaded(grid);
    light();
    note("water");
    water();
    note("evaluations");
    evaluations();
    return std::move(rows_);
  }

 private:
  void note(const std::string& text) const {
    if (options_.note) options_.note(text);
  }

  std::shared_ptr<const ContactKernel> kernel(const Grid& grid) const {
    const Skin& s = design_.finger.skin;
    return make_contact_kernel(grid, {s.layer_modulus, s.layer_poisson, s.layer_thickness,
                                      s.bulk_modulus, s.bulk_poisson, 0, 0.4});
  }

  std::vector<double> skin(const Grid& grid, std::uint64_t index) const {
    const Skin& s = design_.finger.skin;
    return random_surface({s.rms, s.roll_off, s.hurst, s.cutoff}, grid, 1, index).z;
  }

  static Grid square_grid(int pixels) { return {pixels, pixels, kWindow, kWindow}; }

  // By FFTW, the unit that others know; the solver's own convolution is cheaper.
  double pair_seconds(const ContactKernel& k) const {
    RealArray real(k.grid().size(), 1.0);
    SpectrumArray spectrum(k.symbol().size());
    double best = kInfinity;
    for (int repeat = 0; repeat < 10; ++repeat) {
      best = std::min(best, seconds(1, [&](int) {
                        k.fft().forward(real.data(), spectrum.data());
                        for (std::size_t i = 0; i < spectrum.size(); ++i) {
                          spectrum[i] *= k.symbol()[i];
                        }
                        k.fft().inverse(spectrum.data(), real.data());
                      }));
    }
    return best;
  }

  // Pressure of the load-carrying patches; means over four skins, in FFT pairs of that grid.
  void loaded(int pixels) {
    const auto k = kernel(square_grid(pixels));
    const double p = design_.finger.patch_pressure(0.15);
    double cold = 0, warm = 0, time = 0;
    constexpr int kSkins = 4;
    for (int i = 0; i < kSkins; ++i) {
      const std::vector<double> h = skin(k->grid(), static_cast<std::uint64_t>(i));
      ContactSolution s;
      time += seconds(1, [&](int) { s = solve_contact(*k, h, p, {}, {.tolerance = 1e-5}); });
      cold += s.fft_pairs / kSkins;
      warm += solve_contact(*k, h, 0.85 * p, {}, {.tolerance = 1e-5}, &s).fft_pairs / kSkins;
    }
    const bool small = pixels == 256;
    count(fmt::format("loaded contact, {}², certified 1e-5, cold", pixels), cold, small ? 35 : 40);
    count(fmt::format("loaded contact, {}², next humidity, warm", pixels), warm, small ? 25 : 35);
    timed(fmt::format("loaded contact, {}², cold: time over that of its pairs", pixels), "",
          time / kSkins / (cold * pair_seconds(*k)), 1.5);
  }

  void light() {
    const auto k = kernel(square_grid(512));
    const std::vector<double> h = skin(k->grid(), 0);
    const ContactSolution s = solve_contact(*k, h, 15e3, {}, {.tolerance = 1e-8});
    count("light contact (15 kPa), 512², certified 1e-8, cold", s.fft_pairs, 4);
    count("light contact, 512², warm (13 kPa)",
          solve_contact(*k, h, 13e3, {}, {.tolerance = 1e-8}, &s).fft_pairs, 2.5);
  }

  void memory() {
    const int pixels = options_.large ? 4096 : 1024;
    const Grid grid = square_grid(pixels);
    const double before = peak_bytes(), n = static_cast<double>(grid.size());
    const std::vector<double> h = skin(grid, 0);
    const auto k = kernel(grid);
    const ContactSolution s =
        solve_contact(*k, h, design_.finger.patch_pressure(0.15), {}, {.tolerance = 1e-5});
    rows_.push_back({fmt::format("memory of a loaded contact, {}²", pixels), "bytes per pixel",
                     (peak_bytes() - before) / n, 150});
    const auto per_pixel = [&](int side) {
      const auto kk = kernel(square_grid(side));
      const double m = static_cast<double>(kk->grid().size());
      return pair_seconds(*kk) / (m * std::log2(m));
    };
    const double small = per_pixel(256);
    timed(fmt::format("FFT pair per pixel and log n, {}² over 256²", pixels), "",
          per_pixel(pixels) / small, 3);
  }

  void water() {
    const double t1 = 80 * kPi / 180, t2 = 50 * kPi / 180;
    const BridgeTable table(t1, t2);
    double sum = 0;
    const double bridge = seconds(1000000, [&](int k) {
      const auto v = table(0.05 + 0.9e-6 * k);
      sum += v.energy + v.force;
    });
    timed("bridge energy and force from the table", "ns", std::isfinite(sum) ? 1e9 * bridge : 0,
          50);
    const Grid grid = square_grid(256);
    std::vector<double> h = skin(grid, 0);
    const double top = *std::max_element(h.begin(), h.end());
    Gap gap{grid, h};
    for (double& g : gap.value) g = top - g;
    const double member = seconds(5, [&](int k) {
      settle_droplets(gap, 5e-18, {0.072, t1, t2, 0.26}, {}, 1, static_cast<std::uint64_t>(k));
    });
    timed("droplet member, 500 droplets, 256²", "ms", 1e3 * member, 10);
  }

  void evaluations() {
    const Scene scene = scene_of(design_);
    double spent = 0;  // processor seconds of the last run
    const auto solve = [&](Fidelity f, int threads) {
      f.threads = threads;
      const double begin = processor_seconds(CLOCK_PROCESS_CPUTIME_ID);
      PatchSet patches = solve_patches(scene, design_.texture, f);
      spent = processor_seconds(CLOCK_PROCESS_CPUTIME_ID) - begin;
      return patches;
    };
    const auto run = [&](const Fidelity& f, int threads) { return solve(f, threads).seconds; };
    Fidelity search = fidelity_level("search");
    search.skins = 16;
    timed("search-level evaluation, 4 humidities x 16 skins, 128²", "s", run(search, 2), 0.15);
    timed("search-level evaluation, processor time of its two threads", "s", spent, 0.3);
    // A search makes hundreds: tables of bridges, transforms and skins' amplitudes are there then.
    std::vector<double> walls, spents;
    for (int k = 0; k < 9; ++k) {
      walls.push_back(run(search, 2));
      spents.push_back(spent);
    }
    timed("the next ones (median of nine), as in a search", "s", quantile(walls, 0.5), 0.05);
    timed("the next ones, processor time of their two threads", "s", quantile(spents, 0.5), 0.1);
    Fidelity level = fidelity_level("design");
    const PatchSet patches = solve(level, 2);
    timed("design-level evaluation, 4 humidities x 40 skins, 256²", "s", patches.seconds, 4);
    timed("design-level evaluation, processor time of its two threads", "s", spent, 8);
    const Response r = respond(scene, level, patches);
    const auto k = kernel(patches.plan.grid);
    timed("design level over its floor of two pairs per solve, processor time", "",
          spent / (2 * r.contact_solves * pair_seconds(*k)), 4);
    Fidelity part = level;
    part.skins = 8;
    const double one = run(part, 1), spent_one = spent, two = run(part, 2);
    rows_.push_back({"two threads against one", "", one / two, 1.8, false});
    rows_.push_back({"two threads against one, by processor time: shared caches and memory alone",
                     "", 2 * spent_one / spent, 1.8, false});
  }

  void count(const std::string& what, double pairs, double target) {
    rows_.push_back({what, "FFT pairs", pairs, target, true, true});
  }
  void timed(const std::string& what, const char* unit, double measured, double target) {
    rows_.push_back({what, unit, measured, target});
  }

  const BenchOptions& options_;
  Design design_;
  std::vector<BenchRow> rows_;
};

}  // namespace

std::vector<BenchRow> bench(const BenchOptions& options) { return Bench(options).run(); }

}  // namespace papilla::measure
