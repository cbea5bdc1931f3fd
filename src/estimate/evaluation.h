// A design evaluated as it asks for itself: the one way of the program and of the library.
#pragma once

#include <optional>
#include <vector>

#include "base/rooms.h"
#include "design/design.h"
#include "forward/response.h"

namespace papilla::estimate {

struct EvaluationOptions {
  double target = 0;  // relative standard error; 0: the design's target, or its level
  // In the place of both: that of another response, which this one is compared with.
  std::optional<Fidelity> fidelity{};
  bool model = true;  // what is not known of finger and model, where the finger names a belief
  bool parameters = false;  // without belief: also the error that the finger's fitted numbers leave
  bool appearance = false;
  bool pull_in = false;             // also how far the drive is from pull-in
  std::vector<double> voltage_for;  // modulations
  int threads = 0;
};

Response evaluate_design(const Design& design, const EvaluationOptions& options = {});

// Fills `pull_in` of every point of a driven response.
void add_pull_in(Response& response, const Scene& scene, const Texture& texture,
                 const Fidelity& fidelity);

// Throws InputError where model options differ from those that the finger was fitted with: such a
// change moves the modulation by tens of percent. way_out: "run with --force".
void require_fitted_model(const Design& design, const std::string& file,
                          const std::string& way_out);
// The same of several, as of one design under the fingers of a study: each difference once.
void require_fitted_model(const std::vector<Design>& designs, const std::string& file,
                          const std::string& way_out);

}  // namespace papilla::estimate
