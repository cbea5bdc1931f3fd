// A tribometer with a finger on it: records whose friction, zero, drift and slips are known.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "base/constants.h"
#include "base/random.h"

namespace papilla::tests {

struct Tribometer {
  double off = 0.1, on = 0.14;  // friction [N]; on 0: never driven
  double load = 0.2;            // [N]
  double voltage = 200;         // peak [V]
  double humidity = 0.35;
  double rate = 1000;                     // samples a second
  int strokes = 12;                       // to and fro
  double stroke = 2;                      // [s]
  double noise = 2e-3;                    // of the force [N]
  double zero = 0.02, zero_drift = 0.01;  // of the sensor [N]: at the start, over the record
  double drift = 0;                       // of the friction over the record, a share
  double lag = 0;                         // of the friction behind the drive [s]
  double slip = 0;                        // saw tooth of the force [N]
  double drive_period = 0.8;              // on for a half of it [s]
  bool milliseconds = false;              // how the time is written
  std::uint64_t seed = 1;

  // "time_s,tangential_N,normal_N,voltage_V,humidity_percent,position_mm", lines of `head` before.
  std::string record(const std::string& head = "") const {
    RandomStream random(seed, "tribometer");
    std::string out = head + (milliseconds ? "time_ms" : "time_s") +
                      ",tangential_N,normal_N,voltage_V,humidity_percent,position_mm\n";
    const int per_stroke = static_cast<int>(stroke * rate), all = strokes * per_stroke;
    out.reserve(static_cast<std::size_t>(all) * 56);
    double reached = 0, saw = 0;  // the force follows the slide over the finger's compliance
    for (int i = 0; i < all; ++i) {
      const double t = i / rate, late = static_cast<double>(i) / all - 0.5;
      const int direction = (i / per_stroke) % 2 == 0 ? 1 : -1;
      const double along = static_cast<double>(i % per_stroke) / per_stroke;
      const auto is_on = [&](double when) {
        return on > 0 && when > 0 && std::fmod(when, drive_period) < drive_period / 2;
      };
      const double friction = (is_on(t - lag) ? on : off) * (1 + drift * late);
      const double wanted = direction * friction;
      // It turns round within 3 % of a stroke; where the drive acts it follows at once.
      const double step = 2.5 * friction / (0.03 * per_stroke);
      if (reached * direction < 0 || std::abs(reached) < 0.7 * off)
        reached += direction * step;
      else
        reached = wanted;
      saw = saw + slip / (0.025 * rate * stroke);
      if (saw > slip) saw = 0;
      const double force = reached + direction * (saw - slip / 2) * (along > 0.05) + zero +
                           zero_drift * (late + 0.5) + noise * random.normal();
      const double position = direction > 0 ? 30 * along : 30 * (1 - along);  // [mm]
      out += fmt::format("{:.6f},{:.6f},{:.5f},{:.4g},{:.4g},{:.4f}\n", milliseconds ? 1e3 * t : t,
                         force, load + 0.5 * noise * random.normal(),
                         is_on(t) ? voltage * std::sin(2 * kPi * 37.7 * t) : 0.0, 100 * humidity,
                         position);
    }
    return out;
  }
};

}  // namespace papilla::tests
