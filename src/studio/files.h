// What the studio reads and writes: designs as a person would have written them, exports with their
// verdict, scans that were dropped on the page. All inside its folder.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/folder.h"
#include "base/rooms.h"
#include "studio/session.h"

namespace papilla::studio {

// The text of a file with some of its values changed as a person would: values in place where the
// file has them, new keys at the end of their section; comments stay. Throws InputError where a
// change has no place in it.
std::string edited_toml(const std::string& text, const std::vector<Change>& changes);

// The file that a draft is saved as: the text of its own file, edited, where it stays in that
// folder; else a `base` and the changed keys; every value, where that base would lie above it.
std::string saved_text(const Draft& draft, const std::filesystem::path& target);

// The map that a measured texture is made of; empty: none.
std::string design_scan_file(const Design& design);

class Files {
 public:
  explicit Files(std::filesystem::path folder);

  // {"folder", "designs": [names of .toml], "results": [folders of a finished search]}
  nlohmann::ordered_json list() const;
  // A design or study that a page named.
  std::string open(const std::string& name) const;
  // Where a design of that name is saved. Throws InputError for no such name, and for a file that
  // is there unless it is to be overwritten.
  std::string target(const std::string& name, bool overwrite) const;
  // Written whole or not at all, read back and compared before it gets its name. Throws InputError.
  void save(const Draft& draft, const Study& study, const std::string& target) const;
  // Masks and heights into a folder, with the verdict on each file; a minute for large ones. Throws
  // InputError for a folder that holds something unless it is to be overwritten, and for one of a
  // search.
  nlohmann::ordered_json export_files(const Study& study, const std::string& name,
                                      bool overwrite) const;
  // What an export would be: margins against the constraints, formats. At once.
  nlohmann::ordered_json export_preview(const Study& study) const;
  // A dropped map of heights, kept under scans/. What is kept there stays: another map of the same
  // name is kept beside it, scan-2.gsf. {"name", "bytes"}
  nlohmann::ordered_json keep_scan(const std::string& name, const std::string& bytes) const;
  // size: "12 um" where the file does not say; fill, as_is: as `papilla surface`.
  nlohmann::ordered_json scan_view(const std::string& name, const std::string& size, bool fill,
                                   bool as_is) const;
  // The draft with the scan as its texture.
  Draft with_scan(const Draft& draft, const std::string& name, const std::string& size, bool fill,
                  bool as_is) const;

  const std::filesystem::path& folder() const { return folder_; }
  const Folder& handle() const { return handle_; }

 private:
  std::filesystem::path folder_;
  Folder handle_;
};

}  // namespace papilla::studio
