// Where an evaluation of the default study spends its time, as CSV: share of contact, water and
// field in the processor time of one thread, FFT pairs a contact solve, contact fraction and patch
// pressure. Run by hand: ninja -C build/release profile_bench && build/release/bench/profile_bench
#include <fmt/format.h>

#include "base/memory.h"
#include "design/study.h"
#include "forward/forward.h"

int main() {
  using namespace papilla::tests;
  keep_freed_memory();
  const Study study = read_study(design_roots().front() + "/m3_glass/conformal.toml");
  fmt::print(
      "finger,texture,estimator,grid,skins,seconds,contact,water,field,rest,contact_solves,"
      "pairs_per_solve,area_off_15,area_off_75,pressure_15_kPa,pressure_75_kPa\n");
  for (const bool flat : {true, false}) {
    for (const Finger& finger : study.population) {
      for (const int grid : {64, 128, 256}) {
        for (const Estimator estimator : {Estimator::Load, Estimator::Area}) {
          Fidelity f = fidelity_level(estimator == Estimator::Load ? "search" : "design");
          f.grid = grid;
          f.skins = 8;
          f.threads = 1;
          const Design& d = study.design;
          const Texture texture = flat ? Texture{} : d.texture;
          const Scene scene{d.surface, finger, d.environment, d.drive, d.model};
          const Response r = evaluate(scene, texture, f);
          const PieceSeconds& p = r.piece_seconds;
          fmt::print(
              "{},{},{},{},{},{:.3f},{:.2f},{:.2f},{:.2f},{:.2f},{},{:.1f},{:.2e},{:.2e},"
              "{:.0f},{:.0f}\n",
              finger.name, flat ? "flat" : "study", estimator == Estimator::Load ? "load" : "area",
              grid, f.skins, r.seconds, p.contact / r.seconds, p.water / r.seconds,
              p.field / r.seconds, 1 - (p.contact + p.water + p.field) / r.seconds,
              r.contact_solves, r.fft_pairs / r.contact_solves,
              r.points.front().area_fraction_off.value, r.points.back().area_fraction_off.value,
              r.points.front().patch_pressure * 1e-3, r.points.back().patch_pressure * 1e-3);
        }
      }
    }
  }
}
