// papilla bench: the performance targets, measured here.
#include "report/bench.h"

#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "base/error.h"
#include "base/files.h"
#include "cli/commands.h"

namespace papilla::cli {
namespace {

struct BenchCommand {
  bool json = false, page = false, large = false;
  int prices = 0, first = 0;
  std::string out;
};

int run_prices(const Context& context, const BenchCommand& c) {
  const std::vector<PriceRow> rows =
      prices_of({.designs = c.prices, .first = c.first, .done = [&](const PriceRow& row) {
                   context.note(fmt::format("{} {}: announced {:.3g} s, taken {:.3g} s", row.design,
                                            row.texture, row.announced, row.taken));
                 }});
  const std::string provenance =
      fmt::format("papilla " PAPILLA_VERSION " bench --prices {} --first {}", c.prices, c.first);
  if (!c.out.empty()) write_bytes(c.out, prices_csv(rows, provenance));
  std::cout << prices_text(rows);
  return kSuccess;
}

int run(const Context& context, const BenchCommand& c) {
  if (c.prices > 0 && (c.json || c.page || c.large))
    throw InputError("--json, --page and --large are of the targets, not of --prices");
  if (c.prices == 0 && c.first > 0) throw InputError("--first is of --prices");
  if (c.prices > 0) return run_prices(context, c);
  const std::vector<BenchRow> rows =
      bench({c.large, [&](const std::string& text) { context.note(text); }});
  const std::string provenance = "papilla " PAPILLA_VERSION " bench, reference finger, a3h350";
  if (!c.out.empty()) write_bytes(end_of_links(c.out), bench_csv(rows, provenance));
  if (c.json || c.page) {
    std::cout << (c.json ? bench_json(rows) + "\n" : bench_page(rows, provenance));
    return kSuccess;
  }
  std::cout << bench_text(rows);
  return kSuccess;
}

}  // namespace

void add_bench(Command app, Context& context) {
  Command command = app.add_command("bench", "The performance targets, measured here");
  auto c = std::make_shared<BenchCommand>();
  command.add_flag("--json", c->json, "One JSON object on standard output");
  command.add_flag("--page", c->page, "As the page docs/measured/performance.md");
  command.add_flag("--large", c->large, "Contact at 4096 x 4096 too (2.5 GB)");
  command
      .add_option("--prices", c->prices,
                  "Instead: the announced price against what it takes, on so many random legal "
                  "designs of all kinds")
      .range(1, 100000);
  command.add_option("--first", c->first, "Of the random designs").range(0, 1000000);
  command.add_option("--out", c->out, "Also write the table as CSV").type_name("FILE");
  command.document(
      {"Measures the performance targets on this machine: transforms a contact, times of levels, "
       "memory, "
       "scaling. With --prices how well `papilla explain` announces times.",
       {{"papilla bench", "the table"},
        {"papilla bench --prices 40 --first 1000", "announced prices of random designs"}}});
  command.on_chosen([&context, c] { context.action = [&context, c] { return run(context, *c); }; });
}

}  // namespace papilla::cli
