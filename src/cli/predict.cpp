// papilla predict: what the finger says of experiments that no fit has seen.
#include "claims/predict.h"

#include <iostream>
#include <memory>

#include "base/files.h"
#include "cli/commands.h"
#include "design/design.h"
#include "report/predictions.h"

namespace papilla::cli {
namespace {

struct PredictCommand {
  std::string finger, out;
  int jobs = 0;
  bool json = false;
};

int run(const Context& context, const PredictCommand& command) {
  if (!command.out.empty()) make_folder(command.out);
  PredictOptions options;
  options.finger =
      read_finger(command.finger.empty() ? find_design("fingers/reference.toml") : command.finger);
  options.threads = command.jobs;
  options.started = [&](const std::string& experiment) { context.note(experiment + " ..."); };
  std::vector<Prediction> found = predictions(options);
  add_model_parts(found, options);
  if (options.finger.belief.empty())
    context.note("what is not known of finger and model is in no ±: finger \"" +
                 options.finger.name + "\" names no belief");
  if (!command.out.empty()) {
    write_bytes(command.out + "/predictions.csv", predictions_csv(found));
    write_bytes(command.out + "/predictions.md", predictions_markdown(found, options.finger.name));
    context.note("wrote " + command.out);
  }
  if (command.json)
    std::cout << predictions_json(found, options.finger.name) << '\n';
  else
    context.print(predictions_text(found));
  return kSuccess;
}

}  // namespace

void add_predict(Command app, Context& context) {
  Command command = app.add_command(
      "predict", "What the finger says of experiments that no fit has seen, with errors");
  auto options = std::make_shared<PredictCommand>();
  command.add_option("--finger", options->finger, "Finger file; default: fingers/reference.toml")
      .type_name("FILE");
  command.add_option("--out", options->out, "Also write predictions.csv and predictions.md")
      .type_name("DIR");
  command.add_option("--jobs", options->jobs, "Threads; 0: all processors").range(0, 4096);
  command.add_flag("--json", options->json, "One JSON object on standard output");
  command.document(
      {"Says what the finger predicts of experiments that no fit has seen, with both parts of the "
       "errors, for laboratories that want to test the model.",
       {{"papilla predict --out results/predictions", "the table as CSV and Markdown"}},
       {{"DIR/predictions.csv, predictions.md", "with --out"}}});
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return run(context, *options); };
  });
}

}  // namespace papilla::cli
