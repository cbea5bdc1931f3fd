// Planted errors of the model, and none; the instrument's own scatter from its repeats.
#include "lab/discrepancy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lab/gauge.h"
#include "tests/lab/ensembles.h"

namespace papilla::tests::discrepancy_test {
namespace {

// Ten rows that one number moves alike; readings of a member with some of them off by a factor.
Discrepancies found(double planted) {
  const std::vector<std::vector<double>> same(10, {0.3});
  const Ensemble e = linear_ensemble(50, same, {{1.0}, {0.0}});
  const Kernels k = kernels_of(e);
  const Instrument instrument{0.02, 0.03, 0.05, 0.01};
  Evidence evidence(e, k, instrument);
  RandomStream random(3, "planted");
  for (std::size_t i = 0; i < 10; ++i) {
    const double wrong = i >= 7 ? planted : 0;
    evidence.add(observation(i, 0.02, i), e.responses[i][20] + wrong + 0.02 * random.normal());
  }
  return discrepancies(
      e, evidence,
      {{"of the first", {0, 1, 2}}, {"of the last", {7, 8, 9}}, {"at even ones", {0, 2, 4, 6, 8}}},
      std::log(1.2));
}

TEST(Discrepancy, IsFoundWhereItIsWithItsSize) {
  const Discrepancies d = found(std::log(1.2));
  EXPECT_LT(d.none, 0.01);
  EXPECT_EQ(d.found.front().where, "of the last");
  EXPECT_GT(d.found.front().probability, 0.98);
  EXPECT_NEAR(d.found.front().shift, std::log(1.2), 3 * d.found.front().deviation);
  EXPECT_LT(d.found.front().deviation, 0.05);
}

// A tenth of the logarithm about a half is a twentieth of the friction.
TEST(Discrepancy, HasItsErrorAsAShareOfTheFrictionToo) {
  const Discrepancy d{"of the last", 1, std::log(0.5), 0.1};
  EXPECT_NEAR(d.change(), -0.5, 1e-12);
  EXPECT_NEAR(d.change_deviation(), 0.05, 1e-12);
}

TEST(Discrepancy, IsNotSeenWhereThereIsNone) {
  const Discrepancies d = found(0);
  EXPECT_GT(d.none, 0.7);
  double sum = d.none;
  for (const Discrepancy& one : d.found) sum += one.probability;
  EXPECT_NEAR(sum, 1, 1e-12);
}

TEST(Gauge, PartsRepeatsDaysAndFingers) {
  RandomStream random(9, "gauge");
  std::vector<FrictionReading> readings;
  for (int finger = 0; finger < 60; ++finger) {
    const double of_finger = 0.2 * random.normal();
    for (int day = 0; day < 3; ++day) {
      const double of_day = 0.08 * random.normal();
      for (int repeat = 0; repeat < 4; ++repeat) {
        FrictionReading r;
        r.finger = std::to_string(finger);
        r.day = std::to_string(day);
        r.off = 0.1 * std::exp(of_finger + of_day + 0.03 * random.normal());
        readings.push_back(r);
      }
    }
  }
  const Gauge g = gauge_of(readings);
  // A deviation from n differences is known to 1 / sqrt(2 n).
  EXPECT_EQ(g.repeatability.freedom, 540);
  EXPECT_NEAR(g.repeatability.deviation, 0.03, 3 * 0.03 / std::sqrt(2 * 540.0));
  EXPECT_NEAR(g.day_to_day.deviation, 0.08, 3 * 0.08 / std::sqrt(2 * 120.0));
  EXPECT_NEAR(g.finger_to_finger.deviation, 0.2, 3 * 0.2 / std::sqrt(2 * 59.0));
  const Instrument stated{0.01, 0.1, 0.1, 0.03};
  const Instrument used = after_gauge(stated, g);
  EXPECT_EQ(used.repeatability, g.repeatability.deviation);
  EXPECT_EQ(used.day_to_day, stated.day_to_day);
  EXPECT_EQ(used.model, stated.model);
}

FrictionReading gauge_reading(int design, int finger, int day, double logarithm) {
  FrictionReading r;
  r.experiment.design = static_cast<std::size_t>(design);
  r.finger = std::to_string(finger);
  r.day = std::to_string(day);
  r.off = 0.1 * std::exp(logarithm);
  return r;
}

// Ten designs, off and on, that one finger touches on two days: all see the same difference of
// these days. So it is with two fingers.
TEST(Gauge, CountsADifferenceOfTwoDaysOrFingersOnce) {
  const auto gauge = [](bool two_fingers) {
    std::vector<FrictionReading> readings;
    for (int design = 0; design < 10; ++design) {
      for (int second : {0, 1}) {
        FrictionReading r = gauge_reading(design, two_fingers ? second : 0,
                                          two_fingers ? 0 : second, second == 0 ? 0 : 0.6);
        r.on = 1.2 * r.off;
        readings.push_back(r);
      }
    }
    return gauge_of(readings);
  };
  const Instrument stated{0.01, 0.1, 0.1, 0.03};
  const Gauge days = gauge(false), fingers = gauge(true);
  EXPECT_EQ(days.day_to_day.freedom, 1);
  EXPECT_NEAR(days.day_to_day.deviation, 0.6 / std::sqrt(2.0), 1e-9);
  EXPECT_EQ(after_gauge(stated, days).day_to_day, stated.day_to_day);
  EXPECT_EQ(fingers.finger_to_finger.freedom, 1);
  EXPECT_EQ(after_gauge(stated, fingers).finger_to_finger, stated.finger_to_finger);
}

// Readings scatter by what they state and by .02 beside it: the covariance of readings adds both
// (Eq. lab.1), days and fingers have neither.
TEST(Gauge, TakesWhatReadingsStateOffTheirRepeatability) {
  RandomStream random(13, "gauge");
  std::vector<FrictionReading> readings;
  for (int finger = 0; finger < 1000; ++finger) {
    const double of_finger = 0.05 * random.normal();
    for (int day = 0; day < 2; ++day) {
      const double of_day = 0.05 * random.normal();
      for (int repeat = 0; repeat < 2; ++repeat) {
        readings.push_back(gauge_reading(
            0, finger, day, of_finger + of_day + std::hypot(0.02, 0.04) * random.normal()));
        readings.back().off_sd = 0.04 * readings.back().off;
      }
    }
  }
  const Gauge g = gauge_of(readings);
  EXPECT_NEAR(g.repeatability.deviation, 0.02, 0.004);
  EXPECT_NEAR(g.day_to_day.deviation, 0.05, 0.005);
  EXPECT_NEAR(g.finger_to_finger.deviation, 0.05, 0.007);
}

// No finger has a second day: what repeats differ by is none of the fingers'.
TEST(Gauge, TakesRepeatsOffFingersOfOneDay) {
  RandomStream random(11, "gauge");
  std::vector<FrictionReading> readings;
  for (int finger = 0; finger < 3000; ++finger) {
    const double of_finger = 0.1 * random.normal();
    for (int repeat = 0; repeat < 2; ++repeat)
      readings.push_back(gauge_reading(0, finger, 0, of_finger + 0.2 * random.normal()));
  }
  const Gauge g = gauge_of(readings);
  EXPECT_EQ(g.day_to_day.freedom, 0);
  // .17 with that of the repeats. A variance of .03 is known to 3 %.
  EXPECT_NEAR(g.finger_to_finger.deviation, 0.1, 0.03);
}

// Fingers of one to three days, of one touch on the first, two on the second and three on the
// third, and designs that one finger touched once, which say nothing of how fingers or days differ.
TEST(Gauge, PartsFingersOfUnlikeNumbersOfReadings) {
  RandomStream random(12, "gauge");
  std::vector<FrictionReading> readings;
  for (int finger = 0; finger < 6000; ++finger) {
    const double of_finger = 0.1 * random.normal();
    for (int day = 0; day <= finger % 3; ++day) {
      const double of_day = 0.1 * random.normal();
      for (int repeat = 0; repeat <= day; ++repeat)
        readings.push_back(
            gauge_reading(0, finger, day, of_finger + of_day + 0.2 * random.normal()));
    }
  }
  for (int design = 1; design <= 2000; ++design)
    readings.push_back(gauge_reading(design, 0, 0, 0.3 * random.normal()));
  const Gauge g = gauge_of(readings);
  EXPECT_NEAR(g.repeatability.deviation, 0.2, 0.02);
  EXPECT_NEAR(g.day_to_day.deviation, 0.1, 0.03);
  EXPECT_NEAR(g.finger_to_finger.deviation, 0.1, 0.03);
}

}  // namespace
}  // namespace papilla::tests::discrepancy_test
