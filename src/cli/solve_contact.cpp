// papilla solve contact: a rigid rough surface pressed on a (layered) elastic half-space.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "base/memory.h"
#include "base/units.h"
#include "cases/contact_statistics.h"
#include "cli/commands.h"
#include "cli/scan_options.h"
#include "geometry/io/files.h"
#include "physics/contact/contact.h"
#include "report/contact_statistics.h"
#include "report/pieces.h"
#include "report/surface.h"

namespace papilla::cli {
namespace {

struct ContactCommand {
  std::string statistics, out;  // a case of statistics; its folder
  std::vector<std::string> overrides;
  ScanOptions scan;
  std::string pressure, approach, modulus;
  std::string layer_modulus, layer_thickness, bulk_modulus, counter_modulus;
  double layer_poisson = 0.5, bulk_poisson = 0.5, counter_poisson = 0.4;
  std::string method = "auto", hardness = "0 Pa", out_pressure, out_gap;
  double tolerance = 1e-8;
  int max_iterations = 1000;
  int threads = 1;
  bool json = false;
  // That only one of a case and --height, or one kind of body, obeys.
  std::vector<Option> of_case, of_height, of_layer, of_counter;
};

double positive(const std::string& text, const char* unit, const char* option) {
  const double value = parse_si(text, unit);
  if (value <= 0) throw InputError(fmt::format("{} must be positive, got \"{}\"", option, text));
  return value;
}

ContactMethod method_of(const ContactCommand& c) {
  return c.method == "dense"    ? ContactMethod::Dense
         : c.method == "sparse" ? ContactMethod::Sparse
                                : ContactMethod::Auto;
}

LayeredSolid skin_of(const ContactCommand& c) {
  if (!c.modulus.empty() == !c.layer_modulus.empty()) {
    throw InputError(
        "give either --modulus (E* of a half-space) or --layer-modulus with --layer-thickness and "
        "--bulk-modulus");
  }
  if (!c.modulus.empty()) {
    refuse(c.of_layer, "--layer-modulus, a layer on a half-space; --modulus is of all of it");
    const double e = positive(c.modulus, "MPa", "--modulus");
    return {e, 0, 0, e, 0};
  }
  if (c.layer_thickness.empty() || c.bulk_modulus.empty()) {
    throw InputError("a layer needs --layer-thickness and --bulk-modulus too");
  }
  return {positive(c.layer_modulus, "MPa", "--layer-modulus"), c.layer_poisson,
          positive(c.layer_thickness, "um", "--layer-thickness"),
          positive(c.bulk_modulus, "MPa", "--bulk-modulus"), c.bulk_poisson};
}

LayeredSolid solid_of(const ContactCommand& c) {
  LayeredSolid solid = skin_of(c);
  if (c.counter_modulus.empty()) refuse(c.of_counter, "--counter-modulus");
  if (!c.counter_modulus.empty()) {
    solid.counter_modulus = positive(c.counter_modulus, "MPa", "--counter-modulus");
    solid.counter_poisson = c.counter_poisson;
  }
  return solid;
}

int solve_case(const Context& context, const ContactCommand& command) {
  if (!command.scan.file.empty())
    throw InputError("give either a case of statistics or --height, a surface to press");
  refuse(command.of_height, "--height; a case has its own");
  const StatisticsCase c = read_statistics(command.statistics, command.overrides);
  if (!command.out.empty()) make_folder(command.out);
  const auto begin = std::chrono::steady_clock::now();
  const StatisticsResult r = solve_statistics(c, command.threads);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!command.out.empty()) {
    write_bytes(command.out + "/gaps.csv", gap_distribution_csv(r));
    write_bytes(command.out + "/stresses.csv", stress_distribution_csv(r));
    context.note("wrote " + command.out);
  }
  std::cout << (command.json ? statistics_json(c, r, seconds) + '\n'
                             : statistics_text(c, r, seconds));
  return r.converged ? kSuccess : kWorkFailed;
}

int solve(const ContactCommand& c) {
  if (c.scan.file.empty())
    throw InputError(
        "give a surface, --height FILE, or a case of statistics, e.g. "
        "designs/physics/rough_contact.toml");
  refuse(c.of_case, "a case of statistics, and --height names a surface");
  const LayeredSolid solid = solid_of(c);
  if (c.pressure.empty() == c.approach.empty()) {
    throw InputError("give either --pressure or --approach");
  }
  const double pressure = c.pressure.empty() ? 0 : parse_si(c.pressure, "kPa");
  if (pressure < 0) throw InputError("--pressure must not be negative");
  // Far beyond what a linear solid stands for; at 1e12 of it round-off is all that is left.
  constexpr double kMostStrain = 100;
  if (pressure > kMostStrain * std::max(solid.layer_modulus, solid.bulk_modulus)) {
    throw InputError(fmt::format("--pressure: {} is more than {:.0f} times the modulus", c.pressure,
                                 kMostStrain));
  }
  const double approach = c.approach.empty() ? 0 : positive(c.approach, "nm", "--approach");
  const ContactOptions options{.tolerance = c.tolerance,
                               .hardness = parse_si(c.hardness, "MPa"),
                               .max_iterations = c.max_iterations,
                               .method = method_of(c)};
  if (approach > 0 && options.method == ContactMethod::Sparse) {
    throw InputError("the sparse method needs a load: --pressure");
  }
  if (options.hardness < 0) throw InputError("--hardness must not be negative");
  const auto [h, changes] = read_scan(c.scan.source());
  require_memory(150.0 * static_cast<double>(h.grid.size()), "a contact of " + c.scan.file);
  const auto kernel = make_contact_kernel(h.grid, solid);
  const auto begin = std::chrono::steady_clock::now();
  const ContactSolution s = approach > 0 ? solve_approach(*kernel, h.z, approach, options)
                                         : solve_contact(*kernel, h.z, pressure, {}, options);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (s.status == ContactStatus::Invalid) throw InputError(s.reason);
  const ContactArea area = measure_area(*kernel, s, options.hardness);
  if (!c.out_pressure.empty()) write_npy(c.out_pressure, {h.grid, s.pressure});
  if (!c.out_gap.empty()) write_npy(c.out_gap, {h.grid, s.gap});
  say_scan(c.scan.file, changes);
  std::cout << (c.json ? with_scan(contact_json(s, area, h, seconds), c.scan.file, changes) + '\n'
                       : contact_text(s, area, h, seconds));
  return s.converged() ? kSuccess : kWorkFailed;
}

}  // namespace

void add_solve_contact(Command solve_command, Context& context) {
  Command command = solve_command.add_command(
      "contact", "Rough contact of a rigid surface with a layered elastic half-space");
  auto c = std::make_shared<ContactCommand>();
  command
      .add_option("case", c->statistics,
                  "Statistics of a stated spectrum over seeds, e.g. "
                  "designs/physics/rough_contact.toml")
      .type_name("CASE.toml");
  c->of_case = {
      add_set_option(command, c->overrides),
      command.add_option("--jobs,--threads", c->threads, "Threads of a case; a surface takes one")
          .range(1, 1024)
          .show_default(),
      command
          .add_option("--out", c->out,
                      "Of a case: also the distributions of gaps and pressures as tables")
          .type_name("DIR")};
  command.add_option("--height", c->scan.file,
                     "Or a heightmap (.npy .gsf .exr .tif .x3p), high touches first");
  c->of_height = add_scan_options(command, c->scan);
  const auto of_height = [&](const Option& option) {
    c->of_height.push_back(option);
    return option;
  };
  of_height(command.add_option("--pressure", c->pressure, "Mean pressure: \"15 kPa\""));
  of_height(command.add_option("--approach", c->approach,
                               "Or the rigid approach from first touch: \"120 nm\""));
  of_height(
      command.add_option("--modulus", c->modulus, "E* of a homogeneous half-space: \"53 MPa\""));
  of_height(command.add_option("--layer-modulus", c->layer_modulus,
                               "Or a layer on a half-space: its Young's modulus"));
  c->of_layer = {
      of_height(command.add_option("--layer-poisson", c->layer_poisson, "Its Poisson ratio")
                    .range(0.0, 0.5)
                    .show_default()),
      of_height(command.add_option("--layer-thickness", c->layer_thickness, "Its thickness")),
      of_height(command.add_option("--bulk-modulus", c->bulk_modulus, "Young's modulus below")),
      of_height(command.add_option("--bulk-poisson", c->bulk_poisson, "Poisson ratio below")
                    .range(0.0, 0.5)
                    .show_default())};
  of_height(command.add_option("--counter-modulus", c->counter_modulus,
                               "Young's modulus of a compliant counter-body"));
  c->of_counter = {
      of_height(command.add_option("--counter-poisson", c->counter_poisson, "Its Poisson ratio")
                    .range(0.0, 0.5)
                    .show_default())};
  of_height(
      command.add_option("--hardness", c->hardness, "Cap on the pressure; 0: none").show_default());
  of_height(
      command.add_option("--tolerance", c->tolerance, "On the certificate (docs/theory/contact.md)")
          .range(1e-15, 0.1)
          .show_default());
  of_height(command
                .add_option("--method", c->method,
                            "dense: on the full grid; sparse: where little touches; auto: either")
                .one_of({"auto", "dense", "sparse"})
                .show_default());
  of_height(command.add_option("--max-iterations", c->max_iterations, "Before the solver gives up")
                .range(1, 1000000)
                .show_default());
  of_height(command.add_option("--out-pressure", c->out_pressure, "Pressure [Pa] as .npy"));
  of_height(command.add_option("--out-gap", c->out_gap, "Gap [m] as .npy"));
  command.add_flag("--json", c->json, "One JSON object");
  command.on_chosen([c, &context] {
    context.action = [c, &context] {
      return c->statistics.empty() ? solve(*c) : solve_case(context, *c);
    };
  });
}

}  // namespace papilla::cli
