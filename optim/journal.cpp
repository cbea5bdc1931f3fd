#include "optim/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include "base/error.h"

namespace papilla {
namespace {

std::uint64_t checksum(const std::string& text) {  // FNV-1a, 64 bits
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (unsigned char c : text) hash = (hash ^ c) * 0x100000001b3ULL;
  return hash;
}

std::string numbers(const std::vector<double>& values) {
  std::string out = std::to_string(values.size());
  for (double v : values) out += fmt::format(" {:a}", v);
  return out;
}

bool read_numbers(std::istringstream& in, std::vector<double>& values) {
  std::size_t count = 0;
  if (!(in >> count) || count > 100000) return false;
  values.resize(count);
  std::string word;
  for (double& v : values) {
    if (!(in >> word)) return false;
    char* end = nullptr;
    v = std::strtod(word.c_str(), &end);
    if (end != word.c_str() + word.size()) return false;
  }
  return true;
}

std::string header(const std::string& key) { return "papilla-journal 1 " + key + "\n"; }

}  // namespace

std::string text_hash(const std::string& text) { return fmt::format("{:016x}", checksum(text)); }

std::string journal_line(const Evaluation& e) {
  std::string reason = e.outcome.reason;
  for (char& c : reason) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  const std::string body = numbers(e.unit) + (e.outcome.ok ? " ok " : " failed ") +
                           numbers(e.outcome.objectives) + " " + numbers(e.outcome.constraints) +
                           " " + numbers(e.outcome.info) + " |" + reason;
  return fmt::format("{:016x} {}\n", checksum(body), body);
}

bool parse_journal_line(const std::string& line, Evaluation& e) {
  if (line.size() < 18 || line[16] != ' ') return false;
  const std::string body = line.substr(17);
  if (fmt::format("{:016x}", checksum(body)) != line.substr(0, 16)) return false;
  const std::size_t bar = body.find('|');
  if (bar == std::string::npos) return false;
  std::istringstream in(body.substr(0, bar));
  std::string word;
  if (!read_numbers(in, e.unit) || !(in >> word)) return false;
  e.outcome.ok = word == "ok";
  if (!read_numbers(in, e.outcome.objectives) || !read_numbers(in, e.outcome.constraints) ||
      !read_numbers(in, e.outcome.info))
    return false;
  e.outcome.reason = body.substr(bar + 1);
  return journal_line(e) == line + "\n";  // as it is written, in every letter
}

Journal::Journal(const std::string& path, const std::string& key, bool resume) : path_(path) {
  std::size_t sound = 0;  // bytes that are whole records
  {
    std::ifstream in(path, std::ios::binary);
    if (in) {
      std::stringstream buffer;
      buffer << in.rdbuf();
      const std::string text = buffer.str();
      if (text.size() >= header(key).size() || !header(key).starts_with(text)) {
        if (!text.starts_with(header(key))) {
          throw InputError(
              path + ": written for another study, seed or version; use another --out folder");
        }
        sound = header(key).size();
        while (sound < text.size()) {
          const std::size_t end = text.find('\n', sound);
          Evaluation e;
          if (end == std::string::npos || !parse_journal_line(text.substr(sound, end - sound), e))
            break;
          records_.push_back(std::move(e));
          sound = end + 1;
        }
      }
      lost_ = static_cast<int>(
          std::count(text.begin() + static_cast<std::ptrdiff_t>(sound), text.end(), '\n'));
      if (!records_.empty() && !resume) {
        throw InputError(path +
                         ": this folder holds an earlier run; continue it with --resume, or choose "
                         "another --out folder");
      }
    }
  }
  file_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  const auto fail = [&] {
    throw InputError(fmt::format("cannot write {}: {}", path, std::strerror(errno)));
  };
  if (file_ < 0) fail();
  if (::ftruncate(file_, static_cast<off_t>(sound)) != 0 || ::lseek(file_, 0, SEEK_END) < 0) fail();
  if (sound == 0) {
    const std::string first = header(key);
    if (::write(file_, first.data(), first.size()) != static_cast<ssize_t>(first.size())) fail();
  }
}

Journal::~Journal() {
  if (file_ >= 0) ::close(file_);
}

void Journal::append(const Evaluation& evaluation) {
  const std::string line = journal_line(evaluation);
  std::size_t done = 0;
  while (done < line.size()) {
    const ssize_t n = ::write(file_, line.data() + done, line.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0)
      throw InputError(fmt::format("cannot write {}: {}; free some space and use --resume", path_,
                                   std::strerror(errno)));
    done += static_cast<std::size_t>(n);
  }
  ::fdatasync(file_);
  records_.push_back(evaluation);
}

}  // namespace papilla
