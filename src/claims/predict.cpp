#include "claims/predict.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "base/constants.h"
#include "design/design.h"
#include "estimate/voltage.h"
#include "forward/appearance.h"
#include "forward/forward.h"

namespace papilla::claims {
namespace {

constexpr double kHumidity = 0.55;

// What is read off a humidity, and its unit.
struct Number {
  double (*of)(const ResponsePoint&);
  const char* unit;

  double operator()(const ResponsePoint& p) const { return of(p); }
};
constexpr Number friction_off{[](const ResponsePoint& p) { return 1e3 * p.friction_off.value; },
                              " mN"};
constexpr Number added{
    [](const ResponsePoint& p) { return 1e3 * (p.friction_on.value - p.friction_off.value); },
    " mN"};
constexpr Number modulation{[](const ResponsePoint& p) { return p.modulation.value; }, ""};
constexpr Number added_area{[](const ResponsePoint& p) {
                              return 100 * (p.area_fraction_on.value - p.area_fraction_off.value);
                            },
                            " %"};
constexpr Number pull{[](const ResponsePoint& p) { return 1e3 * p.electrostatic_force.value; },
                      " mN"};
constexpr Number capillary{[](const ResponsePoint& p) { return 1e3 * p.capillary_force.value; },
                           " mN"};

struct Setting {
  double x;  // what is varied
  std::string text;
  std::vector<std::string> keys;  // of the design
};

// A sample under one setting after another, on the same skins.
class Series {
 public:
  Series(const PredictOptions& options, const std::string& sample,
         const std::vector<Setting>& settings)
      : settings_(settings) {
    Fidelity fidelity = fidelity_level("design");
    fidelity.grid = options.grid;
    fidelity.skins = options.skins;
    fidelity.control_skins = 0;
    if (options.few) {
      fidelity.estimator = Estimator::Load;
      fidelity.field_skins = 0;
    }
    fidelity.threads = options.threads;
    for (const Setting& setting : settings) {
      const Design design = predicted_design(options.finger, sample, setting.keys);
      responses_.push_back(evaluate(scene_of(design), design.texture, fidelity));
    }
  }

  // Of a straight line through the logarithms; undefined where a number is not above 0.
  std::optional<Prediction> exponent(const std::string& id, const std::string& condition,
                                     const Number& number) const {
    const auto slope = [&](int without) -> std::optional<double> {
      double sx = 0, sy = 0, sxx = 0, sxy = 0;
      const auto n = static_cast<double>(settings_.size());
      for (std::size_t i = 0; i < settings_.size(); ++i) {
        const double y = number(point(i, without));
        if (!(y > 0)) return std::nullopt;
        const double lx = std::log(settings_[i].x), ly = std::log(y);
        sx += lx, sy += ly, sxx += lx * lx, sxy += lx * ly;
      }
      return (n * sxy - sx * sy) / (n * sxx - sx * sx);
    };
    return predicted(id, condition, "exponent", number, slope);
  }

  // The last over the first.
  std::optional<Prediction> ratio(const std::string& id, const std::string& condition,
                                  const Number& number) const {
    return predicted(id, condition, "ratio", number, [&](int without) -> std::optional<double> {
      const double first = number(point(0, without));
      if (!(first > 0)) return std::nullopt;
      return number(point(settings_.size() - 1, without)) / first;
    });
  }

 private:
  const ResponsePoint& point(std::size_t i, int without) const {
    const Response& r = responses_[i];
    return without < 0 ? r.points.front() : r.without[static_cast<std::size_t>(without)].front();
  }

  // Of what is made of the numbers of all skins (-1) and without each.
  std::optional<Prediction> predicted(const std::string& id, const std::string& condition,
                                      const std::string& quantity, const Number& number,
                                      const std::function<std::optional<double>(int)>& of) const {
    const std::optional<double> all = of(-1);
    if (!all) return std::nullopt;
    std::vector<double> without;
    for (std::size_t k = 0; k < responses_.front().without.size(); ++k) {
      const std::optional<double> one = of(static_cast<int>(k));
      if (!one) return std::nullopt;
      without.push_back(*one);
    }
    Prediction out{id, condition, quantity, "", {}, values(number)};
    out.samples = jackknife_samples(*all, without);
    out.value = {*all, mean_estimate(out.samples).se};
    return out;
  }

  std::string values(const Number& number) const {
    std::string out;
    for (std::size_t i = 0; i < settings_.size(); ++i)
      out += fmt::format("{}{}: {:.4g}{}", i ? "; " : "", settings_[i].text,
                         number(responses_[i].points.front()), number.unit);
    return out;
  }

  std::vector<Setting> settings_;
  std::vector<Response> responses_;
};

class Predictor {
 public:
  explicit Predictor(const PredictOptions& options) : options_(options) {}

  void over_load() {
    started("load");
    constexpr std::array kLoads{0.15, 0.3, 0.6, 1.25};  // [N]
    const std::string range = "flat glass, 0.15 to 1.25 N, 55 % RH, ";
    const auto settings = [&](const std::vector<std::string>& drive) {
      std::vector<Setting> out;
      for (const double load : kLoads) {
        std::vector<std::string> keys{humidity(kHumidity),
                                      fmt::format("finger.load=\"{} N\"", load)};
        keys.insert(keys.end(), drive.begin(), drive.end());
        out.push_back({load, fmt::format("{} N", load), keys});
      }
      return out;
    };
    const Series volts(options_, "flat", settings({}));
    add(volts.exponent("F_off over load", range + "200 V", friction_off));
    add(volts.exponent("added friction over load", range + "200 V", added));
    add(volts.exponent("modulation over load", range + "200 V", modulation));
    const Series amperes(options_, "flat",
                         settings({"drive.control=\"current\"", "drive.amplitude=\"0 V\"",
                                   "drive.current=\"0.2 mA\""}));
    add(amperes.exponent("added friction over load", range + "0.2 mA", added));
    add(amperes.exponent("modulation over load", range + "0.2 mA", modulation));
  }

  void over_voltage() {
    started("voltage");
    std::vector<Setting> settings;
    for (const int volts : {75, 100, 125, 150})
      settings.push_back({static_cast<double>(volts),
                          fmt::format("{} V", volts),
                          {humidity(kHumidity), fmt::format("drive.amplitude=\"{} V\"", volts)}});
    const Series series(options_, "flat", settings);
    const std::string range = "flat glass, 75 to 150 V, 5 kHz, 0.2 N, 55 % RH";
    add(series.exponent("pull over voltage", range, pull));
    add(series.exponent("added contact area over voltage", range, added_area));
    add(series.exponent("added friction over voltage", range, added));
  }

  void over_frequency() {
    started("frequency");
    for (const char* resistivity : {"1e14 ohm m", "1e8 ohm m"}) {
      std::vector<Setting> settings;
      for (const int hertz : {10, 30, 100, 300, 1000, 5000, 25000})
        settings.push_back({static_cast<double>(hertz),
                            fmt::format("{} Hz", hertz),
                            {humidity(kHumidity), fmt::format("drive.frequency=\"{} Hz\"", hertz),
                             fmt::format("surface.dielectric.0.resistivity=\"{}\"", resistivity)}});
      const Series series(options_, "flat", settings);
      add(series.ratio("added friction, 25 kHz over 10 Hz",
                       fmt::format("flat glass, 200 V, film of {}, 55 % RH", resistivity), added));
    }
  }

  void over_humidity() {
    started("humidity and roughness");
    for (const auto& [sample, text] :
         {std::pair{"flat", "smooth glass"}, {"screen_rough", "glass etched to 193 nm rms"}}) {
      const Series series(options_, sample,
                          {{0.4, "40 %", {humidity(0.4), "drive.amplitude=\"0 V\""}},
                           {0.8, "80 %", {humidity(0.8), "drive.amplitude=\"0 V\""}}});
      add(series.ratio("friction, 80 % over 40 % RH", std::string(text) + ", 0.2 N, no voltage",
                       friction_off));
    }
  }

  void over_current() {
    started("current");
    std::vector<Setting> settings;
    for (const int microamperes : {50, 100, 200})
      settings.push_back(
          {static_cast<double>(microamperes),
           fmt::format("{} uA", microamperes),
           {humidity(kHumidity), "drive.control=\"current\"", "drive.amplitude=\"0 V\"",
            fmt::format("drive.current=\"{} uA\"", microamperes)}});
    add(Series(options_, "flat", settings)
            .exponent("added friction over current",
                      "flat glass, 50 to 200 uA, 5 kHz, 0.2 N, 55 % RH", added));
  }

  // Water softens the stratum corneum; how much contact that adds depends on the relief it closes.
  void wet_over_clean() {
    started("wet over clean");
    for (const auto& [sample, text] :
         {std::pair{"flat", "smooth glass"}, {"screen_rough", "glass etched to 193 nm rms"}}) {
      for (const char* load : {"0.05 N", "0.2 N", "1 N"}) {
        std::vector<Setting> settings;
        for (const char* state : {"clean", "wet"})
          settings.push_back({0,
                              state,
                              {humidity(kHumidity), "drive.amplitude=\"0 V\"",
                               fmt::format("finger.load=\"{}\"", load),
                               fmt::format("finger.state=\"{}\"", state)}});
        add(Series(options_, sample, settings)
                .ratio("friction, wet over clean",
                       fmt::format("{}, {}, 55 % RH, no voltage", text, load), friction_off));
      }
    }
  }

  // Glass keeps the sweat in: the stratum corneum below it takes it up.
  void over_touch_time() {
    started("touch time");
    std::vector<Setting> settings;
    for (const int seconds : {1, 5, 30})
      settings.push_back({static_cast<double>(seconds),
                          fmt::format("{} s", seconds),
                          {humidity(0.35), "drive.amplitude=\"0 V\"",
                           fmt::format("finger.touch_time=\"{} s\"", seconds)}});
    add(Series(options_, "flat", settings)
            .ratio("friction, 30 s over 1 s of touch", "flat glass, 0.2 N, 35 % RH, no voltage",
                   friction_off));
  }

  void adhesion() {
    started("adhesion");
    std::vector<Setting> settings;
    for (const double load : {0.05, 0.2, 0.8})
      settings.push_back(
          {load,
           fmt::format("{} N", load),
           {humidity(0.75), "drive.amplitude=\"0 V\"", fmt::format("finger.load=\"{} N\"", load)}});
    add(Series(options_, "flat", settings)
            .exponent("capillary adhesion of the whole finger over load",
                      "flat glass, 0.05 to 0.8 N, 75 % RH, no voltage", capillary));
  }

  void look() {
    started("look");
    for (const int rms : {20, 50, 100, 200}) {
      const Design design = read_design(find_design("m3_samples/screen_rough.toml"),
                                        {fmt::format("texture.rms=\"{} nm\"", rms)});
      const Optics seen = forward::appearance(design.texture, design.surface, design.view);
      if (seen.refused()) continue;
      const std::string glass = fmt::format("etched glass, {} nm rms, roll-off 3 um", rms);
      out_.push_back({"haze", glass, "haze", "%", {100 * seen.haze, 0}, seen.warning, false});
      out_.push_back(
          {"gloss at 60 deg", glass, "gloss", "GU", {seen.gloss, 0}, seen.warning, false});
    }
  }

  // A Weber fraction of 0.2: the least modulation that most people feel.
  void felt() {
    started("felt");
    constexpr std::array kFelt{0.2};
    for (const char* sample : {"flat", "a3h600"}) {
      for (const double rh : {0.15, 0.75}) {
        const Design design = predicted_design(options_.finger, sample, {humidity(rh)});
        Fidelity fidelity = fidelity_level("draft");
        fidelity.grid = std::min(fidelity.grid, options_.grid);
        fidelity.skins = std::min(fidelity.skins, options_.skins);
        if (options_.few) fidelity.field_skins = fidelity.control_skins = 0;
        fidelity.threads = options_.threads;
        const Scene scene = scene_of(design);
        Response response = evaluate(scene, design.texture, fidelity);
        add_voltages(response, scene, design.texture, fidelity, kFelt);
        const VoltageAnswer& answer = response.points.front().voltages.front();
        if (!answer.reached()) continue;
        out_.push_back({"amplitude that is felt (modulation 0.2)",
                        fmt::format("{}, {:.0f} % RH, 0.2 N, 5 kHz", sample, 100 * rh),
                        "amplitude",
                        "V",
                        {answer.amplitude.value, answer.amplitude.se()},
                        ""});
      }
    }
  }

  std::vector<Prediction> all() && { return std::move(out_); }

 private:
  static std::string humidity(double rh) {
    return fmt::format("environment.relative_humidity=[\"{:.0f} %\"]", 100 * rh);
  }
  void started(const std::string& experiment) const {
    if (options_.started) options_.started(experiment);
  }
  void add(std::optional<Prediction> prediction) {
    if (prediction) out_.push_back(std::move(*prediction));
  }

  const PredictOptions& options_;
  std::vector<Prediction> out_;
};

}  // namespace

Design predicted_design(const Finger& finger, const std::string& sample,
                        const std::vector<std::string>& keys) {
  Design out = read_design(find_design("m3_samples/" + sample + ".toml"), keys);
  out.finger = finger.touching_as(out.finger);
  out.model = finger.calibrated_for;
  return out;
}

std::vector<Prediction> predictions(const PredictOptions& options) {
  Predictor predictor(options);
  predictor.over_load();
  predictor.over_voltage();
  predictor.over_frequency();
  predictor.over_current();
  predictor.over_humidity();
  predictor.wet_over_clean();
  predictor.over_touch_time();
  predictor.adhesion();
  if (!options.few) predictor.look();
  predictor.felt();
  return std::move(predictor).all();
}

}  // namespace papilla::claims
