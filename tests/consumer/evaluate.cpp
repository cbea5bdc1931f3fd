// evaluate DESIGN.toml [PATH=VALUE ...]: a design evaluated by the library. The text is that of
// `papilla evaluate --json`, without the seconds that it took.
#include <papilla/papilla.h>

#include <iostream>
#include <string>

int main(int argc, char** argv) {
  papilla::Design::Values values;
  for (int i = 2; i < argc; ++i) {
    const std::string text = argv[i];
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
      std::cerr << "expected PATH=VALUE, got " << text << '\n';
      return 2;
    }
    values.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  try {
    const papilla::Design design = papilla::Design::read(argc > 1 ? argv[1] : "", values);
    papilla::EvaluateOptions options;
    options.progress = [](int done) { std::cerr << '\r' << done << " skin patches" << std::flush; };
    const papilla::Response response = papilla::evaluate(design, options);
    std::cerr << '\n';
    for (const papilla::Point& point : response.points()) {
      std::cerr << 100 * point.relative_humidity << " % humidity: modulation "
                << point.modulation.value << " +- " << point.modulation.error << '\n';
    }
    std::cout << response.json(false) << '\n';
  } catch (const papilla::InputError& error) {
    for (const papilla::Problem& problem : error.problems()) std::cerr << problem.text() << '\n';
    return 2;
  }
}
