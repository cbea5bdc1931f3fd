#include "optim/unfinished.h"

#include <filesystem>
#include <system_error>

#include "base/folder.h"

namespace papilla::optim {

Unfinished::Unfinished(const std::string& folder, const std::string& problem) {
  const std::string key = text_hash(problem), name = "unfinished-" + key + ".journal";
  path_ = folder + "/" + name;
  journal_ = std::make_unique<Journal>(Folder(folder), name, key, true);
  for (const JournalRecord& record : journal_->records()) payloads_[record.key] = record.payload;
}

const std::string* Unfinished::find(const std::string& key) const {
  const auto kept = payloads_.find(key);
  return kept == payloads_.end() ? nullptr : &kept->second;
}

void Unfinished::keep(const std::string& key, const std::string& payload) {
  if (!journal_) return;
  journal_->append({key, payload});
  payloads_[key] = payload;
}

void Unfinished::remove() {
  if (!journal_) return;
  journal_.reset();
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace papilla::optim
