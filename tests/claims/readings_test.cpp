// What the claims about the M3 samples read off them, on three skins of few pixels: every number
// and its sign against the means of the samples.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "claims/papers.h"
#include "forward/forward.h"

namespace papilla::tests::readings_test {
namespace {

class ReadingsOfFewSkins : public ::testing::Test {
 protected:
  Judgement judge(const std::string& id) {
    for (const Claim& c : m3_claims()) {
      if (c.id == id) return c.judge(model_);
    }
    ADD_FAILURE() << "no claim " << id;
    return {};
  }

  // The reason says "name value ± error" with three digits, and "(no)" where a sign is not sure.
  static void expect_reading(const Judgement& j, const std::string& name, const SkinEstimate& e,
                             bool holds) {
    const std::size_t at = j.reason.find(name + " ");
    ASSERT_NE(at, std::string::npos) << name << " in " << j.reason;
    const std::string rest = j.reason.substr(at + name.size() + 1);
    EXPECT_NEAR(std::stod(rest), e.value, 0.006 * std::abs(e.value) + 1e-9) << name;
    const std::string one = rest.substr(0, rest.find(';'));
    EXPECT_EQ(one.find("(no)") == std::string::npos, holds) << name << ": " << one;
  }

  const Sample& of(const std::string& name, double angle = 0) {
    return m3_sample(model_, name, angle);
  }
  // Relative change from a to b.
  template <class F>
  SkinEstimate change(const Sample& a, const Sample& b, F&& f, double unit = 100) {
    return jackknife(a, [&](Skins over) { return unit * (f(b, over) / f(a, over) - 1); });
  }

  FingerModel model_{
      Finger{}, Preset::Papilla, 1, {.level = "search", .skins = 3, .first_skin = 7, .grid = 32}};
};

TEST_F(ReadingsOfFewSkins, FrictionRisesFromDryToWet) {
  for (const auto& [id, friction] :
       {std::pair{"M1", &friction_off}, std::pair{"M2", &friction_on}}) {
    const Judgement j = judge(id);
    for (const std::string& name : m3_sample_names()) {
      const SkinEstimate e = jackknife(of(name), [&](Skins over) {
        return friction(of(name), kWet, over) / friction(of(name), kDry, over);
      });
      expect_reading(j, name, e, e.value >= 1.6 && e.value <= 2.4);
    }
  }
}

TEST_F(ReadingsOfFewSkins, LargerHolesAreComparedWithSmaller) {
  const Judgement j = judge("M8");
  for (int rh = 0; rh < kHumidities; ++rh) {
    const SkinEstimate e = change(of("a3h600"), of("a4h600"), [rh](const Sample& s, Skins over) {
      return friction_off(s, rh, over);
    });
    expect_reading(j, "a4h600 against a3h600 at " + std::to_string(15 + 20 * rh) + " % RH, %", e,
                   negative(e));
  }
}

TEST_F(ReadingsOfFewSkins, TheEffectRisesOrFallsFromOneHumidityToAnother) {
  const Judgement course = judge("M9"), constant = judge("M10"), dry = judge("M26");
  const auto step = [&](const Sample& s, int from, int to) {
    return jackknife(s,
                     [&](Skins over) { return effect(s, to, over) / effect(s, from, over) - 1; });
  };
  for (const char* name : {"flat", "a4h350", "a3h600"}) {
    const SkinEstimate up = step(of(name), 0, 1), down = step(of(name), 1, 3);
    expect_reading(course, std::string(name) + " 15 to 35 %", up, positive(up));
    expect_reading(course, std::string(name) + " 35 to 75 %", down, negative(down));
  }
  for (int rh = 1; rh < 4; ++rh) {
    const SkinEstimate e = step(of("a3h900"), 0, rh);
    expect_reading(constant, "a3h900 at " + std::to_string(15 + 20 * rh) + " % RH", e,
                   e.value >= -0.25 && e.value <= 0.05);
  }
  const Sample& without = sample(model_, {.design = "m3_samples/flat.toml", .water = false});
  for (int rh = 0; rh < 3; ++rh) {
    const SkinEstimate e = step(without, rh, rh + 1);
    expect_reading(dry,
                   std::to_string(15 + 20 * rh) + " to " + std::to_string(35 + 20 * rh) + " % RH",
                   e, positive(e));
  }
}

TEST_F(ReadingsOfFewSkins, TheStrongerOfAPairIsComparedWithTheWeaker) {
  for (const auto& [id, quantity] :
       {std::pair{"M11", &mean_modulation}, std::pair{"M12", &range_over_mean}}) {
    const Judgement j = judge(id);
    for (const auto& [strong, weak] : {std::pair{"a3h600", "a4h600"}, std::pair{"a4h350", "a4h600"},
                                       std::pair{"a3h600", "a3h900"}}) {
      const SkinEstimate e = change(of(weak), of(strong), quantity);
      expect_reading(j, std::string(strong) + " against " + weak + ", %", e, positive(e));
    }
  }
}

TEST_F(ReadingsOfFewSkins, AHydrophobicSampleIsComparedWithItsOwn) {
  const Judgement gain = judge("M13"), friction = judge("M16");
  for (const char* name : {"flat", "a3h350"}) {
    for (int rh = 0; rh < kHumidities; ++rh) {
      const std::string at = std::string(name) + " at " + std::to_string(15 + 20 * rh) + " % RH, %";
      const SkinEstimate m = change(of(name), of(name, 110), [rh](const Sample& s, Skins over) {
        return modulation(s, rh, over);
      });
      expect_reading(gain, at, m, rh == 3 ? m.value >= 90 && m.value <= 170 : positive(m));
      const SkinEstimate f = change(of(name), of(name, 110), [rh](const Sample& s, Skins over) {
        return friction_off(s, rh, over);
      });
      expect_reading(friction, at, f, negative(f));
    }
  }
}

TEST_F(ReadingsOfFewSkins, ThePullFallsFromDryToWet) {
  const Judgement j = judge("M21");
  for (const std::string& name : m3_sample_names()) {
    const Sample& s = of(name);
    const auto pull = [&](int rh, Skins over) {
      return over.mean(s.at(rh).load_on) - over.mean(s.at(rh).load_off);
    };
    const SkinEstimate e =
        jackknife(s, [&](Skins over) { return pull(3, over) / pull(0, over) - 1; });
    expect_reading(j, name, e, negative(e));
  }
}

TEST_F(ReadingsOfFewSkins, TheVariationIsReadInFourWays) {
  const Judgement j = judge("M14");
  double best = 1e9, shown = 0;
  for (const double angle : {110.0, 0.0}) {
    for (const auto& [name, measure] :
         {std::pair{"range/mean", &range_over_mean}, std::pair{"sd/mean", &deviation_over_mean}}) {
      const auto percent = [&, of_sample = measure](const Sample& s) {
        return jackknife(s, [&](Skins over) { return 100 * of_sample(s, over); });
      };
      const SkinEstimate flat = percent(of("flat", angle)), holes = percent(of("a3h350", 110));
      const std::string text = fmt::format("{}{}: {:.1f} ± {:.1f} to {:.1f} ± {:.1f} %",
                                           angle > 0 ? "both 110°, " : "flat 50°, a3h350 110°, ",
                                           name, flat.value, flat.se, holes.value, holes.se);
      EXPECT_NE(j.reason.find(text), std::string::npos) << text << "\n" << j.reason;
      const double miss = std::max(std::abs(flat.value - 27.3), std::abs(holes.value - 6.7));
      if (miss < best) shown = holes.value;
      best = std::min(best, miss);
    }
  }
  EXPECT_DOUBLE_EQ(j.value, shown);
  EXPECT_EQ(j.verdict, best <= 5 ? Verdict::Agrees : Verdict::Differs);
}

TEST_F(ReadingsOfFewSkins, RestingSamplesAreComparedByTheirCapillaryForces) {
  const Judgement by_diameter = judge("M6"), by_depth = judge("M7");
  for (int rh : {2, 3}) {
    const auto force = [rh](const Sample& s, Skins over) { return capillary_load(s, rh, over); };
    const auto resting = [&](const char* name) -> const Sample& {
      return m3_sample_at_rest(model_, name);
    };
    const std::string at = " at " + std::to_string(15 + 20 * rh) + " % RH, %";
    const SkinEstimate wide = change(resting("a3h600"), resting("a4h600"), force),
                       deep = change(resting("a3h350"), resting("a3h900"), force);
    expect_reading(by_diameter, "a4h600 against a3h600" + at, wide, negative(wide));
    expect_reading(by_depth, "a3h900 against a3h350" + at, deep,
                   !positive(deep) && !negative(deep));
  }
}

// Of films: friction, area and indentation of one against another, region by region.
TEST_F(ReadingsOfFewSkins, FilmsAreComparedRegionByRegion) {
  const Judgement clean = judge("M19"), sweaty = judge("M20"), soft = judge("M23"),
                  area = judge("M28");
  for (int region = 1; region <= 3; ++region) {
    const auto film = [&](const char* size, FingerState state) -> const Sample& {
      return sample(model_, {.design = fmt::format("coatings/hdpe_{}_{}.toml", size, region),
                             .state = state});
    };
    const Sample &large = film("large", FingerState::Clean),
                 &small = film("small", FingerState::Clean),
                 &large_wet = film("large", FingerState::Natural),
                 &small_wet = film("small", FingerState::Natural);
    const auto friction = [](const Sample& s, Skins over) { return friction_off(s, 0, over); };
    const auto touching = [](const Sample& s, Skins over) { return over.mean(s.at(0).area_off); };
    const std::string name = fmt::format("small against large, region {}, %", region);
    const SkinEstimate dry = change(large, small, friction),
                       wet = change(large_wet, small_wet, friction),
                       more = change(large, large_wet, touching);
    expect_reading(clean, name, dry, negative(dry));
    expect_reading(sweaty, name, wet, positive(wet));
    expect_reading(area, fmt::format("large {}, %", region), more, positive(more));
    const ResponsePoint &a = large.point(0), &b = small.point(0);
    const SkinEstimate softer{
        {1e12 * (a.indentation.value / a.patch_pressure - b.indentation.value / b.patch_pressure),
         1e12 * std::hypot(a.indentation.se() / a.patch_pressure,
                           b.indentation.se() / b.patch_pressure)},
        3};
    expect_reading(soft, fmt::format("large minus small, region {}, um/MPa", region), softer,
                   positive(softer));
  }
}

// A floor lies deeper than half of the depth below the lands.
TEST_F(ReadingsOfFewSkins, BridgesAreCountedWhereTheirDropletsStand) {
  const Judgement j = judge("M27");
  const SampleCase c{.design = "m3_samples/a3h350.toml"};
  const Design d = read_case(c);
  int floor = 0, all = 0;
  for (int k = 0; k < 8; ++k) {
    const PatchPicture p =
        picture_patch(scene_of(model_, c, d), d.texture, model_.fidelity(), 0.75, k);
    const Grid& g = p.texture.grid;
    for (const Droplet& drop : p.fields.wetting_off.droplets) {
      if (drop.state != DropletState::Bridge) continue;
      const int ix = static_cast<int>(std::floor(drop.x / g.lx * g.nx)) % g.nx,
                iy = static_cast<int>(std::floor(drop.y / g.ly * g.ny)) % g.ny;
      ++all;
      floor += p.texture.z[g.index(ix, iy)] < -175e-9;  // lands at 0, floors at -350 nm
    }
  }
  ASSERT_GT(all, 0);
  EXPECT_NEAR(j.value, 100.0 * floor / all, 1e-9);
  EXPECT_NEAR(j.se, 100 * std::sqrt(std::max(floor, 1)) / all, 1e-9);
  EXPECT_NE(j.reason.find(fmt::format("{} of {} bridges", floor, all)), std::string::npos);
}

TEST_F(ReadingsOfFewSkins, ScreensAndAspectRatiosByTheirMeansAndRanges) {
  const Judgement screens = judge("M22"), aspect = judge("M25");
  const auto at = [&](const std::string& name) -> const Sample& {
    return sample(model_, {.design = "m3_samples/" + name + ".toml"});
  };
  const auto less = [](const Sample& a, const Sample& b, double (*f)(const Sample&, Skins)) {
    return jackknife(a, [&](Skins over) { return f(a, over) - f(b, over); });
  };
  for (const auto& [a, b] : {std::pair{"smooth", "middle"}, std::pair{"middle", "rough"}}) {
    const Sample &first = at(fmt::format("screen_{}", a)),
                 &second = at(fmt::format("screen_{}", b));
    const SkinEstimate mean = less(first, second, mean_modulation),
                       range = less(first, second, range_over_mean);
    expect_reading(screens, fmt::format("mean, {} over {}", a, b), mean, positive(mean));
    expect_reading(screens, fmt::format("range/mean, {} over {}", a, b), range, positive(range));
  }
  const SkinEstimate e = less(at("dense_deep"), at("dense_shallow"), range_over_mean);
  EXPECT_DOUBLE_EQ(aspect.value, e.value);
  EXPECT_DOUBLE_EQ(aspect.se, e.se);
  EXPECT_EQ(aspect.verdict, negative(e) ? Verdict::Agrees : Verdict::Differs);
}

TEST_F(ReadingsOfFewSkins, AreasGrowWithHumidityOnThePatchAndOnTheFinger) {
  const Judgement real = judge("M4"), gross = judge("M3");
  const SkinEstimate patch = jackknife(of("flat"), [&](Skins over) {
    return 100 * (over.mean(of("flat").at(3).area_off) / over.mean(of("flat").at(0).area_off) - 1);
  });
  EXPECT_NEAR(real.value, patch.value, 1e-9);
  EXPECT_EQ(real.verdict, std::abs(patch.value - 45.5) <= 8 ? Verdict::Agrees : Verdict::Differs);
  const double strength = of("flat").point(3).strength / of("flat").point(0).strength;
  EXPECT_NE(real.reason.find(fmt::format("the whole finger +{:.0f} %",
                                         100 * ((1 + patch.value / 100) * strength - 1))),
            std::string::npos)
      << real.reason;
  const MacroContact& macro = model_.finger().macro;
  EXPECT_NEAR(gross.value, 100 * (macro.gross_area(0.2, 0.75) / macro.gross_area(0.2, 0.15) - 1),
              1e-9);
}

}  // namespace
}  // namespace papilla::tests::readings_test
