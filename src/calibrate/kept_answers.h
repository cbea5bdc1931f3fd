// What the model has answered in a fit, on disk: a fit that was interrupted goes on where it
// stopped, as it asks the same again and is answered from the file.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "numerics/statistics.h"
#include "optim/unfinished.h"

namespace papilla::calibrate {

class KeptAnswers {
 public:
  KeptAnswers() = default;  // keeps nothing
  // The folder must exist. `problem`: all that an answer depends on but what `get` names; answers
  // to another problem lie in another file. Throws InputError where the file cannot be written.
  KeptAnswers(const std::string& folder, const std::string& problem)
      : unfinished_(folder, problem) {}

  int known() const { return unfinished_.known(); }
  const std::string& file() const { return unfinished_.file(); }
  // The answer of `size` numbers to `question`, by `make` where it is not kept. Anybody can have
  // written the file: an answer of another size is none.
  std::vector<Estimate> get(const std::string& question, std::size_t size,
                            const std::function<std::vector<Estimate>()>& make);
  void remove() { unfinished_.remove(); }  // the fit has ended

 private:
  Unfinished unfinished_;
};

}  // namespace papilla::calibrate
