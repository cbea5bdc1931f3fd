// papilla bench: the performance targets, measured here.
#include "report/bench.h"

#include <iostream>
#include <memory>

#include "base/files.h"
#include "cli/commands.h"

namespace papilla::cli {
namespace {

struct BenchCommand {
  bool json = false, page = false, large = false;
  std::string out;
};

int run(const Context& context, const BenchCommand& c) {
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
  command.add_flag("--page", c->page, "As the page docs/performance.md");
  command.add_flag("--large", c->large, "Contact at 4096 x 4096 too (2.5 GB)");
  command.add_option("--out", c->out, "Also write the table as CSV").type_name("FILE");
  command.on_chosen([&context, c] { context.action = [&context, c] { return run(context, *c); }; });
}

}  // namespace papilla::cli
