// Which of several designs is better, and how sure that is. docs/theory/ranking.md
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "papilla/design.h"

namespace papilla::api {

struct RankOptions {
  std::string by;  // "friction:low,variation(modulation):low"; empty: as `papilla rank`
  std::vector<double> weights;     // of the criteria; empty: several have no single score
  std::string states;              // "clean,natural,wet"; empty: the fingers' own
  int max_skins = 96;              // per candidate and state; 6 at least
  int threads = 0;                 // 0: all processors
  bool parameters = false;         // insist on what the finger's fitted numbers leave open
  bool any_conditions = false;     // compare designs under other conditions all the same
  bool force = false;              // with model options that a finger was not fitted with
  std::vector<std::string> names;  // of the candidates; empty: titles, numbered where alike
  std::function<void(const std::string&)> progress;  // for people; may be empty
  const std::atomic<bool>* stop = nullptr;           // set by another thread: rank() throws Stopped
};

struct Ranked {
  std::size_t index = 0;  // into the designs as given
  // 1 + how many are ahead beyond doubt: by the score, or without one in some criterion and behind
  // in none; ties share the better rank.
  int rank = 1;
  std::vector<double> p_best_by;  // of each criterion: probability of the best value
  // Where there is one score: with its 95 % interval, and the probability of the highest.
  double score = 0, low = 0, high = 0, p_best = 0;
};

struct Ranking {
  // Best first; one list per finger state, in their order.
  std::vector<std::vector<Ranked>> states;
  std::string table, json;  // of the command
};

// Throws InputError, also without `states` for designs whose fingers are in different ones;
// Stopped.
Ranking rank(const std::vector<Design>& designs, const RankOptions& options = {});

}  // namespace papilla::api
