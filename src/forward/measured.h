// A number of the forward model with its standard errors by origin.
#pragma once

#include <array>
#include <optional>

#include "base/rooms.h"

namespace papilla::forward {

// One standard error by origin, in the unit of the value; nothing where it was not measured.
// Independent: they add in squares. docs/theory/accuracy.md
struct ErrorParts {
  double sampling = 0;                 // skins, offsets, droplets
  std::optional<double> grid{};        // discretisation
  std::optional<double> solver{};      // tolerance of the contact solve
  std::optional<double> humidity{};    // quadrature over humidity (none at a point)
  std::optional<double> method{};      // load law in place of solved areas
  std::optional<double> field{};       // of the pull, against the 3-D field
  std::optional<double> parameters{};  // of the finger, from the covariance of its fit; in the
                                       // place of `model` where the finger has no belief

  // What is not known of finger and model: standard deviation over the members of the finger's
  // belief (Eq. accuracy.15). Common to all designs, so told apart from the total.
  std::optional<double> model{};

  // Half the band that the free choices of the droplets leave (mobility, number per volume; Eqs.
  // capillary.19, 20), with threshold water its distance from droplets (Eq. capillary.21): common
  // to all designs and no standard error, so it is not in the total.
  std::optional<double> water{};

  double total() const;
  // The two parts that people are told of: all that skins, grids and methods leave, and what is not
  // known of finger and model. Nothing where nobody has asked, or nothing is known.
  double numerical() const;
  std::optional<double> model_part() const { return model ? model : parameters; }
  bool operator==(const ErrorParts&) const = default;
};
struct ErrorOrigin {
  const char* name;
  std::optional<double> ErrorParts::*part;
  bool in_total = true;
};
// Every part but sampling, in the order of reports.
inline constexpr std::array<ErrorOrigin, 8> kErrorOrigins{{{"grid", &ErrorParts::grid},
                                                           {"solver", &ErrorParts::solver},
                                                           {"humidity", &ErrorParts::humidity},
                                                           {"method", &ErrorParts::method},
                                                           {"field", &ErrorParts::field},
                                                           {"parameters", &ErrorParts::parameters},
                                                           {"model", &ErrorParts::model, false},
                                                           {"water", &ErrorParts::water, false}}};

struct Measured {
  double value = 0;
  ErrorParts parts;

  double se() const { return parts.total(); }
  bool operator==(const Measured&) const = default;
};

}  // namespace papilla::forward
