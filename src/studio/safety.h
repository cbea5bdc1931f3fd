// Who may ask the studio for what: a token, one host, one origin, one folder, bounded sizes.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>

#include "base/rooms.h"

namespace papilla::studio {

struct Limits {
  std::size_t body = std::size_t{64} << 20;  // of an upload [bytes]
  std::size_t text = std::size_t{1} << 20;   // of any other request
  int connections = 64;  // at a time; for one more the one that asks nothing longest is closed
  int listeners = 12;    // of them, pages that wait for events
  std::chrono::seconds request{10};  // from its first byte to its last
  std::chrono::seconds idle{15};     // of a connection between two requests
};

// 32 hexadecimal digits that nobody guesses, from the system.
std::string make_token();

// What of a request decides whether it is looked at. Empty: the header is not there.
struct Sender {
  std::string path, host, origin, fetch_site;
  bool changes = false;  // not a GET
  bool visits = false;   // a person's tab goes there: no part of another page
};

enum class Entry { Admitted, WrongHost, WrongOrigin, WrongToken };

// The door. A tab may come to the page from anywhere, as from the file that opens it.
// The token is the first part of every path; the page of another site can neither know it
// nor send a request with our origin, and a name that was bent to this address (DNS rebinding) is
// not our host.
class Door {
 public:
  Door(std::string token, int port);

  Entry judge(const Sender& sender) const;
  // The path below the token, "/state"; of an admitted request.
  std::string below_token(const std::string& path) const;
  const std::string& token() const { return token_; }
  // "http://127.0.0.1:8123/TOKEN/"
  std::string address() const;

 private:
  std::string token_;
  int port_;
};

// A file that a page names, inside the folder it may reach: a relative name without "..", hidden
// parts or control characters, and no link on its way. Throws InputError for another.
std::filesystem::path inside(const std::filesystem::path& folder, const std::string& name);

}  // namespace papilla::studio
