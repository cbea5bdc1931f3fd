// The one state that all pages see: the design at hand, the way back and forth, the pinned designs.
// Every change that is answered is on disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/folder.h"
#include "base/rooms.h"
#include "studio/form.h"

namespace papilla::studio {

// Where the studio keeps what is its own, below the folder that it works in.
inline constexpr const char* kStudioFolder = ".studio";

// A design as a file and what was changed of it.
struct Draft {
  std::string file;  // absolute
  std::vector<Change> changes;

  bool operator==(const Draft&) const = default;
};

struct Pin {
  int number = 0;
  std::string name;
  Draft draft;
};

// What of the session a reader needs, taken at one moment.
struct SessionView {
  std::uint64_t revision = 0;  // rises with every change of the design
  Draft draft;
  Study study;
  Design opened;  // of the file, without the changes
  std::vector<Pin> pins;
  bool can_undo = false, can_redo = false;
};

class Session {
 public:
  // folder: whose .studio/session.json the state is kept in; an earlier one of the same file goes
  // on. Throws InputError for a file that is no design.
  Session(const std::filesystem::path& folder, const std::string& file);

  SessionView view() const;

  // Sets a key to what a page wrote. step: events of one gesture have one number and are one step
  // of undo; 0: a step of its own. Throws InputError where the design would be none; it is then as
  // before. Returns the new revision.
  std::uint64_t set(const std::string& path, const std::string& text, std::uint64_t step);
  std::uint64_t set_kind(const std::string& kind);  // with the measures that it shares
  std::uint64_t become(const Draft& draft);         // another design, file or both
  std::uint64_t reset(const std::string& path);     // as the file has it
  // The design at hand is written to a file, by `write`, and goes on as that one.
  std::uint64_t save_as(const std::string& file,
                        const std::function<void(const Draft&, const Study&)>& write);
  std::uint64_t undo();
  std::uint64_t redo();

  int pin(const std::string& name);
  void unpin(int number);
  std::uint64_t take(int number);  // the pinned design becomes the one at hand

 private:
  std::uint64_t replace(Draft next, std::uint64_t step);  // with the lock held
  std::uint64_t step_to(std::vector<Draft>& from, std::vector<Draft>& to);
  void adopt(Draft draft);  // reads it
  void restore(const std::string& file);
  void keep() const;

  Folder kept_;
  mutable std::mutex mutex_;
  Draft draft_;
  Study study_;
  Design opened_;
  std::vector<Draft> past_, future_;
  std::vector<Pin> pins_;
  std::uint64_t revision_ = 0, last_step_ = 0;
  int last_pin_ = 0;
};

Study study_of(const Draft& draft);

}  // namespace papilla::studio
