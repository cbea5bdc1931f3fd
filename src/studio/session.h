// The one state that all pages see: the design at hand, the way back and forth, the pinned designs.
// Every change that is answered is on disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
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
// Where its searches are, each in a folder of its number.
inline constexpr const char* kSearches = "searches";

// A design as a file and what was changed of it.
struct Draft {
  std::string file;  // absolute
  std::vector<Change> changes;

  bool operator==(const Draft&) const = default;
};

// A draft with the way back and forth.
struct Workspace {
  Draft draft;
  std::vector<Draft> past, future;
};

struct PinnedDesign {
  int number = 0;
  std::string name;
  Draft draft;
};

// What a page wrote into the form of searches, and the file and kind of texture that it is of.
struct KeptWish {
  std::string file, kind, text;
};

// What of the session a reader needs, taken at one moment.
struct SessionView {
  std::uint64_t revision = 0;  // rises with every change of the design
  Draft draft;
  Study study;    // titled as title_of has it
  Design opened;  // of the file, without the changes
  std::vector<PinnedDesign> pins;
  // What each step changed, oldest first, the undone ones behind: the design at hand stands behind
  // the first `done` of them.
  std::vector<std::string> steps;
  std::size_t done = 0;

  bool can_undo() const { return done > 0; }
  bool can_redo() const { return done < steps.size(); }
};

class Session {
 public:
  // folder: whose .studio/session.json the state is kept in. A file that was at hand before goes on
  // as it was left, whatever was opened since. Throws InputError for a file that is no design.
  Session(const std::filesystem::path& folder, const std::string& file);

  SessionView view() const;

  // Sets a key to what a page wrote. step: events of one gesture have one number and are one step
  // of undo; 0: a step of its own. Throws InputError where the design would be none; it is then as
  // before. Returns the new revision.
  std::uint64_t set(const std::string& path, const std::string& text, std::uint64_t step);
  // A number is moved toward what a slider was drawn to, as far as the design goes. Throws what
  // set() would where it does not move, and of what is no number.
  std::uint64_t set_toward(const std::string& path, const std::string& text, std::uint64_t step);
  // As it was when the kind was left and only kinds were looked at since; else with the measures
  // that it shares.
  std::uint64_t set_kind(const std::string& kind);
  std::uint64_t become(const Draft& draft);      // another design, file or both
  std::uint64_t reset(const std::string& path);  // as the file has it
  // The design at hand is written to a file, by `write`, and goes on as that one.
  std::uint64_t save_as(const std::string& file,
                        const std::function<void(const Draft&, const Study&)>& write);
  std::uint64_t undo();
  std::uint64_t redo();
  // Back or forth until so many steps are done. Throws InputError for more than there are.
  std::uint64_t go_to(std::size_t done);

  int pin(const std::string& name);
  void unpin(int number);
  std::uint64_t take(int number);  // the pinned design becomes the one at hand

  // What a page wrote into the form of searches, JSON; kept for each file and kind of texture until
  // that of the file is forgotten. A kind that nothing was written for has the last wish of its
  // file, but for what is of the other kind.
  void set_wish(std::string wish);
  void forget_wish();
  std::string wish() const;  // empty: none

 private:
  std::uint64_t replace(Draft next, std::uint64_t step);  // with the lock held
  std::uint64_t step_to(std::vector<Draft>& from, std::vector<Draft>& to);
  void adopt(Draft draft);  // reads it
  std::string kind() const;
  void put_wish(std::string wish);  // with the lock held
  std::string wish_at_hand() const;
  Study titled_study() const;
  void restore(const std::string& file);
  void keep() const;

  Folder kept_;
  std::vector<Workspace> others_;  // of other files, the one that was left last at the end
  // The texture's changes under each kind that was left, until a texture changes otherwise.
  std::map<std::string, std::vector<Change>> left_kinds_;
  std::vector<KeptWish> wishes_;  // the one that was written last at the end
  mutable std::mutex mutex_;
  Draft draft_;
  Study study_;
  Design opened_;
  std::vector<Draft> past_, future_;
  std::vector<PinnedDesign> pins_;
  std::uint64_t revision_ = 0, last_step_ = 0;
  int last_pin_ = 0;
};

Study study_of(const Draft& draft);
// What the design of a draft is called: by its file and by what was changed of it.
std::string title_of(const Draft& draft, const Design& design);

// What leads from one draft to the next, for people: "depth 262 nm; diameter as the file has it".
std::string step_text(const Draft& from, const Draft& to);

}  // namespace papilla::studio
