// The model beside published numbers and measured friction: the rows of a fit and their residuals.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/rooms.h"
#include "calibrate/calibration_file.h"
#include "calibrate/kept_answers.h"
#include "design/design.h"
#include "forward/response.h"
#include "numerics/statistics.h"
#include "optim/common_errors.h"
#include "optim/row_quadratics.h"
#include "published/targets.h"

namespace papilla::calibrate {

// One residual before and after.
struct FitRow {
  std::string source;  // claim id, or "line 4 F_off"
  std::string what;
  double low = 0, high = 0, sd = 0;  // what the data say; low = high: a value
  double sampling_sd = 0;            // of the model, from its skins; already in the weight
  double before = 0, after = 0;      // the model
  double miss = 0;                   // of `after`, over `deviation`
  double deviation = 0;  // sd and sampling, of which a part is common. Eq. calibration.12
  // What each skin adds to the error that this row has in common with others, over sampling_sd: the
  // sum of squares is the share of its variance that is common. Empty: none. Eq. calibration.12
  std::vector<double> common{};

  // Of what no other row shares: of the datum, and of the model.
  double own_deviation() const;
};

// The row that is missed by most, of one at least.
const FitRow& worst_row(const std::vector<FitRow>& rows);
// "the worst is line 6 (F_on of ...), -22.6 standard deviations".
std::string worst_miss_text(const std::vector<FitRow>& rows);

// Rows of one design, drive, load and state: one evaluation over their humidities.
struct MeasuredGroup {
  Design design;
  std::vector<std::size_t> rows;         // into the data
  std::vector<std::size_t> humidity_of;  // of each row, into the environment's list
};

class Residuals {
 public:
  // The calibration has to outlive this. threads 0: all. folder: for what is kept of the model's
  // answers until the fit ends (`calibrate/kept_answers.h`); empty: nothing is.
  Residuals(const Calibration& calibration, int threads, const std::string& folder = {});

  KeptAnswers& kept() { return kept_; }

  std::vector<FitRow>& rows() { return rows_; }
  int size() const { return static_cast<int>(rows_.size()); }

  // What each row is of, left out together: its claim, or its design.
  std::vector<std::string> sources() const;

  // The model at every row, with the error of its sampling. `from`: the calibration, or what it is
  // under a hypothesis; values: of its parameters.
  std::vector<Estimate> model(const Calibration& from, std::span<const double> values);

  // What a coarse level gets wrong in a friction, a factor: taken at these values from the level of
  // the checks on the same skins. Returns the largest change of a friction there in standard
  // deviations of its datum. Eq. calibration.6
  double correct(const Calibration& from, std::span<const double> values);
  // How that factor moves with the parameters: two evaluations of both levels for each, of which
  // `done` hears. Eq. calibration.6
  void follow(const Calibration& from, std::span<const double> values,
              const std::function<void(int)>& done = {});
  // The least and the largest of those factors at these values, 1 without frictions.
  std::pair<double, double> factors_between(const Calibration& from,
                                            std::span<const double> values) const;
  // What answers of the model cost when they were last computed [s]; 0: all were kept.
  double seconds_a_model() const { return target_seconds_ + fast_seconds_; }
  double seconds_a_factor() const { return fast_seconds_ + good_seconds_; }

  // What the model's skins leave open of every row at these values, and how much of it rows have in
  // common: it stays in their weights. Eq. calibration.12. Returns the model there.
  std::vector<Estimate> weigh(const Calibration& from, std::span<const double> values);
  CommonErrors common() const;
  // Distances from the bands in standard deviations, independent of one another: the data's and the
  // model's sampling error. false: the model has no answer. Eq. calibration.5
  bool residuals(const Calibration& from, std::span<const double> values, std::span<double> r);
  // `FitRow::miss` of such residuals: each by its own and the common error.
  std::vector<double> misses(std::vector<double> residuals) const;
  // The model's answers from the middle of the band, or from its one end, in standard deviations of
  // what is the row's own. `bands` in the same unit.
  bool answers(const Calibration& from, std::span<const double> values, std::span<double> r);
  bool answers(const std::vector<Estimate>& model, std::span<double> r) const;
  std::vector<RowBand> bands() const;

 private:
  // [N], with the error of the skins, and what each of them moves it by; empty: a single skin is
  // never left out.
  struct Force {
    Estimate estimate;
    std::vector<double> moves;
  };
  struct Friction {
    Force off, on;
  };
  // Logarithms of the factors of off and on.
  struct Factor {
    double off = 0, on = 0;
  };

  // Of every datum; 0 where a friction is none.
  std::vector<Factor> factors(const Finger& finger);
  // At these values by what was taken at others.
  std::vector<Factor> followed(const Calibration& from, std::span<const double> values) const;
  void group_data();
  void add_rows(const FrictionDatum& datum);
  // At every datum.
  // corrected: for what the grid leaves out of the skin (Eq. accuracy.2), at twice the price.
  std::vector<Friction> frictions(const Finger& finger, const SkinSampling& sampling,
                                  bool corrected);
  std::vector<Friction> evaluated(const Finger& finger, const SkinSampling& sampling,
                                  bool corrected) const;
  // The model at every row by the frictions at every datum.
  std::vector<Estimate> model(const Calibration& from, std::span<const double> values,
                              const std::vector<Friction>& friction);

  const Calibration& calibration_;
  int threads_;
  KeptAnswers kept_;
  std::vector<PublishedTarget> targets_;
  std::vector<MeasuredGroup> groups_;
  std::vector<Factor> factors_;              // of each datum, at corrected_at_
  std::vector<double> corrected_at_;         // coordinates of the fit; empty: never corrected
  std::vector<std::vector<Factor>> slopes_;  // [parameter][datum] per unit of its coordinate
  std::vector<FitRow> rows_;
  double target_seconds_ = 0, fast_seconds_ = 0, good_seconds_ = 0;
};

}  // namespace papilla::calibrate
