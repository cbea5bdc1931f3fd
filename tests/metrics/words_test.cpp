// Metrics as they are listed, written, read and shown.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "metrics/metrics.h"
#include "metrics/shown.h"

namespace papilla::tests::words_test {
namespace {

TEST(MetricWords, TheListIsWhole) {
  std::string list;
  for (const MetricInfo& m : metric_list())
    list += fmt::format("{}|{}|{}{}{}\n", m.name, m.unit,
                        m.better == Better::Higher  ? "high"
                        : m.better == Better::Lower ? "low"
                                                    : "-",
                        m.needs_drive ? " driven" : "", m.appearance ? " look" : "");
  EXPECT_EQ(list,
            "modulation||high driven\n"
            "friction|N|low\n"
            "friction_on|N|high driven\n"
            "capillary_force|N|low\n"
            "electrostatic_force|N|high driven\n"
            "retention_force|N|low\n"
            "contact_area||-\n"
            "bridges||-\n"
            "wetted_fraction||-\n"
            "mean_gap|m|-\n"
            "adhesion|N|low\n"
            "compliance|m/Pa|-\n"
            "haze||low look\n"
            "transmittance||high look\n"
            "total_transmittance||high look\n"
            "gloss||high look\n"
            "gloss_20||high look\n"
            "gloss_85||high look\n"
            "distinctness||high look\n"
            "sparkle||low look\n"
            "colour_shift||low look\n"
            "drive.amplitude|V|low driven\n"
            "voltage_for|V|low\n"
            "felt||high driven\n"
            "pull_in_margin||high driven\n");
}

TEST(MetricWords, ANameIsAMetricAsItIsWritten) {
  for (const char* name : {"modulation", "adhesion", "haze", "drive.amplitude",
                           "voltage_for(modulation = 0.5)", "felt(modulation=0.2)"})
    EXPECT_TRUE(find_metric(name)) << name;
  for (const char* name : {"voltage_for", "felt", "friction(modulation = 0.5)", "haze(", "", "mod"})
    EXPECT_FALSE(find_metric(name)) << name;
  EXPECT_EQ(info_of(Felt{0.2}).name, "felt");
  EXPECT_EQ(info_of(VoltageFor{2}).unit, "V");
}

TEST(MetricWords, AModulationOfItsOwnIsANumberAboveZero) {
  for (const auto& [text, value] : {std::pair{"voltage_for(modulation = 0.5)", 0.5},
                                    {"voltage_for(modulation=0.125)", 0.125},
                                    {" voltage_for ( modulation = 1e-3 ) ", 1e-3},
                                    {"voltage_for(modulation = 999999)", 999999.0}})
    EXPECT_EQ(find_metric(text), Metric{VoltageFor{value}}) << text;
  EXPECT_EQ(find_metric("felt(modulation = 0.2)"), Metric{Felt{0.2}});
  for (const char* other : {"voltage_format", "felter", "felter(modulation = 0.2)"})
    EXPECT_FALSE(find_metric(other)) << other;
  for (const char* wrong :
       {"voltage_for(modulation = 0)", "voltage_for(modulation = -1)",
        "voltage_for(modulation = 1e6)", "voltage_for(modulation = 0.5", "voltage_for(0.5)",
        "voltage_for(modulation = 0.5x)", "voltage_for(modulation = )"}) {
    try {
      find_metric(wrong);
      FAIL() << wrong;
    } catch (const InputError& e) {
      EXPECT_EQ(std::string(e.what()), fmt::format("\"{}\": expected voltage_for(modulation = X), "
                                                   "X above 0",
                                                   wrong));
    }
  }
}

// Every metric under every summary is written as a text that reads back to it; modulations of any
// size keep every bit.
TEST(MetricWords, ReadBackToTheSameValue) {
  RandomStream random(1, "metrics");
  int seen = 0;
  for (const MetricInfo& info : metric_list()) {
    for (int k = 0; k < (info.takes_modulation ? 200 : 1); ++k) {
      const double modulation = std::pow(10.0, -6 + 11.9 * random.uniform());
      const Metric metric = *find_metric(
          info.takes_modulation ? fmt::format("{}(modulation = {})", info.name, modulation)
                                : info.name);
      EXPECT_EQ(find_metric(metric_text(metric)), metric) << info.name;
      EXPECT_EQ(info_of(metric).name, info.name);
      for (const Summary summary : {Summary::Mean, Summary::Variation, Summary::Range, Summary::Std,
                                    Summary::Worst, Summary::Best, Summary::First, Summary::Last}) {
        const MetricExpression expression{summary, metric};
        EXPECT_EQ(parse_metric(metric_text(expression)), expression) << metric_text(expression);
        ++seen;
      }
    }
  }
  EXPECT_EQ(seen, 8 * (23 + 2 * 200));
}

TEST(MetricWords, ExpressionsAreReadAndWritten) {
  for (const auto& [text, written] :
       {std::pair{"friction", "mean(friction)"},
        {"mean(friction)", "mean(friction)"},
        {"variation(modulation)", "variation(modulation)"},
        {"range(modulation)", "range(modulation)"},
        {"std(modulation)", "std(modulation)"},
        {"worst(adhesion)", "worst(adhesion)"},
        {"best(adhesion)", "best(adhesion)"},
        {"first(haze)", "first(haze)"},
        {"last(compliance)", "last(compliance)"},
        {"felt(modulation=0.20)", "mean(felt(modulation = 0.2))"},
        {"last(felt( modulation=0.2))", "last(felt(modulation = 0.2))"},
        {"worst(voltage_for(modulation=0.5))", "worst(voltage_for(modulation = 0.5))"}})
    EXPECT_EQ(metric_text(parse_metric(text)), written);
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      parse_metric(text);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(refusal("mean(friction"), "\"mean(friction\": missing )");
  EXPECT_EQ(refusal("median(friction)"),
            "\"median\" is no summary over humidity; use one of mean, variation, range, std, "
            "worst, best, first, last");
  EXPECT_EQ(refusal("mean(modulatoin)"),
            "\"modulatoin\" is no metric, did you mean \"modulation\"?; see `papilla describe "
            "metrics`");
  EXPECT_EQ(refusal("wxyzwxyzwxyz"),
            "\"wxyzwxyzwxyz\" is no metric; see `papilla describe metrics`");
}

TEST(MetricWords, ASpreadIsBetterLow) {
  for (const auto& [text, better] : {std::pair{"modulation", Better::Higher},
                                     {"worst(modulation)", Better::Higher},
                                     {"variation(modulation)", Better::Lower},
                                     {"range(modulation)", Better::Lower},
                                     {"std(modulation)", Better::Lower},
                                     {"compliance", Better::Neither},
                                     {"std(compliance)", Better::Lower},
                                     {"last(friction)", Better::Lower}})
    EXPECT_EQ(better_direction(parse_metric(text)), better) << text;
}

// mN, nm and um/MPa; looks to a decimal beyond what instruments resolve, other shares to three
// decimals, quantities to four digits, errors to two.
TEST(MetricWords, ValuesAreShownInTheUnitsOfPeople) {
  struct Row {
    const char* metric;
    double scale;
    const char *unit, *value, *change, *error;
  };
  for (const Row& row : {Row{"friction", 1e3, "mN", "123.5", "+1.2e+02", "1.2e+02"},
                         {"worst(friction)", 1e3, "mN", "123.5", "+1.2e+02", "1.2e+02"},
                         {"std(friction)", 1e3, "mN", "123.5", "+1.2e+02", "1.2e+02"},
                         {"variation(friction)", 1, "", "0.123", "+0.12", "0.123"},
                         {"range(friction)", 1, "", "0.123", "+0.12", "0.123"},
                         {"modulation", 1, "", "0.123", "+0.12", "0.123"},
                         {"mean_gap", 1e9, "nm", "1.235e+08", "+1.2e+08", "1.2e+08"},
                         {"variation(mean_gap)", 1, "", "0.123", "+0.12", "0.123"},
                         {"compliance", 1e12, "um/MPa", "1.235e+11", "+1.2e+11", "1.2e+11"},
                         {"haze", 100, "%", "12.35", "+12", "12.35"},
                         {"worst(sparkle)", 100, "%", "12.35", "+12", "12.35"},
                         {"variation(haze)", 1, "", "0.123", "+0.12", "0.123"},
                         {"contact_area", 100, "%", "12.346", "+12", "12.346"},
                         {"last(wetted_fraction)", 100, "%", "12.346", "+12", "12.346"},
                         {"variation(contact_area)", 1, "", "0.123", "+0.12", "0.123"},
                         {"gloss", 1, "", "0.12", "+0.12", "0.12"},
                         {"colour_shift", 1, "", "0.1235", "+0.12", "0.1235"},
                         {"drive.amplitude", 1, "V", "0.1235", "+0.12", "0.12"}}) {
    const MetricExpression e = parse_metric(row.metric);
    EXPECT_EQ(shown_unit(e).scale, row.scale) << row.metric;
    EXPECT_EQ(shown_unit(e).unit, row.unit) << row.metric;
    EXPECT_EQ(shown_value(e, 0.12346), row.value) << row.metric;
    EXPECT_EQ(shown_value(e, 0.12346, true), std::string("+") + row.value) << row.metric;
    EXPECT_EQ(shown_value(e, -0.12346, true), std::string("-") + row.value) << row.metric;
    EXPECT_EQ(shown_change(e, 0.12346), row.change) << row.metric;
    EXPECT_EQ(shown_error(e, 0.12346), row.error) << row.metric;
  }
  EXPECT_EQ(shown_value(parse_metric("modulation"), -1e-9), "0.000");
  EXPECT_EQ(shown_value(parse_metric("friction"), -0.0), "0");
  // What nothing scatters has rounding alone.
  EXPECT_EQ(shown_error(parse_metric("haze"), 1e-17), "0.00");
  EXPECT_EQ(shown_change(parse_metric("friction"), -0.0), "+0");
}

TEST(MetricWords, AnErrorIsNeverShownAsNothing) {
  const MetricExpression modulation = parse_metric("modulation");
  EXPECT_EQ(shown_with_error(modulation, 0.4906, 0.0243), "0.491 ± 0.024");
  EXPECT_EQ(shown_with_error(modulation, 0.49064, 0.00031), "0.4906 ± 0.0003");
  EXPECT_EQ(shown_with_error(modulation, 4.1e-4, 1e-4, true), "+0.0004 ± 0.0001");
  // A difference that reads as nothing has no sign, which may be the wrong one.
  EXPECT_EQ(shown_with_error(modulation, -4.06e-4, 0.037, true), "0.000 ± 0.037");
  EXPECT_EQ(shown_with_error(modulation, 4.06e-4, 0.037, true), "0.000 ± 0.037");
  EXPECT_EQ(shown_with_error(parse_metric("contact_area"), 0.01637, 0.00071), "1.637 ± 0.071");
  EXPECT_EQ(shown_with_error(parse_metric("friction"), 0.1234, 0.0012), "123.4 ± 1.2");
  // What nothing scatters has its last bits.
  EXPECT_EQ(shown_with_error(parse_metric("haze"), 0.4, 1e-17), "40.00 ± 0.00");
}

// Far below what instruments read a number is the last bits of its theory.
TEST(MetricWords, NoiseIsShownAsNothing) {
  const MetricExpression haze = parse_metric("haze");
  EXPECT_EQ(without_noise(haze, 2.018e-12), 0);
  EXPECT_EQ(without_noise(haze, -2.018e-12), 0);
  EXPECT_EQ(without_noise(haze, 1e-5), 1e-5);                          // 0.001 %
  EXPECT_EQ(without_noise(parse_metric("modulation"), 1e-12), 1e-12);  // not known what resolves
}

// A voltage is that of its target, where it is reached; else people are told what came first.
TEST(MetricWords, AVoltageThatIsNotReachedSaysWhatCameFirst) {
  Response r;
  r.driven = true;
  r.points.resize(2);
  r.points[0].relative_humidity = 0.35;
  r.points[1].relative_humidity = 0.75;
  for (ResponsePoint& p : r.points) {
    VoltageAnswer low, high;
    low.target = 0.2;
    low.amplitude.value = 80;
    high.target = 0.5;
    high.amplitude.value = 120;
    p.voltages = {low, high};
  }
  EXPECT_EQ(metric_at(VoltageFor{0.2}, r.points[0])->value, 80);
  EXPECT_EQ(metric_at(VoltageFor{0.5}, r.points[0])->value, 120);
  EXPECT_FALSE(metric_at(VoltageFor{0.3}, r.points[0]));
  EXPECT_EQ(why_undefined(VoltageFor{0.5}, r), "");
  VoltageAnswer& missed = r.points[1].voltages[1];
  missed.end = VoltageEnd::Breakdown;
  missed.limit = 500;
  missed.modulation = 0.12345;
  EXPECT_FALSE(metric_at(VoltageFor{0.5}, r.points[1]));
  EXPECT_EQ(why_undefined(VoltageFor{0.5}, r),
            "75 % RH: the dielectric breaks down at 500 V (modulation 0.123)");
  EXPECT_EQ(why_undefined(VoltageFor{0.2}, r), "");
  missed.end = VoltageEnd::NoField;  // nothing was driven
  missed.limit = missed.modulation = 0;
  EXPECT_EQ(why_undefined(VoltageFor{0.5}, r),
            "75 % RH: what touches does not conduct: no field reaches it");
  r.driven = false;
  EXPECT_EQ(why_undefined(kFrictionOn, r), "not driven (0 V)");
  EXPECT_EQ(why_undefined(kFriction, r), "");
}

TEST(MetricWords, EachMetricHasTheQuantityThatCarriesItsErrors) {
  EXPECT_EQ(metric_quantity(Adhesion{}), &PointQuantities::capillary_force);
  EXPECT_EQ(metric_quantity(Compliance{}), &PointQuantities::indentation);
  EXPECT_EQ(metric_quantity(kFriction), &PointQuantities::friction_off);
  EXPECT_EQ(metric_quantity(QuantityMetric{&PointQuantities::mean_gap}),
            &PointQuantities::mean_gap);
  EXPECT_FALSE(metric_quantity(VoltageFor{0.5}));
  EXPECT_FALSE(metric_quantity(Felt{0.5}));
}

// Half where the modulation is the threshold; without an error a step, at the threshold not yet.
TEST(MetricWords, WhatIsFeltIsAStepThatErrorsSoften) {
  ResponsePoint p;
  p.modulation.value = 0.25;
  const auto felt = [&] { return metric_at(Felt{0.25}, p)->value; };
  EXPECT_EQ(felt(), 0);
  p.modulation.value = 0.2500001;
  EXPECT_EQ(felt(), 1);
  p.modulation.parts.solver = 0.1;
  p.modulation.value = 0.35;  // one standard error above
  EXPECT_NEAR(felt(), 0.8413447, 1e-6);
  EXPECT_NEAR(metric_at(Felt{0.25}, p)->parts.solver.value(), std::sqrt(0.8413447 * 0.1586553),
              1e-6);
}

}  // namespace
}  // namespace papilla::tests::words_test
